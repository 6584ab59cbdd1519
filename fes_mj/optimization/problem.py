"""The optimisation problem of the paper's Section 6, once: variables, objective, constraints, for populations."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fes_mj.design import Design
from fes_mj.errors import InputError
from fes_mj.optimization.cycles import TURN_POINTS, Cycles, WorkTable, cycles, take
from fes_mj.optimization.problem_file import VARIABLES, Limits, depth_inside
from fes_mj.paper.identification import grashof_margin, pack, unpack
from fes_mj.torque import JOINTS

LENGTHS = len(VARIABLES) - 1  # all variables but the gear ratio
# A design below any feasible one, and each margin it was refused too early to have counts as ten scales.
_INFEASIBLE, _UNKNOWN = -1e4, 10.0


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


@dataclass(frozen=True)
class Evaluation:
    """A population evaluated.

    x: shape (n, 10), gear ratios filled in. power: mean crank power of one leg, W, shape (n, sets of moments).
    values: of each constraint, shape (n, constraints), NaN where a design was refused before it was computed.
    margins: the same against their limits.
    """

    x: NDArray[np.float64]
    power: NDArray[np.float64]
    values: NDArray[np.float64]
    margins: NDArray[np.float64]
    scales: NDArray[np.float64]

    @property
    def feasible(self) -> NDArray[np.bool_]:
        return np.all(self.margins >= 0, axis=1)

    @property
    def violation(self) -> NDArray[np.float64]:
        """Sum of all violations in their scales, shape (n,); zero for feasible designs."""
        return np.where(np.isnan(self.margins), _UNKNOWN, np.maximum(0, -self.margins) / self.scales).sum(axis=1)


@dataclass(frozen=True)
class Problem:
    """Most mean crank power of one leg, within limits on lengths, joint ranges, joint speeds and gear ratio.

    template: kind, rider, seat and coupler angle of all designs. table: the sets of moments; the first is the one whose
    power counts. knee_speed, hip_speed: largest mean absolute joint speed, deg/s. caution: with moments as of
    evidence.uncertain_table, how many standard deviations of the gain over `baseline` (power of a design to beat,
    shape (sets,)) are taken off it.
    """

    template: Design
    table: WorkTable
    limits: Limits
    knee_speed: float
    hip_speed: float
    caution: float = 0.0
    baseline: NDArray[np.float64] | float = 0.0
    points: int = TURN_POINTS

    def __post_init__(self) -> None:
        for joint in JOINTS:
            if not 0 < getattr(self, f"{joint}_speed") < math.inf:
                raise InputError(
                    f"the {joint} speed limit is {getattr(self, f'{joint}_speed'):g} deg/s; it must be above 0"
                )

    @property
    def geometry(self) -> tuple[Constraint, ...]:
        """Constraints on the lengths alone."""
        limits = self.limits
        return (
            Constraint("crank_length", "m", True, limits.crank_min, 0.01),
            Constraint("rocker_length", "m", True, limits.rocker_min, 0.01),
            Constraint("ankle_to_pedal", "m", False, limits.foot_max, 0.01),
            Constraint("pedal_arm", "m", True, 0.0, 0.01),
            Constraint("crank_shortest", "m", True, 0.0, 0.01),
            Constraint("grashof", "m", True, limits.grashof_min, 0.01),
            Constraint("rocker_pivot_inside", "m", True, 0.0, 0.01),
            Constraint("crank_centre_inside", "m", True, 0.0, 0.01),
        )

    @property
    def motion(self) -> tuple[Constraint, ...]:
        """Constraints on the turn."""
        slack = self.limits.joint_rounding_deg
        (knee_low, knee_high), (hip_low, hip_high) = self.limits.knee_deg, self.limits.hip_deg
        return (
            Constraint("leg_reach", "m", True, 0.0, 0.01),
            Constraint("knee_min", "deg", True, knee_low - slack, 5.0),
            Constraint("knee_max", "deg", False, knee_high + slack, 5.0),
            Constraint("hip_min", "deg", True, hip_low - slack, 5.0),
            Constraint("hip_max", "deg", False, hip_high + slack, 5.0),
            Constraint("knee_speed", "deg/s", False, self.knee_speed, 10.0),
            Constraint("hip_speed", "deg/s", False, self.hip_speed, 10.0),
            Constraint("gear_ratio", "", False, self.limits.gear_ratio_max, 0.1),
        )

    @property
    def constraints(self) -> tuple[Constraint, ...]:
        return self.geometry + self.motion

    def variables(self, design: Design) -> NDArray[np.float64]:
        """The ten variables x = [R1, R2, R6, R7, R8, R9, R10, lambda] of a design, shape (10,), m and 1."""
        return np.append(pack(design.linkage), design.linkage.gear_ratio)

    def batch(self, x: NDArray[np.float64]) -> Design:
        """The designs of a population, shape (n, 9) or (n, 10), as a batch."""
        linkage = unpack(self.template.linkage, x.T[:LENGTHS, :, None])
        gear_ratio: Any = x[:, LENGTHS:] if x.shape[1] > LENGTHS else np.ones((len(x), 1))
        return replace(self.template, linkage=replace(linkage, gear_ratio=gear_ratio))

    def design(self, x: NDArray[np.float64], name: str) -> Design:
        """One design from its ten variables, shape (10,)."""
        linkage = unpack(self.template.linkage, x[:LENGTHS])
        return replace(self.template, name=name, linkage=replace(linkage, gear_ratio=float(x[LENGTHS])))

    def evaluate(self, x: NDArray[np.float64]) -> Evaluation:
        """Power and constraints of a population, shape (n, 10).

        With shape (n, 9) each design gets the largest gear ratio its joint speeds allow: power is proportional to it.
        Designs whose lengths already violate a constraint are not turned.
        """
        design = self.batch(x)
        lengths = self._lengths(design)
        sound = np.all(_margins(self.geometry, lengths) >= 0, axis=1)
        turn = cycles(take(design, sound), self.table, self.points) if sound.any() else None
        motion = np.full((len(x), len(self.motion)), np.nan)
        power = np.full((len(x), self.table.sets), np.nan)
        gear_ratio = x[:, LENGTHS].copy() if x.shape[1] > LENGTHS else np.full(len(x), self.limits.gear_ratio_max)
        if turn:
            # cadence and joint speeds at gear ratio 1
            cadence = replace(self.template.linkage, gear_ratio=1.0).cadence
            speeds = {joint: np.degrees(turn.travel[joint]) * cadence / (2 * np.pi) for joint in JOINTS}
            if x.shape[1] == LENGTHS:
                fastest = np.minimum(self.knee_speed / speeds["knee"], self.hip_speed / speeds["hip"])
                gear_ratio[sound] = np.fmin(fastest * (1 - 1e-12), self.limits.gear_ratio_max)
            power[sound] = turn.work * (cadence / (2 * np.pi) * gear_ratio[sound, None])
            motion[sound] = _motion_values(turn, speeds, gear_ratio[sound])
        values = np.hstack([lengths, motion])
        scales = np.array([constraint.scale for constraint in self.constraints])
        filled = np.column_stack([x[:, :LENGTHS], gear_ratio])
        return Evaluation(filled, power, values, _margins(self.constraints, values), scales)

    def merit(self, evaluation: Evaluation) -> NDArray[np.float64]:
        """What is maximised, shape (n,): W if feasible; every infeasible design ranks below, by its violation."""
        return np.where(evaluation.feasible, self.objective(evaluation.power), _INFEASIBLE - evaluation.violation)

    def objective(self, power: NDArray[np.float64]) -> NDArray[np.float64]:
        """Power of the first set of moments less `caution` standard deviations of the gain over the baseline, W."""
        gain = power - self.baseline
        return power[:, 0] - self.caution * np.linalg.norm(gain[:, 1:], axis=1) if self.caution else power[:, 0]

    def violations(self, evaluation: Evaluation, row: int = 0) -> list[dict[str, Any]]:
        """The violated constraints of one design: name, value, limit, unit and margin."""
        return [
            {"name": c.name, "value": float(value), "limit": c.limit, "unit": c.unit, "margin": float(margin)}
            for c, value, margin in zip(self.constraints, evaluation.values[row], evaluation.margins[row], strict=True)
            if margin < 0
        ]

    def _lengths(self, design: Design) -> NDArray[np.float64]:
        """Values of the constraints on lengths, shape (n, 8)."""
        linkage, polygon = design.linkage, self.limits.polygon
        others = np.stack([np.abs(linkage.pivot_to_crank), linkage.coupler, linkage.rocker])
        columns = (
            linkage.crank,
            linkage.rocker,
            linkage.foot,
            linkage.pedal_arm,
            others.min(axis=0) - linkage.crank,
            grashof_margin(linkage),
        )
        pivots = (np.asarray(linkage.ground), np.asarray(linkage.crank_centre))
        return np.column_stack(
            [np.ravel(column) for column in columns] + [depth_inside(polygon, pivot.ravel()) for pivot in pivots]
        )


def _motion_values(
    turn: Cycles, speeds: dict[str, NDArray[np.float64]], gear_ratio: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Values of the constraints on the turn, in their order, shape (n, 8)."""
    ranges = [np.degrees(side[joint]) for joint in JOINTS for side in (turn.low, turn.high)]
    return np.column_stack([turn.reach, *ranges, *(speeds[joint] * gear_ratio for joint in JOINTS), gear_ratio])


def _margins(constraints: tuple[Constraint, ...], values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.column_stack([c.margin(values[:, column]) for column, c in enumerate(constraints)])
