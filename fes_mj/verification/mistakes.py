"""How the faults of data/faults.toml are made. Each was made in print, in a tool, or nearly in this project.

In the order of the pipeline: statics, kinematics, torque map, MuJoCo model, simulation, design file; then of rides,
each in one of the two solvers.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache, cached_property
from typing import Any, cast

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.reading import DATA, read_toml
from fes_mj.crosscheck.pipeline import Pipeline
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Jet, Motion, Rotation
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.torque_map import GRID, TorqueMap
from fes_mj.riding.trace import Trace, ride as ride_by_equation
from fes_mj.simulation.bench import PLAIN_BENCH, BenchOptions
from fes_mj.simulation.mjcf import SERVO, SERVO_GAIN
from fes_mj.simulation.road import RoadRun
from fes_mj.simulation.road_control import RoadControl
from fes_mj.simulation.road_mjcf import DRIVETRAIN, ROAD
from fes_mj.simulation.time_step import steps_per_turn
from fes_mj.statics.equilibrium import equilibrium, joint_couples, moment_arm
from fes_mj.verification.faults import Fault, Steps, in_model
from fes_mj.verification.muscle_mistakes import MUSCLE_STEPS, exchanged

_FILE = DATA / "faults.toml"


def in_result(step: Callable[..., Any], change: Callable[[Any], Any]) -> Steps:
    """What a step gives is changed."""
    return {step.__name__: lambda *arguments, **options: change(step(*arguments, **options))}


def with_equilibrium(**options: Any) -> Steps:
    return {"equilibrium": lambda _, motion, moments, loads=None: equilibrium(motion, moments, loads, **options)}


def with_loads_at_joints(steps: Pipeline, motion: Motion, moments: Any, loads: Any = None) -> Any:
    moved = {body: load._replace(point=motion.points[BODIES[body][0]]) for body, load in (loads or {}).items()}
    return Pipeline.equilibrium(steps, motion, moments, moved)


def without_length(motion: Motion, body: str, point: str) -> Any:
    arm = moment_arm(motion, body, point)
    return arm.real / abs(arm) + 1j * arm.imag if (body, point) == ("thigh", "knee") else arm


def by_crank_angle(steps: Pipeline, motion: Motion, leg: str = "") -> PerJoint[FloatArray]:
    moments = cast("JointMoments", steps.drive)
    return moments.at(motion.crank_angle - moments.measured_on.top_dead_centre)


def knee_below(motion: Motion) -> Motion:
    knee, pedal = (motion.points[name].value for name in ("knee", "pedal"))
    other = pedal * np.conj(knee / pedal)  # mirrored in the line from the hip, the origin
    return replace(motion, points=motion.points | {"knee": motion.points["knee"]._replace(value=other)})


class ShankAlone(Motion):
    @property
    def joint_rotation(self) -> PerJoint[Rotation]:
        shank = self.rotation["shank"]
        return PerJoint(Rotation(-shank.first, -shank.second), self.rotation["thigh"])


def without_centripetal(motion: Motion) -> Motion:
    knee, thigh = motion.points["knee"], motion.rotation["thigh"]
    tangential = 1j * thigh.second * knee.value
    return replace(motion, points=motion.points | {"knee": Jet(knee.value, knee.first, tangential)})


def long_thigh(motion: Motion) -> Motion:
    design = motion.design.with_rider(thigh=1.0001 * motion.design.rider.thigh)
    return replace(kinematics.solve(design, motion.crank_angle), design=motion.design)


def in_map(of: type[TorqueMap] = TorqueMap, **changes: Any) -> Steps:
    """Attributes of the torque map, or of a faulty one, that are changed."""
    kind = type("FaultyMap", (of,), changes)
    return {"torque": cached_property(lambda steps: kind(steps.drive))}


class Misread(TorqueMap):
    """Another angle and rate reach either form of the map: what `read` makes of them."""

    def read(self, joint: str, angle: Any, rate: Any) -> tuple[Any, Any]:
        raise NotImplementedError

    def source_angle(self, joint: str, angle: Any, rate: Any) -> FloatArray:
        return super().source_angle(joint, *self.read(joint, angle, rate))

    def feedback(self, joint: str) -> Callable[[float, float], float]:
        moment = super().feedback(joint)
        return lambda angle, rate: moment(*self.read(joint, angle, rate))


def without_boot(torque: TorqueMap, joint: str, angle: Any, rate: Any) -> tuple[Any, Any]:
    return angle - float(torque.reference.design.boot_angle) * (joint == "knee"), rate


def from_horizontal(torque: TorqueMap) -> PerJoint[FloatArray]:
    return torque.moments.at(GRID + torque.reference.top_dead_centre)


def open_table(torque: TorqueMap) -> PerJoint[FloatArray]:
    angles, pair = torque.moments.crank_angle, PerJoint(torque.moments.knee, torque.moments.hip)
    return pair.map(lambda moment: np.interp(GRID, angles, moment))


class LateFeedback(TorqueMap):
    def feedback(self, joint: str) -> Callable[[float, float], float]:
        moment, last = super().feedback(joint), [(2.0, 1.0)]

        def late(angle: float, rate: float) -> float:
            last.append((angle, rate))
            return moment(*last.pop(0))

        return late


def scaled_by(*factors: float) -> Callable[[FloatArray], FloatArray]:
    """The first numbers of an array, times these factors."""
    return lambda values: values * np.append(factors, np.ones(len(values) - len(factors)))


def in_keyframe(field: str, joint: str, change: Callable[[float], float]) -> Steps:
    def edit(_: Pipeline, spec: Any) -> None:
        place = [hinge.name for hinge in spec.joints].index(joint)  # hinges only: one coordinate each
        values = getattr(spec.keys[0], field)
        values[place] = change(values[place])

    return {"edit_model": edit}


def coarser(steps: Pipeline, options: BenchOptions = PLAIN_BENCH, *, timestep: float | None = None, **rest: Any) -> Any:
    count = steps_per_turn(steps.design, steps.cadence, steps.timestep if timestep is None else timestep)
    return Pipeline.run(steps, options, timestep=16 * 2 * math.pi / steps.cadence / count, **rest)


def with_whole_couples(steps: Pipeline, motion: Motion, *arguments: Any, **options: Any) -> Any:
    whole, loads = Pipeline.loads(steps, motion), Pipeline.loads(steps, motion, *arguments, **options)
    return {body: load._replace(couple=whole[body].couple) for body, load in loads.items()}


def slope_reversed(case: RideCase) -> Trace:
    return ride_by_equation(replace(case.ride, road=replace(case.ride.road, slope=-case.ride.road.slope)))


def in_control(change: Callable[[RoadControl], dict[str, Any]]) -> Steps:
    """What a ride's muscles and freewheel do, in MuJoCo, with some of it changed."""
    return in_result(RideCase.control, lambda control: control._replace(**change(control)))


