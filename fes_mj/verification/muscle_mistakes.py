"""How the faults of muscles in data/faults.toml are made: each in the muscles that are stepped, none in statics."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, cast

from fes_mj.crosscheck.pipeline import Pipeline
from fes_mj.linkage.turning import turning
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, anatomy
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.instant import LegMuscles, Stimulus, joint_moments
from fes_mj.muscles.stepping import StimulusLaw
from fes_mj.muscles.torque import MuscleTorque
from fes_mj.verification.faults import Steps


def in_muscles(**changes: Any) -> Steps:
    """Attributes of MuscleTorque that are changed."""
    kind = type("FaultyMuscles", (MuscleTorque,), changes)

    def torque(steps: Pipeline) -> MuscleTorque:
        return cast("MuscleTorque", kind(cast("Muscles", steps.drive).simulated(steps.design, steps.cadence)))

    return {"torque": cached_property(torque)}


def in_leg(change: Callable[[LegMuscles], dict[str, Any]]) -> Steps:
    """Numbers of the rider's muscles that are others."""

    def leg(torque: MuscleTorque) -> LegMuscles:
        right = LegMuscles.of(torque.riders, torque.design.rider)
        return right._replace(**change(right)).in_lists

    return in_muscles(leg=property(leg))


def in_rider(**changes: float) -> Steps:
    """Quantities of the rider, in the muscles that are stepped, times these."""

    def leg(torque: MuscleTorque) -> LegMuscles:
        values = dict(torque.riders.values)
        changed = {name: factor * values[name] for name, factor in changes.items()}
        other = replace(torque.riders, values=values | changed)
        return LegMuscles.of(other, torque.design.rider).in_lists

    return in_muscles(leg=property(leg))


def in_moments(change: Callable[..., tuple[float, float]]) -> Steps:
    return in_muscles(moments_of=staticmethod(change))


def in_stimulus(change: Callable[[MuscleTorque, Stimulus], dict[str, Any]]) -> Steps:
    def stimulus(torque: MuscleTorque) -> Stimulus:
        right = MuscleTorque(torque.stimulated).stimulus
        return right._replace(**change(torque, right))

    return in_muscles(stimulus=property(stimulus))


def knee_arm_reversed(leg: LegMuscles, active: Sequence[float], *state: float) -> tuple[float, float]:
    knee, hip = joint_moments(leg, active, *state)
    return -knee, hip


def at_rates(factor_knee: float, factor_hip: float) -> Callable[..., tuple[float, float]]:
    def moments(
        leg: LegMuscles, active: Sequence[float], knee: float, hip: float, knee_rate: float, hip_rate: float
    ) -> tuple[float, float]:
        return joint_moments(leg, active, knee, hip, factor_knee * knee_rate, factor_hip * hip_rate)

    return moments


def unscaled(torque: MuscleTorque) -> LegMuscles:
    muscles, right = anatomy(), LegMuscles.of(torque.riders, torque.design.rider)
    return right._replace(force=right.force / muscles.length_scale(torque.design.rider).ravel()).in_lists


def unshifted(torque: MuscleTorque, _: float) -> StimulusLaw:
    return MuscleTorque.stimulator(torque, 0.0)


def from_top(torque: MuscleTorque, right: Stimulus) -> dict[str, Any]:
    zero = turning(torque.design).top_dead_centre
    return {"on": [on + zero for on in right.on]}


def exchanged(leg: LegMuscles) -> dict[str, Any]:
    other = [MUSCLE_GROUPS.index(group) for group in ("hamstrings", "quadriceps", "gluteus")]
    return {"group": [other[group] for group in leg.group]}


# Step of the pipeline -> what takes its place, by the name of the fault in data/faults.toml.
MUSCLE_STEPS: dict[str, Steps] = {
    "arm_reversed": in_moments(knee_arm_reversed),
    "delay_forgotten": in_leg(lambda _: {"delay": 0.0}),
    "speed_without_hip": in_moments(at_rates(1.0, 0.0)),
    "rates_in_degrees": in_moments(at_rates(math.degrees(1), math.degrees(1))),
    "lengthening_for_shortening": in_moments(at_rates(-1.0, -1.0)),
    "groups_exchanged": in_leg(exchanged),
    "fall_for_rise": in_leg(lambda leg: {"rise": leg.fall}),
    "rise_for_fall": in_leg(lambda leg: {"fall": leg.rise}),
    "ramp_forgotten": in_stimulus(lambda *_: {"ramp": 1e-9}),
    "pennation_forgotten": in_leg(lambda leg: {"thickness": 0 * leg.thickness}),
    "hip_offset_reversed": in_rider(hip_offset_deg=-1.0),
    "slack_shift_reversed": in_rider(**{f"{group}_fibre_shift": -1.0 for group in MUSCLE_GROUPS}),
    "length_scale_forgotten": in_muscles(leg=property(unscaled)),
    "windows_from_top": in_stimulus(from_top),
    "left_muscles_unshifted": in_muscles(stimulator=unshifted),
}
