"""What the paper's text says of its figures: inequalities on the power over a turn, and curves that fulfil them.

The posterior of the numbers alone is Gaussian; with the statements it is that Gaussian, cut off where one of them
fails. Its curves are drawn by rejection: exact, and independent of each other.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import islice

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA, read_toml
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import solve
from fes_mj.moments.fourier import TERMS
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import instant_power_weights
from fes_mj.paper.evidence import Evidence
from fes_mj.paper.reconstruction import Hyperparameters, drawn_curves

TEXT_FILE = DATA / "text.toml"
HIGH = 0.5  # of the highest power: what reaches it is a high peak; the width of a peak is usually taken there
STATEMENT_SEED = 2022
_ANGLES = np.radians(np.arange(0.0, 360.0, 2.0))
_SECOND_HALF = (_ANGLES - PAPER_TRICYCLE.top_dead_centre) % (2 * np.pi) >= np.pi
_BATCH = 20_000  # curves at a time
_MOST = 500 * _BATCH  # of which none fulfils what contradicts the numbers


def _peaks(power: FloatArray) -> FloatArray:
    high = power > HIGH * power.max(axis=1, keepdims=True)
    return np.asarray(np.sum(high & ~np.roll(high, 1, axis=1), axis=1))


# Of the power at _ANGLES, shape (curves, angles); see data/text.toml.
QUANTITIES: dict[str, Callable[[FloatArray], FloatArray]] = {
    "peaks": _peaks,
    "lowest": lambda power: power.min(axis=1) / power.max(axis=1),
    "lowest_second_half": lambda power: power[:, _SECOND_HALF].min(axis=1) / power.max(axis=1),
    "idle": lambda power: np.mean(power <= 0, axis=1),
}


@dataclass(frozen=True)
class Statement:
    """A bounded quantity of one group's power in a design, of the leg or of one joint; see data/text.toml."""

    group: str
    name: str
    design: str
    quantity: str
    source: str
    joint: str = ""
    at_least: float = -math.inf
    at_most: float = math.inf

    @property
    def bounds(self) -> str:
        """What is allowed, in words."""
        if self.at_least == self.at_most:
            return f"{self.at_least:g}"
        return f"at most {self.at_most:g}" if self.at_least == -math.inf else f"at least {self.at_least:g}"

    def value(self, curves: FloatArray) -> FloatArray:
        """The quantity under curves of shape (curves, 98)."""
        return QUANTITIES[self.quantity](curves @ _rows(self.design, self.joint).T)

    def holds(self, curves: FloatArray) -> BoolArray:
        """Whether each of the curves fulfils it."""
        value = self.value(curves)
        return np.asarray((value >= self.at_least) & (value <= self.at_most))


def load_statements(group: str) -> list[Statement]:
    """What the text says of the figures of one group."""
    rows = read_toml(TEXT_FILE, "statements").content["statement"]
    return [Statement(**row) for row in rows if row["group"] == group]


def allowed_curves(
    rows: list[Evidence], group: str, hyperparameters: Hyperparameters, count: int
) -> tuple[FloatArray, float]:
    """Curves of one group that its evidence, these rows, and the text allow.

    Returns Fourier coefficients, N m, shape (count, 98), and the share of the evidence's curves that the text allows.
    Raises InputError where the two contradict each other: next to no curve of the evidence fulfils the statements.
    """
    kept: list[FloatArray] = []
    drawn = allowed = 0
    for curves in _batches(rows, group, hyperparameters):
        kept.append(curves)
        drawn, allowed = drawn + _BATCH, allowed + len(curves)
        if allowed >= count:
            return np.concatenate(kept)[:count], allowed / drawn
        if drawn >= _MOST:
            break
    raise InputError(f"{TEXT_FILE}: {allowed} of {drawn} curves fulfil what the text says of the figures of {group}")


def allowed_share(rows: list[Evidence], group: str, hyperparameters: Hyperparameters, batches: int = 5) -> float:
    """Share of one group's curves under its evidence, these rows, that the text allows."""
    allowed = islice(_batches(rows, group, hyperparameters), batches)
    return sum(map(len, allowed)) / (batches * _BATCH)


def _batches(rows: list[Evidence], group: str, hyperparameters: Hyperparameters) -> Iterator[FloatArray]:
    """What the text leaves of one batch of curves after the other."""
    statements, random = load_statements(group), np.random.default_rng([STATEMENT_SEED, RIDER_GROUPS.index(group)])
    while True:
        curves = drawn_curves(rows, hyperparameters, random, _BATCH)
        for statement in statements:
            curves = curves[statement.holds(curves)]
        yield curves


@cache
def _rows(name: str, joint: str) -> FloatArray:
    """Power at _ANGLES per coefficient, of the leg or of one joint alone, W/(N m), shape (angles, 98)."""
    design = load_design(name)
    rows = instant_power_weights(solve(design, _ANGLES), design.linkage.cadence, PAPER_TRICYCLE)
    counts = np.repeat([joint in ("", name) for name in JOINTS], TERMS)
    return np.asarray(rows * counts)
