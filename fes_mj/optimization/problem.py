"""The optimisation problem of the paper's Section 6, once: variables, objective, constraints, for populations."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypedDict

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.common.errors import InputError, require_one_of, require_within
from fes_mj.common.units import RPM, turns_per_second
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.variables import COMPONENTS, VARIABLES, component, replaced
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.optimization.buildable import slow_values
from fes_mj.optimization.evenness import RippleLimit
from fes_mj.optimization.limits import (
    DEFAULT,
    MEANINGS,
    VARIED,
    Constraint,
    Limits,
    constraint_margins,
    depth_inside,
    length_constraints,
    length_values,
    load_limits,
    motion_constraints,
    motion_values,
)
from fes_mj.optimization.moment_drive import MomentDrive
from fes_mj.optimization.people import ONE_RIDER, People
from fes_mj.optimization.stimulated import MuscleDrive
from fes_mj.statics.cycles import CYCLE_POINTS, cycles, joint_speeds
from fes_mj.statics.work_table import WorkTable, uncertain_table

LENGTH_COUNT = len(VARIED) - 1  # all variables but the gear ratio, which comes last
# A design below any feasible one, and each margin it was refused too early to have counts as ten scales.
INFEASIBLE, _UNKNOWN = -1e4, 10.0
BUILDABLE: Mapping[str, float] = MappingProxyType({})  # the limits of what can be built, none of them changed
PIVOT_ROOM = 0.15  # m around the pivots of a design whose place is its own
KINDS = {"crt": "r1", "cdt": "d1", "trt": "trt"}  # with a printed design, whose rider and seat are the usual ones
_HAIR = 1e-12  # keeps a number that is computed again on the same side of its limit


@dataclass(frozen=True)
class Evaluation:
    """A population evaluated.

    x: shape (n, variables), gear ratios filled in. power: mean crank power of one leg, W, shape (n, sets of moments);
    of several riders their statistic. values: of each constraint, shape (n, constraints), NaN where a design was
    refused before it was computed; of several riders the worst.
    """

    x: FloatArray
    power: FloatArray
    values: FloatArray
    constraints: tuple[Constraint, ...]

    @cached_property
    def margins(self) -> FloatArray:
        """How far inside their limits the values are."""
        return constraint_margins(self.constraints, self.values)

    @property
    def feasible(self) -> BoolArray:
        return np.asarray(np.all(self.margins >= 0, axis=1))

    @property
    def scaled_margins(self) -> FloatArray:
        """Margins in their scales, shape (n, constraints), none of them NaN."""
        scales = [constraint.scale for constraint in self.constraints]
        return np.asarray(np.nan_to_num(self.margins / scales, nan=-_UNKNOWN))

    @property
    def violation(self) -> FloatArray:
        """Sum of all violations in their scales, shape (n,); zero for feasible designs."""
        return np.asarray(np.maximum(0, -self.scaled_margins).sum(axis=1))


@dataclass(frozen=True)
class Problem:
    """Most mean crank power of one leg, within limits on lengths, joint ranges, joint speeds and gear ratio.

    template: kind, rider, seat and coupler angle of all designs. table: the sets of moments, by which joints are laid
    beside their range; the first is the one whose power counts. joint_speed: largest mean absolute speed of each joint,
    deg/s. drive: what moves the legs, these moments or muscles. people: who else rides it; the limits on joints and
    their speeds hold for each, and the power is the people's. ripple: of the crank speed when ridden, if it is limited.
    """

    template: Design
    table: WorkTable
    limits: Limits
    joint_speed: PerJoint[float]
    drive: MomentDrive | MuscleDrive = field(default_factory=MomentDrive)
    people: People = ONE_RIDER
    ripple: RippleLimit | None = None
    points: int = CYCLE_POINTS

    def __post_init__(self) -> None:
        for joint, speed in self.joint_speed.items():
            if not 0 < speed < math.inf:
                raise InputError(f"the {joint} speed limit is {speed:g} deg/s; it must be above 0")

    @property
    def search(self) -> FloatArray:
        """Search ranges of the variables x: lengths, moves of the people's seats, gear ratio; shape (variables, 2)."""
        ranges = self.limits.search
        return np.vstack([ranges[:-1], self.people.search, ranges[-1:]])

    @property
    def varied(self) -> FloatArray:
        """Search ranges of what evolution varies: without the gear ratio, where power is proportional to it."""
        return self.search[:-1] if self.drive.proportional else self.search

    @property
    def geometry(self) -> tuple[Constraint, ...]:
        """Constraints on the lengths alone."""
        return length_constraints(self.limits)

    @property
    def motion(self) -> tuple[Constraint, ...]:
        """Constraints on the turn."""
        ripple = self.ripple.limit if self.ripple else None
        return motion_constraints(self.limits, self.joint_speed, self.gear_ratios, ripple, self.drive.inside_limit)

    @property
    def gear_ratios(self) -> tuple[float, float]:
        """Smallest and largest gear ratio: also a cadence that can be run."""
        cadence = VARIABLES["cadence_rpm"]
        slow, fast = (bound * RPM / self._cadence_of_one for bound in (cadence.low, cadence.high))
        return slow * (1 + _HAIR), min(fast * (1 - _HAIR), self.limits.gear_ratio_max)

    @property
    def _cadence_of_one(self) -> float:
        """At gear ratio 1, rad/s."""
        return replace(self.template.linkage, gear_ratio=1.0).cadence

    @property
    def constraints(self) -> tuple[Constraint, ...]:
        return self.geometry + self.motion

    def riders(self, x: FloatArray) -> list[Design]:
        """The designs of one design's riders, each with his seat; x: shape (variables,)."""
        batch = self.people.seated(self.batch(x[None]), x[None, LENGTH_COUNT:-1])
        return [batch.single(row) for row in range(self.people.count)]

    def variables(self, design: Design) -> FloatArray:
        """The variables x = [R1, R2, R6, R7, R8, R9, R10, lambda] of a design, m and 1; before lambda no seat's moves.

        Shape (variables,): ten for one rider.
        """
        values = np.array([component(design, name) for name in VARIED])
        return np.insert(values, LENGTH_COUNT, np.zeros(len(self.people.search)))

    def batch(self, x: FloatArray) -> Design:
        """The designs of a population, shape (n, variables) or without gear ratios, as a batch."""
        gear_ratio = x[:, -1] if x.shape[1] == len(self.search) else np.ones(len(x))
        values, kind = np.column_stack([x[:, :LENGTH_COUNT], gear_ratio]).T[..., None], self.template.linkage.kind
        pairs = zip(VARIED, values, strict=True)
        kept = {name: value for name, value in pairs if kind in COMPONENTS[name].variable.kinds}
        return replaced(self.template, kept)

    def design(self, x: FloatArray, name: str) -> Design:
        """One design, with the template's rider, from its variables, shape (variables,)."""
        return replace(self.batch(x[None]).single(0), name=name)

    def evaluate(self, x: FloatArray, to_beat: FloatArray | float = -np.inf) -> Evaluation:
        """Power and constraints of a population, shape (n, variables).

        Without gear ratios each design gets the largest that its joint speeds allow: power is proportional to it.
        Designs whose lengths already violate a constraint are not turned. to_beat: merit of each, shape (n,); what
        takes long is not computed of a design that would not reach it, which then counts as infeasible.
        """
        design, free = self.batch(x), x[:, : len(self.search) - 1]
        lengths = length_values(design, x[:, :LENGTH_COUNT], self.limits.polygon)
        sound = np.all(constraint_margins(self.geometry, lengths) >= 0, axis=1)
        motion = np.full((len(x), len(self.motion)), np.nan)
        power = np.full((len(x), self.table.sets), np.nan)
        chosen = free.shape == x.shape
        gear_ratio = np.full(len(x), self.gear_ratios[1]) if chosen else x[:, -1].copy()
        if sound.any():
            ridden, riders = self.people.seated(design.taken(sound), free[sound, LENGTH_COUNT:]), self.people.count
            turn = cycles(ridden, self.table, self.points)
            # cadence and joint speeds are those at gear ratio 1
            per_s = turns_per_second(self._cadence_of_one)
            speeds = turn.joints.map(lambda joint: np.degrees(joint.travel) * per_s)
            if chosen:
                fastest = np.minimum(*(self.joint_speed[joint] / speeds[joint] for joint in JOINTS))
                for_all = fastest.reshape(-1, riders).min(axis=1)
                gear_ratio[sound] = np.fmin(for_all * (1 - _HAIR), self.gear_ratios[1])
            ratios = np.repeat(gear_ratio[sound], riders)
            geared = ridden.with_linkage(gear_ratio=ratios[:, None])
            outside = self.drive.outside(turn) if self.limits.build else None
            at_once = motion_values(geared, turn, speeds, self.drive.inside(turn), outside)
            within = np.all(constraint_margins(self.motion[: at_once.shape[1]], at_once) >= 0, axis=1)
            power[sound] = self.people.power(self.drive.power(geared, turn, per_s * ratios, within))
            hopeful = within & np.repeat((self.drive.worth(power) >= to_beat)[sound], riders)
            motion[sound] = self._worst(np.column_stack([at_once, *self._in_time(geared, hopeful)]))
        return Evaluation(np.column_stack([free, gear_ratio]), power, np.hstack([lengths, motion]), self.constraints)

    def _in_time(self, design: Design, within: BoolArray) -> list[FloatArray]:
        """Values of the constraints that take long, of the designs `within` all others, else NaN, in their order."""
        columns = []
        if self.ripple:
            columns.append(np.full(design.size, np.nan))
            if within.any():
                columns[0][within] = self.ripple.ripple(design.taken(within))
                within = within & (columns[0] <= self.ripple.limit)
        if self.limits.build:
            columns.append(slow_values(design, within, self.limits.build, self.drive.pin_force))
        return columns

    def merit(self, evaluation: Evaluation) -> FloatArray:
        """Worth of the feasible designs, W, shape (n,); every infeasible one ranks below, by its violation."""
        return np.where(evaluation.feasible, self.drive.worth(evaluation.power), INFEASIBLE - evaluation.violation)

    def violations(self, evaluation: Evaluation, row: int = 0) -> list[dict[str, Any]]:
        """The violated constraints of one design: name, value, limit, unit and margin."""
        return [
            {"name": c.name, "value": float(value), "limit": c.limit, "unit": c.unit, "margin": float(margin)}
            for c, value, margin in zip(self.constraints, evaluation.values[row], evaluation.margins[row], strict=True)
            if margin < 0
        ]

    def violations_text(self, x: FloatArray) -> str:
        """Which constraints a design, shape (variables,), violates and by how much; empty if it is feasible."""
        evaluation = self.evaluate(x[None])
        if evaluation.feasible[0]:
            return ""
        parts = (
            f"{row['name']} is {row['value']:.4g} {row['unit']}".rstrip()
            + f" (limit {row['limit']:.4g}, set by {MEANINGS[row['name']].where})"
            for row in self.violations(evaluation)
        )
        return ", ".join(parts) or "the thigh swings through 180 deg or more"

    def _worst(self, values: FloatArray) -> FloatArray:
        """Of each constraint on the turn over all riders, shape (n, constraints); values: (n * riders, constraints)."""
        riders = values.reshape(-1, self.people.count, values.shape[1])
        return np.asarray(np.where([c.at_least for c in self.motion], riders.min(axis=1), riders.max(axis=1)))


