"""The limits of the paper's Section 6 by name, and the numbers that they limit, for populations."""

from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.linkage.assembly import LEAST_CLEARANCE, grashof_margin
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.variables import COMPONENTS
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.optimization.problem_file import VARIED, Limits, depth_inside
from fes_mj.statics.cycles import Cycles

_LEAST_OVERLAP = 0.1  # deg
_BOUNDS = np.array([(COMPONENTS[name].variable.low, COMPONENTS[name].variable.high) for name in VARIED[:-1]]).T


class Constraint(NamedTuple):
    """A named limit on a number, in `unit`; `scale` makes violations of different units comparable."""

    name: str
    unit: str
    at_least: bool
    limit: float
    scale: float

    def margin(self, value: Any) -> Any:
        """How far inside the limit a value is, in `unit`; negative if it violates it."""
        return value - self.limit if self.at_least else self.limit - value


def length_constraints(limits: Limits) -> tuple[Constraint, ...]:
    """Constraints on the lengths alone."""
    return (
        Constraint("crank_length", "m", True, limits.crank_min, 0.01),
        Constraint("rocker_length", "m", True, limits.rocker_min, 0.01),
        Constraint("ankle_to_pedal", "m", False, limits.foot_max, 0.01),
        Constraint("lengths_inside", "m", True, 0.0, 0.01),
        Constraint("crank_shortest", "m", True, 0.0, 0.01),
        Constraint("grashof", "m", True, max(limits.grashof_min, LEAST_CLEARANCE), 0.01),
        Constraint("rocker_pivot_inside", "m", True, 0.0, 0.01),
        Constraint("crank_centre_inside", "m", True, 0.0, 0.01),
    )


def motion_constraints(
    limits: Limits, joint_speed: PerJoint[float], gear_ratios: tuple[float, float], ripple: float | None
) -> tuple[Constraint, ...]:
    """Constraints on the turn; joint_speed in deg/s, as of Problem."""
    slack = limits.joint_rounding_deg
    (knee_low, knee_high), (hip_low, hip_high) = limits.knee_deg, limits.hip_deg
    return (
        Constraint("leg_reach", "m", True, LEAST_CLEARANCE, 0.01),
        Constraint("knee_min", "deg", True, knee_low - slack, 5.0),
        Constraint("knee_max", "deg", False, knee_high + slack, 5.0),
        Constraint("hip_min", "deg", True, hip_low - slack, 5.0),
        Constraint("hip_max", "deg", False, hip_high + slack, 5.0),
        *(Constraint(f"{joint}_speed", "deg/s", False, speed, 10.0) for joint, speed in joint_speed.items()),
        *(Constraint(f"{joint}_overlap", "deg", True, _LEAST_OVERLAP, 5.0) for joint in JOINTS),
        Constraint("gear_ratio_min", "", True, gear_ratios[0], 0.1),
        Constraint("gear_ratio", "", False, gear_ratios[1], 0.1),
        *([Constraint("speed_ripple", "", False, ripple, 0.05)] if ripple is not None else []),
    )


def length_values(design: Design, x: FloatArray, polygon: ComplexArray) -> FloatArray:
    """Values of length_constraints, shape (n, 8); x: the lengths, shape (n, 9)."""
    linkage = design.linkage
    others = np.stack([np.abs(linkage.pivot_to_crank), linkage.coupler, linkage.rocker])
    columns = (
        linkage.crank,
        linkage.rocker,
        linkage.foot,
        np.minimum(x - _BOUNDS[0], _BOUNDS[1] - x).min(axis=1),
        others.min(axis=0) - linkage.crank,
        grashof_margin(design),
    )
    pivots = (np.asarray(linkage.ground), np.asarray(linkage.crank_centre))
    return np.column_stack(
        [np.ravel(column) for column in columns] + [depth_inside(polygon, pivot.ravel()) for pivot in pivots]
    )


def motion_values(
    turn: Cycles, reference: ReferenceTricycle, speeds: PerJoint[FloatArray], gear_ratio: FloatArray
) -> FloatArray:
    """Values of the constraints on the turn but the ripple, in their order, shape (n, 11)."""
    ranges = [np.degrees(side[joint]) for joint in JOINTS for side in (turn.low, turn.high)]
    rates = (speeds[joint] * gear_ratio for joint in JOINTS)
    overlaps = (_overlap(joint, turn, reference) for joint in JOINTS)
    return np.column_stack([turn.turning.reach, *ranges, *rates, *overlaps, gear_ratio, gear_ratio])


def _overlap(joint: str, turn: Cycles, reference: ReferenceTricycle) -> FloatArray:
    """How far a joint comes into the range of the moments, from whichever side, deg, shape (n,); not above 0: never."""
    low, high = turn.low[joint], turn.high[joint]
    (bottom, top), middle = reference.ranges[joint], (low + high) / 2
    shift = reference.around(joint, middle) - middle
    overlap = np.degrees(np.minimum(high + shift - bottom, top - low - shift))
    # the angle beside a dead centre is too sharp for the parabola that found its extreme
    return np.where(turn.outside[1][joint], np.minimum(overlap, 0.0), overlap)


def margins(constraints: tuple[Constraint, ...], values: FloatArray) -> FloatArray:
    """How far inside their limits the values are, shape (n, constraints)."""
    return np.column_stack([c.margin(values[:, column]) for column, c in enumerate(constraints)])
