"""What is not known of a rider's muscles before a measurement: data/muscles/priors.toml, drawn from."""

from functools import cache
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.reading import DATA, read_toml

_FILE = DATA / "muscles" / "priors.toml"
_STIMULATOR = "stimulator"


@cache
def priors() -> dict[str, dict[str, Any]]:
    """What is said of each quantity, in the order of the file."""
    content = read_toml(_FILE, "priors of muscles").content
    return {name: row for name, row in content.items() if name != _STIMULATOR}


@cache
def ramp() -> float:
    """Time in which the stimulation goes up and down, s."""
    return read_toml(_FILE, "priors of muscles").section(_STIMULATOR).number("ramp_s")


def drawn(count: int, random: np.random.Generator) -> dict[str, FloatArray]:
    """So many riders of every quantity, shape (count,), independent of each other."""
    return {name: _column(row, count, random) for name, row in priors().items()}


def _column(row: dict[str, Any], count: int, random: np.random.Generator) -> FloatArray:
    if "either" in row:
        return np.asarray(random.choice(row["either"], count))
    if "normal" in row:
        from scipy.special import ndtr, ndtri

        mean, deviation = row["normal"]
        return np.asarray(mean + deviation * ndtri(random.uniform(ndtr(-mean / deviation), 1, count)))
    logarithmic = "log-even" in row
    low, high = np.log(row["log-even"]) if logarithmic else row["even"]
    values = random.uniform(float(low), float(high), count)
    return np.exp(values) if logarithmic else values