class ProblemOptions(TypedDict, total=False):
    """What make_problem takes by name, for those who hand it on."""

    compared_with: str
    start: str | None
    like: str | None
    limits: str | Path
    build: Mapping[str, float] | None
    knee_speed: float | None
    hip_speed: float | None
    caution: float
    ripple: float | None
    people: People
    muscles: MuscleDrive | None


def make_problem(
    kind: str,
    moments: JointMoments,
    *,
    compared_with: str = "trt",
    start: str | None = None,
    like: str | None = None,
    limits: str | Path = DEFAULT,
    build: Mapping[str, float] | None = BUILDABLE,
    knee_speed: float | None = None,
    hip_speed: float | None = None,
    caution: float = 0.0,
    ripple: float | None = None,
    people: People = ONE_RIDER,
    muscles: MuscleDrive | None = None,
) -> Problem:
    """The problem for a kind of linkage ("crt", "cdt", "trt") under joint moments.

    compared_with: the design whose mean joint speeds are the limits (unless given, deg/s) and whose power is the
    baseline. ripple: largest of the crank speed when ridden. start: a design whose rider, seat and coupler angle are
    kept; by default a printed one, with the rider and the seat of compared_with if that is a file. like: stands for
    both, and its gear ratio is the largest. limits: a problem file, whose design space is that around the start's
    pivots if they are outside of the default one. build: what is changed of BuildLimits, by key; None for the paper's
    limits alone. caution, people, muscles: see Problem.
    Raises InputError for what cannot be used, and for a start of another kind.
    """
    require_one_of("kind", kind, KINDS)
    require_within("caution", caution, 0)
    require_within("ripple", ripple or 0, 0)
    if like and (start or compared_with != "trt"):
        raise InputError("like takes the place of start and compared_with; leave these out")
    compared_with, start = like or compared_with, like or start
    base = load_design(start or compared_with)
    template = load_design(KINDS[kind])
    if base.linkage.kind == kind and start:
        template = base
    elif start and not like:
        raise InputError(f"start is {start}, a {base.linkage.kind}, not a {kind}; start from a design of that kind")
    elif like or compared_with not in DESIGNS:
        template = replace(template, rider=base.rider).with_linkage(seat_angle=base.linkage.seat_angle)
    allowed = load_limits(Path(limits), build)
    pivots = [template.linkage.ground, template.linkage.crank_centre]
    if limits == DEFAULT and depth_inside(allowed.polygon, np.array(pivots)).min() < 0:
        allowed = allowed.holding(pivots, PIVOT_ROOM)
    if like:
        allowed = replace(allowed, gear_ratio_max=base.linkage.gear_ratio)
    if kind == "trt":
        absent = [kind not in COMPONENTS[name].variable.kinds for name in VARIED]
        allowed = replace(allowed, search=np.where(np.array(absent)[:, None], 0.0, allowed.search))
    other, table = load_design(compared_with), uncertain_table(moments) if caution else WorkTable.of(moments)
    # a hair above, so that the design itself is within its own limits
    speeds, asked = joint_speeds(other, table).map(lambda speed: speed * (1 + 1e-9)), PerJoint(knee_speed, hip_speed)
    speed = PerJoint(*(speed if limit is None else limit for speed, limit in zip(speeds, asked, strict=True)))
    baseline = cycles(other, table).power(other.linkage.cadence)[0]
    if muscles and (caution or ripple):
        raise InputError("caution and the limit on the ripple are for joint moments; muscles have neither")
    even = None if ripple is None else RippleLimit(ripple, moments)
    return Problem(template, table, allowed, speed, muscles or MomentDrive(moments, caution, baseline), people, even)
