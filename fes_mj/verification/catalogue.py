"""The catalogue of injected faults. Each is a mistake that was made in print, in a tool, or nearly in this project."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import mujoco
import numpy as np

from fes_mj import inverse_dynamics, kinematics, mjcf, simulation, statics, torque
from fes_mj.design import Design, Linkage
from fes_mj.kinematics import Jet, Motion
from fes_mj.torque import REFERENCE, TABLE_SIZE, TOP_DEAD_CENTRE, TorqueMap
from fes_mj.verification.faults import Fault, Patch


def _in_model(change: Callable[[Any], None]) -> tuple[Patch, ...]:
    """Change the MjSpec once all is in it but the keyframe."""

    def wrap(original: Callable[..., None]) -> Callable[..., None]:
        def add_keyframe(spec: Any, state: Any) -> None:
            change(spec)
            original(spec, state)

        return add_keyframe

    return (Patch(mjcf, "_add_keyframe", wrap),)


def _in_keyframe(change: Callable[[dict[str, Any]], dict[str, Any]]) -> tuple[Patch, ...]:
    return (Patch(mjcf, "_add_keyframe", lambda original: lambda spec, state: original(spec, state | change(state))),)


def _in_linkage(**changes: Callable[[Any], Any]) -> Callable[[Design], Design]:
    """Change dimensions of the design file; each change maps the old number to the new one."""

    def edit(design: Design) -> Design:
        new = {name: change(getattr(design.linkage, name)) for name, change in changes.items()}
        return replace(design, linkage=replace(design.linkage, **new))

    return edit


def _set(**attributes: Any) -> Callable[[Any], None]:
    """Set attributes of every loop constraint."""

    def change(spec: Any) -> None:
        for equality in spec.equalities:
            for name, value in attributes.items():
                setattr(equality, name, value)

    return change


def _option(**attributes: Any) -> Callable[[Any], None]:
    def change(spec: Any) -> None:
        for name, value in attributes.items():
            setattr(spec.option, name, value)

    return change


def _gear(actuator: str, factor: float) -> Callable[[Any], None]:
    def change(spec: Any) -> None:
        spec.actuator(actuator).gear[0] *= factor

    return change


def _weak_servo(spec: Any) -> None:
    servo = spec.actuator("crank_servo")
    servo.gainprm[0], servo.biasprm[2] = 20.0, -20.0


def _heavy_thigh(spec: Any) -> None:
    thigh = spec.body("thigh")
    thigh.mass *= 2
    thigh.inertia = 2 * thigh.inertia


def _tilted_hinge(spec: Any) -> None:
    tilt = math.radians(0.1)
    spec.joint("knee").axis = (math.sin(tilt), math.cos(tilt), 0.0)


def _pins_apart(spec: Any) -> None:
    spec.site("shank_pedal").pos[1] = 1e-3


def _long_rocker(spec: Any) -> None:
    spec.body("coupler").pos[0] *= 1.01


def _damped(spec: Any) -> None:
    for joint in spec.joints:
        joint.damping[0] = 0.01


def _six_digits(spec: Any) -> None:
    spec.compiler.savecompiled = spec.compiler.savecanonical = True


def _without_lever(original: Callable[..., Any]) -> Callable[..., Any]:
    def moment_arm(motion: Motion, body: str, point: str) -> Any:
        arm = original(motion, body, point)
        if (body, point) == ("thigh", "knee"):
            return arm.real / abs(arm) + 1j * arm.imag
        return arm

    return moment_arm


def _by_crank_angle(_: Any) -> Callable[..., Any]:
    def joint_moments(motion: Motion, moments: Any, cadence: Any = None) -> tuple[Any, Any]:
        angle = np.asarray(motion.crank_angle) - TOP_DEAD_CENTRE
        knee, hip = (np.interp(angle, moments.crank_angle, m, period=2 * np.pi) for m in (moments.knee, moments.hip))
        return knee, hip

    return joint_moments


def _other_branch(original: Callable[..., Any]) -> Callable[..., Any]:
    def close_dyad(start: Any, end: Any, first: Any, second: Any) -> Any:
        span = end - start
        return start + np.conj((original(start, end, first, second) - start) / span) * span

    return close_dyad


def _without_centripetal(_: Any) -> Callable[..., Any]:
    def carried(origin: Jet, arm: Any, first: Any, second: Any) -> Jet:
        return Jet(origin.value + arm, origin.first + 1j * first * arm, origin.second + 1j * second * arm)

    return carried


def _inverse(change: Callable[..., Any], *joints: str) -> tuple[Patch, ...]:
    """Change the inverse of the torque map, array and scalar version alike: change(source, angle, direction)."""

    def wrap(original: dict[str, Any]) -> dict[str, Any]:
        def changed(inverse: Any) -> Any:
            def build(xp: Any, acos: Any) -> Any:
                source = inverse(xp, acos)
                return lambda angle, direction: change(source, angle, direction)

            return build

        return original | {joint: changed(original[joint]) for joint in joints}

    return (Patch(torque, "_INVERSES", wrap),)


def _from_horizontal(original: Callable[..., None]) -> Callable[..., None]:
    def init(self: Any, moments: Any) -> None:
        original(self, replace(moments, crank_angle=moments.crank_angle - TOP_DEAD_CENTRE))

    return init


def _open_table(original: Callable[..., None]) -> Callable[..., None]:
    def init(self: Any, moments: Any) -> None:
        original(self, moments)
        grid = np.arange(TABLE_SIZE + 2) * (2 * np.pi / TABLE_SIZE)
        self._tables = {joint: np.interp(grid, moments.crank_angle, getattr(moments, joint)) for joint in torque.JOINTS}

    return init


def _delayed(original: Callable[..., Any]) -> Callable[..., Any]:
    def feedback(self: Any, joint: str) -> Any:
        moment, last = original(self, joint), [(2.0, 1.0)]

        def late(angle: float, rate: float) -> float:
            last.append((angle, rate))
            return float(moment(*last.pop(0)))

        return late

    return feedback


def _late_torque(original: Callable[..., Any]) -> Callable[..., Any]:
    def simulate(*arguments: Any, **options: Any) -> Any:
        run = original(*arguments, **options)
        return replace(run, crank_moment=np.roll(run.crank_moment, 1))

    return simulate


def _without_couples(original: Callable[..., Any]) -> Callable[..., Any]:
    def body_loads(*arguments: Any, **options: Any) -> Any:
        loads = original(*arguments, **options)
        return {body: load._replace(couple=0 * load.couple) for body, load in loads.items()}

    return body_loads


def _half_more(original: Callable[..., int]) -> Callable[..., int]:
    return lambda *arguments: 3 * original(*arguments) // 2


def _cadence(change: Callable[[Linkage, float], float]) -> tuple[Patch, ...]:
    def wrap(original: Any) -> Any:
        return property(lambda linkage: change(linkage, original.fget(linkage)))

    return (Patch(Linkage, "cadence", wrap),)


_SHANK_RATE = property(lambda motion: -motion.turning["shank"][0])
_BOOT = float(REFERENCE.boot_angle)

FAULTS = (
    Fault(
        "knee_sign",
        "knee moment on the shank with the sign of the paper's Eq. 4",
        "virtual_work",
        (Patch(statics, "joint_couples", lambda _: lambda knee, hip: {"thigh": hip + knee, "shank": knee}),),
    ),
    Fault(
        "thigh_lever",
        "R4 missing beside cos(theta_4), as in the paper's Eq. 4",
        "virtual_work",
        (Patch(statics, "moment_arm", _without_lever),),
    ),
    Fault(
        "wrong_branch",
        "both dyads assembled the other way round",
        "assembly_mode",
        (Patch(kinematics, "_close_dyad", _other_branch),),
    ),
    Fault(
        "coupler_angle",
        "gamma 5 deg off in the design file",
        "joint_range",
        edit=_in_linkage(coupler_angle=lambda angle: angle + math.radians(5)),
    ),
    Fault(
        "length_in_file",
        "R10 1 % too long in the design file",
        "joint_range",
        edit=_in_linkage(rocker=lambda r: 1.01 * r),
    ),
    Fault(
        "seat_angle",
        "seat angle of the TRT used for a six-bar",
        "joint_range",
        edit=_in_linkage(seat_angle=lambda _: REFERENCE.linkage.seat_angle),
    ),
    Fault("length_in_model", "rocker 1 % too long in the MuJoCo model only", "keyframe", _in_model(_long_rocker)),
    Fault(
        "directions_exchanged",
        "extension and flexion exchanged in the torque map",
        "torque_map",
        _inverse(lambda source, angle, direction: source(angle, -direction), "knee", "hip"),
    ),
    Fault(
        "crank_zero",
        "crank angle of the moments counted from horizontal instead of top dead centre",
        "torque_map",
        (Patch(TorqueMap, "__init__", _from_horizontal),),
    ),
    Fault(
        "boot_forgotten",
        "angle of the boot left out where the map is looked up",
        "torque_map",
        _inverse(lambda source, angle, direction: source(angle - _BOOT, direction), "knee"),
    ),
    Fault(
        "open_table",
        "moments interpolated as if the turn were not periodic",
        "torque_map",
        (Patch(TorqueMap, "__init__", _open_table),),
    ),
    Fault(
        "map_by_crank_angle",
        "moments of statics looked up by the six-bar's crank angle",
        "massless_statics",
        (Patch(statics, "joint_moments", _by_crank_angle),),
    ),
    Fault("default_solref", "loops with MuJoCo's default solref", "mean_power", _in_model(_set(solref=(0.02, 1.0)))),
    Fault("soft_loops", "loops with a time constant of 2 ms", "gap_order", _in_model(_set(solref=(0.002, 1.0)))),
    Fault("loop_inactive", "loop constraints switched off", "keyframe", _in_model(_set(active=False))),
    Fault("pins_apart", "the two sides of the pedal pin 1 mm apart sideways", "keyframe", _in_model(_pins_apart)),
    Fault("weak_servo", "servo gain of 20 N m s/rad", "cadence_ripple", _in_model(_weak_servo)),
    Fault(
        "wrong_integrator",
        "implicitfast instead of discrete",
        "stability",
        _in_model(_option(integrator=mujoco.mjtIntegrator.mjINT_IMPLICITFAST)),
    ),
    Fault("gravity_axis", "gravity along x", "mujoco_inverse", _in_model(_option(gravity=(-9.81, 0.0, 0.0)))),
    Fault("tilted_hinge", "knee hinge tilted by 0.1 deg", "planarity", _in_model(_tilted_hinge)),
    Fault(
        "heavy_thigh", "mass of the thigh doubled in the MuJoCo model only", "mujoco_inverse", _in_model(_heavy_thigh)
    ),
    Fault("damping", "0.01 N m s/rad of damping left on every joint", "passive_work", _in_model(_damped)),
    Fault("degrees", "knee motor geared for degrees", "mean_power", _in_model(_gear("knee", math.degrees(1)))),
    Fault("reversed_motor", "hip motor turning the other way", "mean_power", _in_model(_gear("hip", -1))),
    Fault(
        "stale_keyframe",
        "keyframe of a crank angle 5 deg further on for the crank alone",
        "keyframe",
        _in_keyframe(lambda state: {"crank": (math.radians(5), state["crank"][1])}),
    ),
    Fault(
        "reversed_start",
        "hip speed of the keyframe with the wrong sign",
        "keyframe_speed",
        _in_keyframe(lambda state: {"hip": (state["hip"][0], -state["hip"][1])}),
    ),
    Fault("six_digits", "model written with MuJoCo's default of six digits", "model_file", _in_model(_six_digits)),
    Fault(
        "late_torque",
        "crank moment read one step late",
        "inverse_dynamics",
        (Patch(simulation, "simulate", _late_torque),),
    ),
    Fault("late_feedback", "joint moments one step late", "map_feedback", (Patch(TorqueMap, "feedback", _delayed),)),
    Fault(
        "turn_and_a_half",
        "power averaged over a turn and a half",
        "whole_turns",
        (Patch(simulation, "steps_per_turn", _half_more, here_only=True),),
    ),
    Fault(
        "no_pre_roll",
        "measured from the second step on",
        "inverse_dynamics",
        (Patch(simulation, "PRE_ROLL", lambda _: 1),),
    ),
    Fault(
        "gear_squared",
        "gear ratio squared in the cadence",
        "tricycle_speed",
        _cadence(lambda linkage, rate: rate * linkage.gear_ratio),
    ),
    Fault(
        "wheel_radius", "wheel radius for diameter in the cadence", "tricycle_speed", _cadence(lambda _, rate: 2 * rate)
    ),
    Fault(
        "wrong_rate",
        "knee speed taken from the shank alone",
        "rates",
        (Patch(Motion, "knee_rate", lambda _: _SHANK_RATE),),
    ),
    Fault(
        "no_centripetal",
        "centripetal term left out of the accelerations",
        "second_rates",
        (Patch(kinematics, "_carried", _without_centripetal),),
    ),
    Fault(
        "no_rotary_inertia",
        "rotary inertia left out of the inverse dynamics",
        "mujoco_inverse",
        (Patch(inverse_dynamics, "body_loads", _without_couples),),
    ),
)