def without_ramp(control: RoadControl) -> dict[str, Any]:
    stimulator = control.stimulator
    return {"stimulator": stimulator._replace(stimulus=stimulator.stimulus._replace(ramp=1e-9))}


class RollingUnsigned(RoadRun):
    def resistance(self, speed: FloatArray) -> FloatArray:
        load = self.ride.load
        return np.asarray(load.rolling + load.climb + load.drag * speed * np.abs(speed))


def in_linkage(**changes: Callable[[float], float]) -> Callable[[Design], Design]:
    def edit(design: Design) -> Design:
        return design.with_linkage(**{name: change(getattr(design.linkage, name)) for name, change in changes.items()})

    return edit


_SEAT_OF_TRT = PAPER_TRICYCLE.design.linkage.seat_angle
_TILT = math.radians(0.1)

# Step of the pipeline -> what takes its place, by the name of the fault in data/faults.toml.
MISTAKEN_STEPS: dict[str, Steps] = {
    "knee_sign": with_equilibrium(couples=lambda moment: joint_couples(moment) | {"shank": moment.knee}),
    "thigh_lever": with_equilibrium(arm=without_length),
    "loads_at_joints": {"equilibrium": with_loads_at_joints},
    "map_by_crank_angle": {"joint_moment": by_crank_angle},
    "wrong_branch": in_result(Pipeline.motion, knee_below),
    "wrong_rate": in_result(
        Pipeline.motion, lambda motion: ShankAlone(motion.design, motion.crank_angle, motion.points, motion.rotation)
    ),
    "no_centripetal": in_result(Pipeline.motion, without_centripetal),
    "length_in_kinematics": in_result(Pipeline.motion, long_thigh),
    "directions_exchanged": in_map(Misread, read=lambda _, joint, angle, rate: (angle, 1.0 - 2.0 * (rate >= 0))),
    "crank_zero": in_map(table=cached_property(from_horizontal)),
    "boot_forgotten": in_map(Misread, read=without_boot),
    "open_table": in_map(table=cached_property(open_table)),
    "late_feedback": in_map(LateFeedback),
    "length_in_model": in_model("bodies", "shank", pos=scaled_by(1.01)),
    "default_solref": in_model("equalities", solref=(0.02, 1.0)),
    "soft_loops": in_model("equalities", solref=(0.002, 1.0)),
    "loops_in_milliseconds": in_model("equalities", solref=scaled_by(1e3)),
    "loop_inactive": in_model("equalities", active=False),
    "pins_apart": in_model("sites", "shank_pedal", pos=lambda pos: (pos[0], 1e-3, pos[2])),
    "weak_servo": in_model(
        "actuators", SERVO, gainprm=scaled_by(20 / SERVO_GAIN), biasprm=scaled_by(1, 1, 20 / SERVO_GAIN)
    ),
    "wrong_integrator": in_model("option", integrator=mujoco.mjtIntegrator.mjINT_IMPLICITFAST),
    "gravity_axis": in_model("option", gravity=(-9.81, 0.0, 0.0)),
    "tilted_hinge": in_model("joints", "knee", axis=(math.sin(_TILT), math.cos(_TILT), 0.0)),
    "heavy_thigh": in_model("bodies", "thigh", mass=lambda mass: 2 * mass, inertia=lambda inertia: 2 * inertia),
    "damping": in_model("joints", damping=(0.01, 0.0, 0.0)),
    "degrees": in_model("actuators", "knee", gear=scaled_by(math.degrees(1))),
    "reversed_motor": in_model("actuators", "hip", gear=scaled_by(-1)),
    "stale_keyframe": in_keyframe("qpos", "crank", lambda angle: angle + math.radians(5)),
    "reversed_start": in_keyframe("qvel", "hip", lambda speed: -speed),
    "six_digits": in_model("compiler", savecompiled=True, savecanonical=True),
    "late_torque": in_result(Pipeline.run, lambda run: replace(run, crank_moment=np.roll(run.crank_moment, 1))),
    "turn_and_a_half": {"run": lambda *args, **rest: replace(Pipeline.run(*args, **rest | {"turns": 1.5}), turns=1)},
    "no_pre_roll": {
        "run": lambda steps, options=PLAIN_BENCH, **rest: Pipeline.run(steps, replace(options, pre_roll=1), **rest)
    },
    "coarse_step": {"run": coarser},
    "no_rotary_inertia": in_result(
        Pipeline.loads, lambda loads: {body: load._replace(couple=0 * load.couple) for body, load in loads.items()}
    ),
    "inertia_not_scaled": {"loads": with_whole_couples},
}
# Step of a RideCase -> what takes its place, by the name of the fault in data/faults.toml.
RIDE_STEPS: dict[str, Steps] = {
    "freewheel_reversed": in_model("tendons", DRIVETRAIN, range=lambda limits: np.array([-limits[1], limits[0]]))
    | in_control(lambda _: {"fixed": True}),
    "rims_once": in_model("joints", ROAD, armature=0.0),
    "slope_reversed": {"reference": cached_property(slope_reversed)},
    "air_twice": in_model("joints", ROAD, damping=lambda damping: 2 * np.asarray(damping)),
    "left_leg_unshifted": in_control(lambda control: {"leg_lag": 0 * control.leg_lag}),
    "moments_late": in_control(lambda control: {"leg_lag": control.leg_lag + math.radians(10)}),
    "one_leg_counted": {"record": type("OneLegCounted", (RoadRun,), {"legs": TWO_LEGS[:1]})},
    "rolling_unsigned": {"record": RollingUnsigned},
    "stimulation_not_led": in_control(lambda control: {"stimulator": control.stimulator._replace(lag=0.0, rise=0.0)}),
    "ride_fall_for_rise": in_control(lambda control: {"rising": control.falling}),
    "ride_ramp_forgotten": in_control(without_ramp),
    "ride_lengthening_for_shortening": in_control(
        lambda control: {"muscles": control.muscles._replace(max_speed=-control.muscles.max_speed)}
    ),
    "ride_groups_exchanged": in_control(
        lambda control: {"muscles": control.muscles._replace(group=np.array(exchanged(control.muscles)["group"]))}
    ),
}
# Edits of the design where its file is read.
EDITS: dict[str, Callable[[Design], Design]] = {
    "coupler_angle": in_linkage(coupler_angle=lambda angle: angle + math.radians(5)),
    "length_in_file": in_linkage(crank=lambda crank: 1.01 * crank),
    "seat_angle": in_linkage(seat_angle=lambda _: _SEAT_OF_TRT),
    "wheel_radius": in_linkage(gear_ratio=lambda ratio: 2 * ratio),
}


@cache
def faults() -> tuple[Fault, ...]:
    """Every fault of data/faults.toml."""
    rows = read_toml(_FILE, "faults").content
    return tuple(
        Fault(
            name,
            **row,
            steps=MISTAKEN_STEPS.get(name) or MUSCLE_STEPS.get(name, {}),
            ride_steps=RIDE_STEPS.get(name, {}),
            edit=EDITS.get(name),
        )
        for name, row in rows.items()
    )
