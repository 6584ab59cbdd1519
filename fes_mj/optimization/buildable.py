"""What makes a found design one that can be built, beyond the paper's limits: values for populations.

Forces and clearances take a thousand times as long as all else: they are computed of designs that keep every other
limit and have more power than they have to beat, and are NaN of the others.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from itertools import combinations
from typing import Any

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.errors import MissingPartError
from fes_mj.linkage.clearance import Side
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import body_loads
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.kinematics import FULL_TURN, Motion
from fes_mj.linkage.layers import least_clearance
from fes_mj.linkage.plates import Hole, Plate, hole_places
from fes_mj.statics.characteristics import motion_characteristics
from fes_mj.statics.cycles import Cycles
from fes_mj.statics.equilibrium import equilibrium
from fes_mj.statics.friction import BearingLoss, Bearings
from fes_mj.statics.joint_forces import JointForces, peaks
from fes_mj.statics.turn import DrivenTurn

# Of a link that is not sized yet, m: half of its width, its pins, its thickness.
MARGIN, PIN, THICKNESS = 0.015, 0.012, 0.008
# Crank angles at which forces and clearances are looked at during a search; between them a clearance of links within
# 0.3 m is less by 0.3 mm at most.
SEARCH_POINTS = 72


@dataclass(frozen=True)
class BuildLimits:
    """Limits by their keys in [limits] of a problem file: deg, m, N, deg, share of the turn, m."""

    transmission_angle_min: float = 30.0
    hole_distance_min: float = 0.025
    pin_force_max: float = 1500.0
    hip_swing_min: float = 5.0
    extrapolated_max: float = 0.0
    clearance_min: float = 0.005


COMMON = BuildLimits()
_AS_GOOD = 0.01  # deg: a search looks at fewer crank angles
PLAIN_BEARINGS = Bearings(0.1, 0.008)
KEYS = tuple(field.name for field in fields(BuildLimits))


def hole_distance(design: Design) -> FloatArray:
    """Least distance of two holes in a link, m, of a batch, shape (designs,)."""
    distances = [
        np.broadcast_to(np.ravel(np.abs(one - other)), design.size)
        for holes in hole_places(design).values()
        for one, other in combinations(holes.values(), 2)
    ]
    return np.asarray(np.min(distances, axis=0))


def transmission_angle(design: Design, turn: Cycles) -> FloatArray:
    """Smallest of the leg and of rocker and coupler over a turn, deg, of a batch, shape (designs,).

    By the law of cosines where the dyads are stretched most and least.
    """
    boot = np.ravel(design.boot_angle)
    ends = [np.pi - np.abs(np.pi - (angle + boot)) for angle in turn.joints.knee[:2]]
    if "coupler" in design.linkage.architecture.bodies:
        distance, crank = np.abs(design.linkage.pivot_to_crank), design.linkage.crank
        one, other = (design.link_lengths[link] for link in ("rocker", "coupler"))
        spans = (np.abs(distance - crank), distance + crank)
        cosines = ((one**2 + other**2 - span**2) / (2 * one * other) for span in spans)
        ends += [np.ravel(np.acos(np.clip(cosine, -1, 1))) for cosine in cosines]
    return np.asarray(np.degrees(np.min([np.minimum(end, np.pi - end) for end in ends], axis=0)))


def pin_force(motion: Motion, moment: PerJoint[FloatArray]) -> float:
    """Largest on any pin, N, of a design that joint moments (N m) drive along its motion, with masses."""
    return _on_pins(equilibrium(motion, moment, body_loads(motion, motion.design.linkage.cadence))[1])


def _on_pins(forces: dict[str, ComplexArray]) -> float:
    return max(force for joint, force in peaks(forces).items() if joint not in JOINTS)


def clearance(design: Design, points: int = SEARCH_POINTS) -> float:
    """What is left between what moves in the best layers, m, of links and pins of common size."""
    plates = {
        body: Plate(body, tuple(Hole(joint, place, PIN) for joint, place in places.items()), MARGIN, THICKNESS)
        for body, places in hole_places(design).items()
    }
    pins = dict.fromkeys((joint for joint in design.linkage.architecture.joints if joint not in JOINTS), PIN)
    return least_clearance(Side(design, plates, pins, points))


def slow_values(designs: Design, within: Any, limits: BuildLimits, force: Callable[[Design], float]) -> FloatArray:
    """Pin force (N) and clearance (m) of a batch with its gear ratios, of the rows `within`; shape (designs, 2).

    force: the largest on a pin of a design, N.
    """
    values = np.full((designs.size, 2), np.nan)
    for row in np.flatnonzero(within).tolist():
        design = designs.single(row)
        values[row, 0] = force(design)
        if values[row, 0] <= limits.pin_force_max:
            values[row, 1] = clearance(design)
    return values


@dataclass(frozen=True)
class Buildability:
    """What tells whether a design can be built: of the turn of a case, and its clearance, None without shapely."""

    hip_swing_deg: float
    extrapolated_share: float
    transmission_angle_min_deg: float
    hole_distance_min_m: float
    pin_force_max_N: float  # noqa: N815 (the unit, as JSON names it)
    clearance_min_m: float | None
    friction_loss_W: float  # noqa: N815

    @classmethod
    def of(cls, turn: DrivenTurn) -> "Buildability":
        """Of a turn, whatever drives it; friction in plain bearings."""
        forces = JointForces(turn)
        try:
            least = clearance(turn.design, len(FULL_TURN))
        except MissingPartError:
            least = None
        return cls(
            hip_swing_deg=float(np.ptp(turn.joint_range_deg.hip)),
            extrapolated_share=float(turn.summary()["extrapolated_share"]),
            transmission_angle_min_deg=float(motion_characteristics(turn.motion)["transmission_angle_min_deg"]),
            hole_distance_min_m=float(hole_distance(turn.design)[0]),
            pin_force_max_N=_on_pins(forces.with_masses),
            clearance_min_m=least,
            friction_loss_W=BearingLoss(forces, PLAIN_BEARINGS).power,
        )

    def broken(self, limits: BuildLimits = COMMON) -> dict[str, str]:
        """What of it leaves the limits: name and words."""
        hole, swing, share = 1e3 * self.hole_distance_min_m, self.hip_swing_deg, self.extrapolated_share
        angle, force, least = self.transmission_angle_min_deg, self.pin_force_max_N, self.clearance_min_m
        sayings = {
            "hip swing": (swing < limits.hip_swing_min - _AS_GOOD, f"the hip hardly moves, by {swing:.1f} deg"),
            "known moments": (
                share > limits.extrapolated_max,
                f"for {100 * share:.2g} % of the turn no moments are known",
            ),
            "transmission angle": (
                angle < limits.transmission_angle_min - _AS_GOOD,
                f"the transmission angle goes down to {angle:.0f} deg",
            ),
            "hole distance": (
                hole < 1e3 * limits.hole_distance_min,
                f"two holes of a link are {hole:.2g} mm apart: with the pedal in one of them its class has degenerated",
            ),
            "pin force": (force > limits.pin_force_max, f"{force:.0f} N act on a pin"),
            "clearance": (
                least is not None and least < limits.clearance_min,
                f"the least clearance is {1e3 * (least or 0.0):.1f} mm",
            ),
        }
        return {name: words for name, (leaves, words) in sayings.items() if leaves}

    @property
    def rows(self) -> list[tuple[str, str]]:
        """As text."""
        least = self.clearance_min_m
        return [
            ("swing of the hip, deg", f"{self.hip_swing_deg:.1f}"),
            ("outside the moments, % of the turn", f"{100 * self.extrapolated_share:.1f}"),
            ("smallest transmission angle, deg", f"{self.transmission_angle_min_deg:.1f}"),
            ("least distance of two holes, mm", f"{1e3 * self.hole_distance_min_m:.1f}"),
            ("largest force on a pin, with masses, N", f"{self.pin_force_max_N:.0f}"),
            ("least clearance, mm", "needs the extra build" if least is None else f"{1e3 * least:.1f}"),
            ("lost in plain bearings (0.1, 8 mm), W", f"{self.friction_loss_W:.2f}"),
        ]
