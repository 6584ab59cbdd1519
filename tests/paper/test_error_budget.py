"""The page on the error budget: what its rows say, by computing some of it again, and what must hold in all of it."""

import itertools
import json
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.budget.budget import Spread, together, unknowns
from fes_mj.budget.power import UncertainPower
from fes_mj.budget.unknowns import budget_priors
from fes_mj.linkage.design_file import DESIGNS, SIX_BARS
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.uncertainty import with_sd
from fes_mj.paper.error_budget import GAINS, PAPER_DRAWS, TIMES
from fes_mj.statics.turn import quasi_static

PAGE = json.loads((Path(__file__).parents[2] / "results" / "reproduction.json").read_text(encoding="utf-8"))[
    "error_budget"
]
BUDGETS, BLAME, GAIN = (
    PAGE[title]
    for title in (
        "What each unknown contributes to the mean power",
        "Who is to blame: shares of the variance",
        "How probable is the gain over the TRT?",
    )
)


def test_every_design_and_group_has_its_row() -> None:
    assert [(row["design"].lower(), row["group"]) for row in BUDGETS] == [*itertools.product(DESIGNS, RIDER_GROUPS)]
    assert len(BLAME) == len(BUDGETS)
    assert [(row["design"].lower(), row["group"]) for row in GAIN] == [*itertools.product(SIX_BARS, RIDER_GROUPS)]


@pytest.mark.long
def test_rows_are_todays() -> None:
    """Of D1 and the TRT with P1P3: powers of all together, and so the gain's probabilities, which are their ratios."""
    drawn = {}
    for name in ("d1", "trt"):
        result = quasi_static(fes_mj.load_design(name), fes_mj.load_moments("p1p3"))
        drawn[name] = UncertainPower(result, PAPER_DRAWS).at(together(unknowns(), PAPER_DRAWS, TIMES))
        page = next(row for row in BUDGETS if (row["design"].lower(), row["group"]) == (name, "p1p3"))
        assert page["all together, W"] == with_sd(*Spread.of(drawn[name])[:2], 1)
    page = next(row for row in GAIN if (row["design"], row["group"]) == ("D1", "p1p3"))
    for gain in GAINS:
        chance = page[f"{100 * (gain - 1):.0f} % more: probability, %"]
        assert chance == pytest.approx(100 * np.mean(drawn["d1"] / drawn["trt"] > gain), abs=1e-9)


def test_moments_alone_are_the_stated_error() -> None:
    for row in BUDGETS:
        result = quasi_static(fes_mj.load_design(row["design"].lower()), fes_mj.load_moments(row["group"]))
        known = np.hypot(row["moments, W"], row["extrapolation, W"])
        assert known == pytest.approx(result.power_sd, rel=1e-9)
        assert row["leg masses, W"] == 0


def test_more_is_never_more_probable() -> None:
    for row in GAIN:
        chances = [row[f"{100 * (gain - 1):.0f} % more: probability, %"] for gain in GAINS]
        assert chances == sorted(chances, reverse=True)


def test_shares_are_shares() -> None:
    for row in BLAME:
        cells = [row[f"{unknown}, %"] for unknown in [*budget_priors()][:-1]]
        pairs = [tuple(map(float, cell.split(" / "))) for cell in cells if cell is not None]
        assert len(pairs) == len(cells)
        error = row["largest 95 % error, %"]
        assert sum(first for first, _ in pairs) <= 100 + 2 * error
        assert sum(total for _, total in pairs) >= 100 - 2 * error
