"""Captions: one column for each of a list of values."""

from fes_mj.paper.captions import captioned


def test_a_column_is_repeated_for_every_value() -> None:
    columns = captioned("motion", [], group=("p1p2", "p1p3")).columns
    assert [name for name in columns if name.startswith("work")] == [
        "work per turn p1p2, J",
        "work per turn p1p3, J",
    ]
    assert columns["work per turn p1p3, J"] == ".2f"
