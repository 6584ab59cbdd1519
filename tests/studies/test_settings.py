"""What the settings are worth: the closed form of the first-order error, and the page against one measured today."""

from pathlib import Path

import pytest

import fes_mj
from fes_mj.crosscheck.turn_case import Case
from studies.settings import NO_MOMENTS, PLAIN_LOOP, per_first_order

PAGE = Path(__file__).parents[2] / "results" / "settings.md"


def row(name: str) -> dict[str, str]:
    """A design's row of the page by column."""
    names, _, *rows = (line.strip("|").split("|") for line in PAGE.read_text().splitlines() if line.startswith("|"))
    cells = next(cells for cells in rows if cells[0].strip() == name.upper())
    return {key.strip(): cell.strip() for key, cell in zip(names, cells, strict=True)}


@pytest.mark.parametrize("name", ["r1", "d1"])
def test_a_plain_step_errs_as_the_closed_form_says(name: str) -> None:
    idle = Case(fes_mj.load_design(name), NO_MOMENTS)
    ratio = per_first_order(idle, idle.steps.run(PLAIN_LOOP))
    assert ratio == pytest.approx(1, abs=0.1)
    assert float(row(name)["its error per e1"]) == pytest.approx(ratio, abs=0.006)


@pytest.mark.parametrize("name", ["r1", "d1"])
def test_the_page_is_todays(name: str) -> None:
    case = Case(fes_mj.load_design(name), fes_mj.load_moments())
    assert float(row(name)["rms, W"]) == pytest.approx(case.rms_per_leg(case.simulation), abs=6e-5)
    plain = case.rms_per_leg(case.steps.run(PLAIN_LOOP))
    assert float(row(name)["plain mj_step: rms, W"]) == pytest.approx(plain, abs=6e-5)
