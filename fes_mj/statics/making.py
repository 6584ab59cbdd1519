"""What becomes of a design when it is made: lengths that are off, lengths that are rounded, gears that there are."""

import itertools
from typing import NamedTuple

import numpy as np

from fes_mj.common.reading import DATA, read_toml
from fes_mj.linkage.assembly import clearances
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.variables import LENGTHS, lengths, with_lengths
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.cycles import CYCLE_POINTS, cycles
from fes_mj.statics.work_table import WorkTable

OFF = 1e-4  # m
MAKING_ROUNDING = 5e-4  # m
_FINE = 30 * CYCLE_POINTS  # crank angles: what 0.1 mm does is small


class Effect(NamedTuple):
    """What one length does if it is OFF longer. power: W of one leg. knee, hip: deg of range. closing: m nearer to
    (negative) or farther from the nearest dead centre.
    """

    length: str
    power: float
    knee: float
    hip: float
    closing: float


def sensitivity(design: Design, moments: JointMoments) -> list[Effect]:
    """Of every length of a design that turns; differences of two turns, OFF apart, at the design's own cadence."""
    drawn = lengths(design)
    names = [name for name, length in zip(LENGTHS, drawn, strict=True) if design.linkage.kind != "trt" or length]
    steps = np.array([[OFF / 2 * (name == other) for other in LENGTHS] for name in names])
    batch = with_lengths(design, (drawn + np.vstack([-steps, steps])).T[..., None])
    turn = cycles(batch, WorkTable.of(moments), _FINE)
    power = turn.power(design.linkage.cadence)[:, 0]
    ranges = [np.degrees(turn.joints[joint].high - turn.joints[joint].low) for joint in JOINTS]
    margin = np.min([clearance.margin for clearance in clearances(batch)], axis=0)
    changes = (np.diff(values.reshape(2, -1), axis=0)[0].tolist() for values in (power, *ranges, margin))
    return list(itertools.starmap(Effect, zip(names, *changes, strict=True)))


def rounded(design: Design) -> Design:
    """The design with its lengths rounded to MAKING_ROUNDING; it need not turn."""
    return with_lengths(design, np.round(lengths(design) / MAKING_ROUNDING) * MAKING_ROUNDING)


class Gears(NamedTuple):
    """Teeth at crank and wheel, and by how much of itself the gear ratio is off."""

    crank: int
    wheel: int
    error: float


def nearest_gears(ratio: float) -> Gears:
    """The common sprockets nearest to a gear ratio, crank turns per turn of the wheel; of equals the smallest."""
    teeth = read_toml(DATA / "materials.toml", "materials").section("teeth").content
    pairs = itertools.product(teeth["crank"], teeth["wheel"])
    gears = (Gears(crank, wheel, wheel / crank / ratio - 1) for crank, wheel in pairs)
    return min(gears, key=lambda pair: (round(abs(pair.error), 9), pair.crank + pair.wheel))
