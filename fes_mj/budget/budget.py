"""What each unknown contributes to the error of a mean power: alone, all of them together, and by Sobol's shares."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from fes_mj.budget.power import RealisationRows, UncertainPower
from fes_mj.budget.unknowns import EXTRAPOLATION, MASSES, MOMENTS, budget_priors
from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import require_extra, require_within
from fes_mj.moments.uncertainty import standard_deviation, with_sd
from fes_mj.statics.turn import QuasiStatic

BUDGET_DRAWS = 256  # of a single command: a standard deviation is known to 4 % of itself, in 0.2 s
_SEED = 2007
SOBOL_SAMPLES = 1024  # times two more than there are unknowns are evaluated; a power of two, as Sobol's points ask
_SOBOL_SEED = 2022
_OF_A_LEG = (MOMENTS, EXTRAPOLATION)  # which legs with moments of their own do not share


class Spread(NamedTuple):
    """Mean and standard deviation of drawn powers, W, of those whose linkage turns, and how many do not."""

    mean: float
    sd: float
    failed: int

    @classmethod
    def of(cls, powers: FloatArray) -> "Spread":
        """Of powers with NaN for linkages that do not turn; NaN if fewer than two do."""
        finite = powers[np.isfinite(powers)]
        failed = powers.size - finite.size
        if finite.size < 2:
            return cls(math.nan, math.nan, failed)
        return cls(float(finite.mean()), float(finite.std(ddof=1)), failed)


@dataclass(frozen=True, repr=False)
class ErrorBudget(Brief):
    """Of the mean crank power of one leg, by moments that are the same at any speed, at once.

    by: standard deviation by unknown, W, the others as they are known best. total: all unknowns drawn. draws: of each.
    """

    by: dict[str, float]
    total: Spread
    draws: int

    @property
    def brief(self) -> str:
        """The result in a sentence, the largest contribution first, those below a hundredth of the total left out."""
        largest = sorted(((sd, name) for name, sd in self.by.items() if sd > self.total.sd / 100), reverse=True)
        alone = ", ".join(f"{name} {sd:.2g}" for sd, name in largest)
        failed = f"; {self.total.failed} of {self.draws} linkages drawn do not turn" * bool(self.total.failed)
        together = with_sd(self.total.mean, self.total.sd, 1)
        return f"{together} W with every unknown drawn (sd of each alone: {alone}){failed}"


def error_budget(*legs: QuasiStatic, draws: int = BUDGET_DRAWS) -> ErrorBudget | None:
    """Of the mean power of legs, each with moments of its own; None where the error of any moments is not known.

    Raises InputError for fewer than two draws, which have no deviation.

    >>> budget = fes_mj.error_budget(fes_mj.quasi_static(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2")))
    >>> round(budget.total.mean, 1), round(budget.total.sd, 1)
    (30.5, 1.1)
    """
    require_within("draws", draws, 2)
    total = paper_powers(*legs, draws=draws)
    if total is None:
        return None
    uncertain = [UncertainPower(leg, draws) for leg in legs]
    alone, linear = np.arange(draws), _linear(legs) | {MASSES: 0.0}
    by = {
        name: linear[name] if name in linear else Spread.of(powers(uncertain, {name: alone})).sd
        for name in budget_priors()
    }
    return ErrorBudget(by, Spread.of(total), draws)


@lru_cache(maxsize=8)  # a result has both its interval and its budget
def paper_powers(*legs: QuasiStatic, draws: int = BUDGET_DRAWS) -> FloatArray | None:
    """The same powers with all unknowns drawn, W, shape (draws,), NaN where a linkage does not turn; None likewise."""
    if any(leg.moments.covariance is None for leg in legs):
        return None
    drawn = powers([UncertainPower(leg, draws) for leg in legs], together(unknowns(), draws))
    drawn.setflags(write=False)
    return drawn


def budget_summary(budget: ErrorBudget | None) -> dict[str, Any]:
    """The result as JSON names and units it; null where the error of the moments is not known."""
    if budget is None:
        return dict.fromkeys(("power_sd_total_W", "power_sd_by"))
    return {
        "power_sd_total_W": budget.total.sd,
        "power_mean_drawn_W": budget.total.mean,
        "power_sd_by": budget.by,
        "draws": budget.draws,
        "draws_that_do_not_turn": budget.total.failed,
    }


def unknowns() -> list[str]:
    """Names of what is drawn."""
    return [name for name in budget_priors() if name != MASSES]


def together(names: Iterable[str], count: int, times: int = 1) -> dict[str, IntArray]:
    """Rows with all the unknowns at once, in which every realisation of each comes up so many times."""
    random = np.random.default_rng(_SEED)
    return {name: random.permutation(np.tile(np.arange(count), times)) for name in names}


def powers(legs: list[UncertainPower], rows: RealisationRows) -> FloatArray:
    """UncertainPower.at of the mean of legs; what belongs to a leg is independent of the other's."""
    of_legs = [legs[0].at(rows)]
    for leg in legs[1:]:
        opposite = {name: leg.count - 1 - numbers if name in _OF_A_LEG else numbers for name, numbers in rows.items()}
        of_legs.append(leg.at(opposite))
    return np.asarray(np.mean(of_legs, axis=0))


def _linear(legs: Iterable[QuasiStatic]) -> dict[str, float]:
    """What needs no drawing: by the covariance of the moments, and by what is known of their range."""
    pairs = [
        (standard_deviation(leg.power_weights, leg.moments.covariance), leg.extrapolation.sd)
        for leg in legs
        if leg.moments.covariance is not None
    ]
    moments, outside = (math.hypot(*deviations) / len(pairs) for deviations in zip(*pairs, strict=True))
    return {MOMENTS: moments, EXTRAPOLATION: outside}


class Share(NamedTuple):
    """Of the variance: what an unknown explains alone, and with all in which it takes part; with their 95 % errors."""

    first: float
    first_error: float
    total: float
    total_error: float


def sobol_shares(
    power: Callable[[dict[str, IntArray]], FloatArray], names: Sequence[str], count: int, samples: int = SOBOL_SAMPLES
) -> dict[str, Share]:
    """Sobol's first and total order of a power, W, as a function of one of `count` realisations of each unknown.

    Each unknown is a scalar in [0, 1): its place among the realisations, ordered by the power that each makes alone, so
    that the power rises with it. Linkages that do not turn count as the mean. Raises MissingPartError without SALib.
    """
    require_extra("paper", "SALib")
    from SALib.analyze import sobol as analysis
    from SALib.sample import sobol as sampling

    order = {name: np.argsort(power({name: np.arange(count)}), kind="stable") for name in names}
    problem = {"num_vars": len(names), "names": [*names], "bounds": [[0, 1]] * len(names)}
    points = sampling.sample(problem, samples, calc_second_order=False, seed=_SOBOL_SEED)
    places = np.minimum((points * count).astype(np.int64), count - 1)
    powers = power({name: order[name][places[:, column]] for column, name in enumerate(names)})
    powers = np.where(np.isfinite(powers), powers, np.nanmean(powers))
    result = analysis.analyze(problem, powers, calc_second_order=False, seed=_SOBOL_SEED)
    columns = (result[key] for key in ("S1", "S1_conf", "ST", "ST_conf"))
    return {name: Share(*map(float, row)) for name, *row in zip(names, *columns, strict=True)}
