"""The page on the one error budget: what each unknown contributes, and how probable the paper's gains are."""

from itertools import product
from typing import NamedTuple

import numpy as np

from fes_mj.budget.budget import ErrorBudget, Share, Spread, error_budget, sobol_shares, together, unknowns
from fes_mj.budget.power import UncertainPower
from fes_mj.budget.unknowns import budget_priors
from fes_mj.common.arrays import FloatArray
from fes_mj.common.console import track
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.uncertainty import with_sd
from fes_mj.paper.captions import Rows, table
from fes_mj.statics.turn import QuasiStatic

PAPER_DRAWS = 1000  # of each unknown: a standard deviation is known to 2 % of itself
TIMES = 8  # each comes up in the rows of all together: a probability of one half is known to 0.6 %
GAINS = (1.25, 1.5, 2.0)  # power per the TRT's
UNKNOWNS = [*budget_priors()]  # the last draws nothing


class Drawn(NamedTuple):
    """Of one design and group. powers: with all drawn, W, shape (PAPER_DRAWS * TIMES,). shares: by unknown."""

    budget: ErrorBudget
    powers: FloatArray
    shares: dict[str, Share]


Budgets = dict[tuple[str, str], Drawn]


def draw_all(static: dict[tuple[str, str], QuasiStatic], silent: bool) -> Budgets:
    """By design and group, on the same draws of whatever designs share. Raises MissingPartError without SALib."""
    budgets = {}
    for key in track([*static], "error budgets", silent):
        budget, uncertain = error_budget(static[key], draws=PAPER_DRAWS), UncertainPower(static[key], PAPER_DRAWS)
        assert budget is not None
        powers = uncertain.at(together(unknowns(), PAPER_DRAWS, TIMES))
        budgets[key] = Drawn(budget, powers, sobol_shares(uncertain.at, unknowns(), PAPER_DRAWS))
    return budgets


@table("priors")
def prior_table() -> Rows:
    """What is drawn, and where it comes from."""
    return [(name, row["prior"], row["source"]) for name, row in budget_priors().items()]


@table("contributions", unknown=UNKNOWNS)
def contribution_table(budgets: Budgets) -> Rows:
    """Standard deviation by each unknown alone, and mean and standard deviation of all together."""
    for (name, group), drawn in budgets.items():
        spread = Spread.of(drawn.powers)
        turning = 100 * (1 - spread.failed / (PAPER_DRAWS * TIMES))
        yield name.upper(), group, *drawn.budget.by.values(), with_sd(spread.mean, spread.sd, 1), turning


@table("blame", unknown=UNKNOWNS[:-1])
def share_table(budgets: Budgets) -> Rows:
    """Sobol's shares of the variance, of first and total order."""
    for (name, group), drawn in budgets.items():
        cells = (f"{max(0.0, 100 * of.first):.0f} / {100 * of.total:.0f}" for of in drawn.shares.values())
        yield name.upper(), group, *cells, 100 * max(share.total_error for share in drawn.shares.values())


def ratios(budgets: Budgets, name: str, group: str, base: str = "trt") -> FloatArray:
    """Power per another design's on the same draws; NaN where either does not turn."""
    return np.asarray(budgets[name, group].powers / budgets[base, group].powers)


@table("probability", gain=[f"{100 * (gain - 1):.0f}" for gain in GAINS])
def probability_table(budgets: Budgets) -> Rows:
    """How probably each six-bar beats the TRT by so much; what does not turn beats nothing."""
    for name, group in product(SIX_BARS, RIDER_GROUPS):
        ratio = ratios(budgets, name, group)
        spread = Spread.of(ratio)
        chances = (100 * float(np.mean(ratio > gain)) for gain in GAINS)
        yield name.upper(), group, with_sd(spread.mean, spread.sd), *chances


@table("better")
def better_table(budgets: Budgets) -> Rows:
    """How probably D1, the paper's choice, delivers more than each other six-bar."""
    for group in RIDER_GROUPS:
        others = (ratios(budgets, "d1", group, other) for other in ("r1", "r2", "d2"))
        yield group, *(100 * float(np.mean(ratio > 1)) for ratio in others)
