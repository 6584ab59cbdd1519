"""Who is to blame: shares of the variance of a power by unknown (Sobol's, by SALib)."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.errors import require_extra

SAMPLES = 1024  # times two more than there are unknowns are evaluated; a power of two, as Sobol's points ask
_SEED = 2022


class Share(NamedTuple):
    """Of the variance: what an unknown explains alone, and with all in which it takes part; with their 95 % errors."""

    first: float
    first_error: float
    total: float
    total_error: float


def shares(
    power: Callable[[dict[str, IntArray]], FloatArray], names: Sequence[str], count: int, samples: int = SAMPLES
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
    points = sampling.sample(problem, samples, calc_second_order=False, seed=_SEED)
    places = np.minimum((points * count).astype(np.int64), count - 1)
    powers = power({name: order[name][places[:, column]] for column, name in enumerate(names)})
    powers = np.where(np.isfinite(powers), powers, np.nanmean(powers))
    result = analysis.analyze(problem, powers, calc_second_order=False, seed=_SEED)
    columns = (result[key] for key in ("S1", "S1_conf", "ST", "ST_conf"))
    return {name: Share(*map(float, row)) for name, *row in zip(names, *columns, strict=True)}
