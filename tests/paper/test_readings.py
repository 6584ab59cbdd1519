"""The identified dimensions beside the print."""

from fes_mj.linkage.design_file import DESIGNS
from fes_mj.paper.printed import SIX_BARS
from fes_mj.paper.readings import ranges_table


def test_identified_dimensions_move_as_printed_and_the_print_does_not() -> None:
    verdict = {(row["design"], row["dimensions"]): row["within rounding"] for row in ranges_table().records()}
    assert {verdict[name.upper(), "identified"] for name in DESIGNS} == {"yes"}
    assert not {verdict[name.upper(), "printed"] for name in SIX_BARS} & {"yes"}
    assert verdict["R2", "printed"] == "cannot turn"
