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


def prior_draws(count: int, random: "np.random.Generator") -> dict[str, FloatArray]:
    """So many riders of every quantity, shape (count,), independent of each other."""
    return {name: quantile(name, random.standard_normal(count)) for name in priors()}


def quantile(name: str, scores: FloatArray) -> FloatArray:
    """Values of a quantity that lie in its prior where these scores lie in a standard normal distribution."""
    from scipy.special import ndtr, ndtri

    row, part = priors()[name], ndtr(scores)
    if "either" in row:
        return np.asarray(np.where(part < 0.5, *row["either"]))
    if "normal" in row:
        mean, deviation = row["normal"]
        negative = ndtr(-mean / deviation)
        return np.asarray(mean + deviation * ndtri(negative + (1 - negative) * part))
    low, high = np.log(row["log-even"]) if "log-even" in row else row["even"]
    values = low + (high - low) * part
    return np.asarray(np.exp(values) if "log-even" in row else values)


def normal_score(name: str, values: FloatArray) -> FloatArray:
    """The inverse of `quantile`; of one of two values, the middle of its half."""
    from scipy.special import ndtr, ndtri

    row = priors()[name]
    if "either" in row:
        part = np.where(values == row["either"][0], 0.25, 0.75)
    elif "normal" in row:
        mean, deviation = row["normal"]
        negative = ndtr(-mean / deviation)
        part = (ndtr((values - mean) / deviation) - negative) / (1 - negative)
    else:
        (low, high), at = (np.log(row["log-even"]), np.log(values)) if "log-even" in row else (row["even"], values)
        part = (at - low) / (high - low)
    return np.asarray(ndtri(part))
