"""What is not known of a design's mean power: realisations of each unknown, drawn once, from the priors of the data.

An unknown, be it a curve, a linkage or a number, is so reduced to one index; the power is a function of these.
"""

import zlib
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.reading import DATA, read_toml
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import identified_draws, load_design
from fes_mj.linkage.variables import LENGTHS, component, replaced
from fes_mj.moments.files import is_of_group, sampled_coefficients
from fes_mj.moments.joint_moments import JointMoments

# As data/error_budget.toml has them; the last has no effect on a mean power.
MOMENTS, DIMENSIONS, RIDER = "moments", "dimensions", "rider"
EXTRAPOLATION, MASSES = "extrapolation", "leg masses"
ZONES = 8  # of extrapolation.zone_powers
_SEED = 2022
_FILE = DATA / "error_budget.toml"


@dataclass(frozen=True, eq=False)
class Realisations:
    """As many of every unknown, along the first axis.

    coefficients: of the moments, N m, shape (count, 98). dimensions, legs: components of the design, in the unit of
    files, shape (count,) each. drifts: of the moments in each zone of extrapolation.zone_powers, in standard
    deviations, shape (count, 8).
    """

    coefficients: FloatArray
    dimensions: dict[str, FloatArray]
    legs: dict[str, FloatArray]
    drifts: FloatArray


def realisations(design: Design, moments: JointMoments, count: int) -> Realisations:
    """So many of each unknown, for moments with a covariance. What designs share is the same in all of them."""
    random = np.random.default_rng(_SEED)
    legs = _legs(design, count, random)
    drifts = random.standard_normal((count, ZONES))
    return Realisations(_coefficients(moments, count), _dimensions(design, count), legs, drifts)


def drawn_designs(design: Design, count: int) -> Design:
    """A batch of what a design and its rider may be, as many: what `realisations` draws of them."""
    drawn = _dimensions(design, count) | _legs(design, count, np.random.default_rng(_SEED))
    return replaced(design, {name: values[:, None] for name, values in drawn.items()})


@cache
def budget_priors() -> dict[str, dict[str, Any]]:
    """What data/error_budget.toml says of each unknown, in its order."""
    return dict(read_toml(_FILE, "priors of the error budget").content)


def _coefficients(moments: JointMoments, count: int) -> FloatArray:
    """The curves that ship, of a rider group; otherwise Gaussian ones."""
    covariance = moments.covariance
    assert covariance is not None
    if is_of_group(moments):
        return _spread(sampled_coefficients(moments.name), count)
    deviations = np.concatenate([*moments.deviations])
    scores = np.random.default_rng(_seed(moments.name)).standard_normal((count, deviations.shape[1]))
    return np.asarray(np.concatenate([*moments.coefficients]) + np.einsum("cd,fd->cf", scores, deviations))


def _legs(design: Design, count: int, random: np.random.Generator) -> dict[str, FloatArray]:
    errors = budget_priors()[RIDER]["length_sd_m"] * random.standard_normal((2, count))
    return {name: component(design, name) + error for name, error in zip(("thigh", "shank"), errors, strict=True)}


def _dimensions(design: Design, count: int) -> dict[str, FloatArray]:
    """Of a design as identified what identification leaves open; otherwise within the last digit of its lengths."""
    identified = identified_draws(design.name)
    if identified and design.linkage == load_design(design.name).linkage:
        return {name: _spread(values, count) for name, values in identified.items()}
    random = np.random.default_rng(_seed(design.name))
    sizes = {name: component(design, name) for name in LENGTHS if component(design, name)}
    written = [np.format_float_positional(size, trim="-") for size in sizes.values()]
    half_digit = 0.5 * 10.0 ** -max(len(number.partition(".")[2]) for number in written)
    return {name: size + random.uniform(-half_digit, half_digit, count) for name, size in sizes.items()}


def _spread(sample: Any, count: int) -> FloatArray:
    """So many of a sample whose members are independent, evenly from the first to the last."""
    return np.asarray(sample[np.linspace(0, len(sample) - 1, count).astype(int)])


def _seed(name: str) -> int:
    """Another stream of random numbers for every name, the same in every process."""
    return zlib.crc32(name.encode())
