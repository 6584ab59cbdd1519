"""How the mistakes of the catalogue are made: replacements of parts of the pipeline, and edits of a design."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from fes_mj import mjcf, torque
from fes_mj.design import Design, Linkage
from fes_mj.kinematics import Jet, Motion
from fes_mj.torque import REFERENCE, TABLE_SIZE, TOP_DEAD_CENTRE
from fes_mj.verification.faults import Patch


def in_model(change: Callable[[Any], None]) -> tuple[Patch, ...]:
    """Change the MjSpec once all is in it but the keyframe."""

    def wrap(original: Callable[..., None]) -> Callable[..., None]:
        def add_keyframe(spec: Any, state: Any) -> None:
            change(spec)
            original(spec, state)

        return add_keyframe

    return (Patch(mjcf, "_add_keyframe", wrap),)


def in_keyframe(change: Callable[[dict[str, Any]], dict[str, Any]]) -> tuple[Patch, ...]:
    return (Patch(mjcf, "_add_keyframe", lambda original: lambda spec, state: original(spec, state | change(state))),)


def in_linkage(**changes: Callable[[Any], Any]) -> Callable[[Design], Design]:
    """Change dimensions of the design file; each change maps the old number to the new one."""

    def edit(design: Design) -> Design:
        new = {name: change(getattr(design.linkage, name)) for name, change in changes.items()}
        return replace(design, linkage=replace(design.linkage, **new))

    return edit


def set_loops(**attributes: Any) -> Callable[[Any], None]:
    """Set attributes of every loop constraint."""

    def change(spec: Any) -> None:
        for equality in spec.equalities:
            for name, value in attributes.items():
                setattr(equality, name, value)

    return change


def set_options(**attributes: Any) -> Callable[[Any], None]:
    def change(spec: Any) -> None:
        for name, value in attributes.items():
            setattr(spec.option, name, value)

    return change


def set_gear(actuator: str, factor: float) -> Callable[[Any], None]:
    def change(spec: Any) -> None:
        spec.actuator(actuator).gear[0] *= factor

    return change


def weak_servo(spec: Any) -> None:
    servo = spec.actuator("crank_servo")
    servo.gainprm[0], servo.biasprm[2] = 20.0, -20.0


def heavy_thigh(spec: Any) -> None:
    thigh = spec.body("thigh")
    thigh.mass *= 2
    thigh.inertia = 2 * thigh.inertia


def tilted_hinge(spec: Any) -> None:
    tilt = math.radians(0.1)
    spec.joint("knee").axis = (math.sin(tilt), math.cos(tilt), 0.0)


def pins_apart(spec: Any) -> None:
    spec.site("shank_pedal").pos[1] = 1e-3


def long_rocker(spec: Any) -> None:
    spec.body("coupler").pos[0] *= 1.01


def damped(spec: Any) -> None:
    for joint in spec.joints:
        joint.damping[0] = 0.01


def six_digits(spec: Any) -> None:
    spec.compiler.savecompiled = spec.compiler.savecanonical = True


def without_lever(original: Callable[..., Any]) -> Callable[..., Any]:
    def moment_arm(motion: Motion, body: str, point: str) -> Any:
        arm = original(motion, body, point)
        if (body, point) == ("thigh", "knee"):
            return arm.real / abs(arm) + 1j * arm.imag
        return arm

    return moment_arm


def by_crank_angle(_: Any) -> Callable[..., Any]:
    def joint_moments(motion: Motion, moments: Any, cadence: Any = None) -> tuple[Any, Any]:
        angle = np.asarray(motion.crank_angle) - TOP_DEAD_CENTRE
        knee, hip = (np.interp(angle, moments.crank_angle, m, period=2 * np.pi) for m in (moments.knee, moments.hip))
        return knee, hip

    return joint_moments


def other_branch(original: Callable[..., Any]) -> Callable[..., Any]:
    def close_dyad(start: Any, end: Any, first: Any, second: Any) -> Any:
        span = end - start
        return start + np.conj((original(start, end, first, second) - start) / span) * span

    return close_dyad


def without_centripetal(_: Any) -> Callable[..., Any]:
    def carried(origin: Jet, arm: Any, first: Any, second: Any) -> Jet:
        return Jet(origin.value + arm, origin.first + 1j * first * arm, origin.second + 1j * second * arm)

    return carried


def in_map(change: Callable[..., Any], *joints: str) -> tuple[Patch, ...]:
    """Change the inverse of the torque map, array and scalar version alike: change(source, angle, direction)."""

    def wrap(original: dict[str, Any]) -> dict[str, Any]:
        def changed(inverse: Any) -> Any:
            def build(xp: Any, acos: Any) -> Any:
                source = inverse(xp, acos)
                return lambda angle, direction: change(source, angle, direction)

            return build

        return original | {joint: changed(original[joint]) for joint in joints}

    return (Patch(torque, "_INVERSES", wrap),)


def from_horizontal(original: Callable[..., None]) -> Callable[..., None]:
    def init(self: Any, moments: Any) -> None:
        original(self, replace(moments, crank_angle=moments.crank_angle - TOP_DEAD_CENTRE))

    return init


def open_table(original: Callable[..., None]) -> Callable[..., None]:
    def init(self: Any, moments: Any) -> None:
        original(self, moments)
        grid = np.arange(TABLE_SIZE + 2) * (2 * np.pi / TABLE_SIZE)
        self._tables = {joint: np.interp(grid, moments.crank_angle, getattr(moments, joint)) for joint in torque.JOINTS}

    return init


def delayed(original: Callable[..., Any]) -> Callable[..., Any]:
    def feedback(self: Any, joint: str) -> Any:
        moment, last = original(self, joint), [(2.0, 1.0)]

        def late(angle: float, rate: float) -> float:
            last.append((angle, rate))
            return float(moment(*last.pop(0)))

        return late

    return feedback


def late_torque(original: Callable[..., Any]) -> Callable[..., Any]:
    def simulate(*arguments: Any, **options: Any) -> Any:
        run = original(*arguments, **options)
        return replace(run, crank_moment=np.roll(run.crank_moment, 1))

    return simulate


def without_couples(original: Callable[..., Any]) -> Callable[..., Any]:
    def body_loads(*arguments: Any, **options: Any) -> Any:
        loads = original(*arguments, **options)
        return {body: load._replace(couple=0 * load.couple) for body, load in loads.items()}

    return body_loads


def half_more(original: Callable[..., int]) -> Callable[..., int]:
    return lambda *arguments: 3 * original(*arguments) // 2


def in_cadence(change: Callable[[Linkage, float], float]) -> tuple[Patch, ...]:
    def wrap(original: Any) -> Any:
        return property(lambda linkage: change(linkage, original.fget(linkage)))

    return (Patch(Linkage, "cadence", wrap),)


SHANK_RATE = property(lambda motion: -motion.turning["shank"][0])
BOOT = float(REFERENCE.boot_angle)
