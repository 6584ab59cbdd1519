"""The ride in MuJoCo: the tricycle slides along the road with its legs hung on it, and nothing holds the cadence."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Literal

import mujoco
import numpy as np
from scipy.integrate import cumulative_trapezoid

from fes_mj import kinematics
from fes_mj.arrays import FloatArray
from fes_mj.design import TWO_LEGS
from fes_mj.drive import POINTS, drive
from fes_mj.extrapolation import require_motion
from fes_mj.joints import JOINTS
from fes_mj.ride import Ride, Trace
from fes_mj.segments import GRAVITY
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.bench import joint_drives
from fes_mj.simulation.compiled import compiled_controlled_loop
from fes_mj.simulation.mjcf import (
    INTEGRATORS,
    LOOP_SOLIMP,
    LOOP_SOLREF,
    NO_MINUS,
    add_motors,
    build_mjcf,
    joint_motion,
)
from fes_mj.simulation.sensors import Sensors
from fes_mj.simulation.stepping import PRE_ROLL, Loop, Run, controlled_loop, drive_addresses, run_loop
from fes_mj.torque_velocity import AT_ANY_SPEED, hill_factor

ROAD, DRIVETRAIN = "road", "drivetrain"  # the joint along the road, m; the tendon road / travel - crank, rad
# At 60 rpm finer than on the bench. At the 250 rpm that D1 reaches on the flat it makes 1200 steps a turn, and the
# scheme loses less than 4e-4 of the muscles' work.
TIMESTEP = 2e-4  # s
# MuJoCo asks whether a tendon is shorter than its limit plus this. At zero, rounding would open the freewheel.
TOUCH = 1e-9  # rad
_FORWARD = (-1.0, 0.0, 0.0)
_FAR = 1e6  # rad, an upper limit that is never reached: MuJoCo has no one-sided range


def build_road_mjcf(
    ride: Ride,
    timestep: float = TIMESTEP,
    *,
    integrator: str = "discrete",
    drawn: bool = True,
    driven: bool = True,
    compatible: bool = False,
    anchors: Literal["sites", "bodies"] = "sites",
) -> Spec:
    """The model of build_mjcf with both legs (same options), set on the road at the ride's start.

    integrator: one of mjcf.INTEGRATORS; the scheme of ride_on_road is made for `discrete`. compatible: without what MJX
    does not know, the sensor of the freewheel.

    The tricycle gets its mass and the slide joint `road`; rims are its armature, rolling resistance its friction, air
    its damping. The slope tilts gravity. The tendon `drivetrain` is road less crank: a fixed gear holds its length; a
    freewheel only keeps it from becoming shorter, and whoever steps the model raises that limit to the length reached.
    """
    spec = build_mjcf(ride.design, timestep=timestep, legs=len(TWO_LEGS), drawn=drawn, driven=False, anchors=anchors)
    spec.option.timestep, spec.option.integrator = timestep, INTEGRATORS[integrator]
    spec.comment = f"{ride.name}: both legs on a tricycle that rides"
    spec.option.gravity = (GRAVITY * math.sin(ride.road.angle), 0.0, -GRAVITY * math.cos(ride.road.angle))
    load = ride.load
    body = spec.body("tricycle")
    body.mass, body.ipos, body.inertia = load.body_mass, (0.0, 0.0, 0.0), [load.body_mass] * 3  # it never turns
    body.explicitinertial = True
    slide = body.add_joint(name=ROAD, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=_FORWARD)
    slide.armature, slide.frictionloss = ride.road.rolling_mass, load.rolling
    slide.damping = (0.0, load.drag, 0.0)
    slide.solref_friction, slide.solimp_friction = LOOP_SOLREF, LOOP_SOLIMP
    _add_drivetrain(spec, ride)
    if driven:
        add_motors(spec, TWO_LEGS)
    _add_sensors(spec, ride, driven, compatible)
    _replace_keyframe(spec, ride)
    return spec


def _add_drivetrain(spec: Spec, ride: Ride) -> None:
    tendon = spec.add_tendon(name=DRIVETRAIN)
    tendon.wrap_joint(ROAD, 1 / ride.travel)
    tendon.wrap_joint("crank", -1.0)
    if ride.fixed:
        gear = spec.add_equality(name=DRIVETRAIN, type=mujoco.mjtEq.mjEQ_TENDON)
        gear.name1, gear.data[0] = DRIVETRAIN, NO_MINUS - ride.start
        gear.solref, gear.solimp = LOOP_SOLREF, LOOP_SOLIMP
    else:
        tendon.limited, tendon.range, tendon.margin = (
            mujoco.mjtLimited.mjLIMITED_TRUE,
            (NO_MINUS - ride.start, _FAR),
            TOUCH,
        )
        tendon.solref_limit, tendon.solimp_limit = LOOP_SOLREF, LOOP_SOLIMP


def _add_sensors(spec: Spec, ride: Ride, driven: bool, compatible: bool) -> None:
    kinds, objects = mujoco.mjtSensor, mujoco.mjtObj
    for name, kind in ((f"{ROAD}_angle", kinds.mjSENS_JOINTPOS), (f"{ROAD}_speed", kinds.mjSENS_JOINTVEL)):
        spec.add_sensor(name=name, type=kind, objtype=objects.mjOBJ_JOINT, objname=ROAD)
    for joint in joint_drives(TWO_LEGS) if driven else ():
        spec.add_sensor(
            name=f"{joint}_moment", type=kinds.mjSENS_ACTUATORFRC, objtype=objects.mjOBJ_ACTUATOR, objname=joint
        )
    if not ride.fixed and not compatible:
        spec.add_sensor(
            name=DRIVETRAIN, type=kinds.mjSENS_TENDONLIMITFRC, objtype=objects.mjOBJ_TENDON, objname=DRIVETRAIN
        )


def _replace_keyframe(spec: Spec, ride: Ride) -> None:
    """Exact position and velocity at the start of the ride."""
    spec.delete(spec.key("start"))
    model = spec.compile()
    qpos, qvel = np.zeros(model.nq), np.zeros(model.nv)
    for joint, (angle, speed) in _start_state(ride).items():
        address = model.joint(joint).qposadr[0]
        qpos[address], qvel[address] = angle, speed
    spec.add_key(name="start", qpos=qpos, qvel=qvel)


def _start_state(
    ride: Ride, before: float = 0.0, gain: dict[str, float] | None = None
) -> dict[str, tuple[float, float]]:
    """Position of every joint, and its mean speed over the time `before` (s) that; with none its speed then.

    gain: acceleration of road (m/s^2) and crank (rad/s^2) in that time, by name.
    """
    speed = {ROAD: ride.launch, "crank": ride.launch / ride.travel}
    earlier = {name: speed[name] - before / 2 * (gain or {}).get(name, 0.0) for name in speed}
    state = {ROAD: (0.0, earlier[ROAD]), "crank": (ride.start, earlier["crank"])}
    for leg in TWO_LEGS:
        turn = ride.start - leg.lag - np.array([0.0, earlier["crank"] * before])
        for joint, (angle, rate, _) in joint_motion(kinematics.solve(ride.design, turn)).items():
            now, then = np.unwrap(angle)
            state[leg.prefix + joint] = float(now), float((now - then) / before if before else speed["crank"] * rate[0])
    return state


@dataclass(frozen=True, eq=False)
class RoadRun:
    """A ride simulated by MuJoCo; every sensor of the model at every step, shape (steps, ...)."""

    ride: Ride
    timestep: float  # s
    model: mujoco.MjModel
    run: Run

    @cached_property
    def sensors(self) -> Sensors:
        return Sensors(self.model, self.run.sensors)

    @cached_property
    def trace(self) -> Trace:
        """The ride as the reduced model describes it."""
        rows, load = self.sensors, self.ride.load
        distance, speed = rows[f"{ROAD}_angle"][:-1], rows.following_speed(ROAD)
        power = np.zeros(len(speed))
        for joint in joint_drives(TWO_LEGS):
            power += rows[f"{joint}_moment"][:-1] * rows.following_speed(joint)
        resistance = load.rolling * np.sign(speed) + load.climb + load.drag * speed * np.abs(speed)
        free = np.zeros(len(speed), bool) if self.ride.fixed else rows[DRIVETRAIN][:-1] == 0
        return Trace(
            ride=self.ride,
            time=self.timestep * np.arange(len(speed)),
            crank_angle=rows["crank_angle"][:-1],
            crank_speed=rows.following_speed("crank"),
            distance=distance,
            speed=speed,
            coasting=free,
            muscle_work=self._work(power),
            road_work=self._work(resistance * speed),
        )

    def _work(self, power: FloatArray) -> FloatArray:
        """Energy since the start, J."""
        return np.asarray(cumulative_trapezoid(power, dx=self.timestep, initial=0))

    @property
    def lost(self) -> float:
        """Muscle work that neither the road took nor motion and height hold at the end, J: the scheme's error."""
        trace, (before, after) = self.trace, (self.run.start_energy, self.run.end_energy)
        climbed = self.ride.load.climb * float(trace.distance[-1])  # height of the whole, which the road took
        return float(trace.muscle_work[-1] - trace.road_work[-1]) + climbed - (sum(after) - sum(before))

    @cached_property
    def loop_gap_max(self) -> float:
        """Largest distance between the two sides of a cut joint, m."""
        gaps = [name for name in self.sensors.names if name.endswith("_gap")]
        return max(float(np.linalg.norm(self.sensors.vector(gap), axis=1).max()) for gap in gaps)


def ride_on_road(ride: Ride, timestep: float = TIMESTEP, make_loop: Callable[[Ride], Loop] | None = None) -> RoadRun:
    """Ride in MuJoCo. make_loop: another than road_loop, which steps in Python.

    Raises InputError as reduced.ride, UnstableError if the integration breaks down.
    """
    for leg in TWO_LEGS:
        require_motion(ride.design, ride.moments.of_leg(leg.prefix).measured_on)
    model = build_road_mjcf(ride, timestep, drawn=False).compile()
    loop = (make_loop or road_loop)(ride)
    _start_half_a_step_early(model, ride)
    if ride.launch:
        probe = Sensors(model, run_loop(model, loop, PRE_ROLL, pre_roll=0).sensors)
        gain = {name: float(np.diff(probe[f"{name}_speed"][PRE_ROLL // 2 : -1]).mean()) for name in (ROAD, "crank")}
        _start_half_a_step_early(model, ride, {name: change / timestep for name, change in gain.items()})
    return RoadRun(ride, timestep, model, run_loop(model, loop, round(ride.duration / timestep) + 1, pre_roll=0))


def _start_half_a_step_early(model: mujoco.MjModel, ride: Ride, gain: dict[str, float] | None = None) -> None:
    """Give the keyframe the speeds that MuJoCo has there: they lag its positions by half a step. gain: _start_state."""
    for joint, (_, speed) in _start_state(ride, model.opt.timestep, gain).items():
        model.key_qvel[0, model.joint(joint).dofadr[0]] = speed


def road_loop(ride: Ride) -> Loop:
    """Joint moments commanded by crank angle, and the freewheel's limit kept at the length reached; steps in Python."""
    control = make_control(lambda function: function)

    def bound(model: mujoco.MjModel, data: mujoco.MjData, speeds: Any) -> Callable[[], None]:
        arrays = [each.tolist() if isinstance(each, np.ndarray) else each for each in control_arguments(ride, model)]
        arguments = (memoryview(model.tendon_range.reshape(-1)), *arrays[1:])
        position, ctrl = memoryview(data.qpos), memoryview(data.ctrl)
        return partial(control, arguments, position, speeds, ctrl)

    return controlled_loop(bound)


def compiled_road_loop(ride: Ride) -> Loop:
    """The same in machine code. Raises MissingPartError without numba."""
    return compiled_controlled_loop(make_control, partial(control_arguments, ride), forces=False)


def control_arguments(ride: Ride, model: mujoco.MjModel) -> tuple[Any, ...]:
    """What the control of make_control needs beside the state: arrays, and memory from step to step."""
    told = {leg: drive(ride.design, ride.moments.of_leg(leg.prefix), ride.lag) for leg in TWO_LEGS}
    relation = ride.moments.torque_velocity or AT_ANY_SPEED
    muscles = [(leg, joint) for leg in TWO_LEGS for joint in JOINTS]
    addresses = [drive_addresses(model, leg.prefix + joint) for leg, joint in muscles]
    crank = model.joint("crank")
    lag, step = ride.lag, model.opt.timestep
    return (
        model.tendon_range.reshape(-1),
        np.array([model.joint(ROAD).qposadr[0], crank.qposadr[0], crank.dofadr[0]]),
        np.array([actuator for actuator, _, _ in addresses]),
        np.array([speed for _, _, speed in addresses]),
        np.array([POINTS / (2 * math.pi) * leg.lag for leg, _ in muscles]),
        np.array([relation.max_speed[joint] for _, joint in muscles]),
        np.array([np.append(told[leg].command[joint], told[leg].command[joint][0]) for leg, joint in muscles]),
        np.array(
            [
                float(ride.fixed),
                ride.travel,
                lag,
                ride.moments.measured_on.cadence,
                math.exp(-step / lag) if lag else 0.0,
                relation.curvature,
                relation.eccentric_plateau,
            ]
        ),
        np.full(2 * len(muscles), np.nan),  # answers and commands of the step before
    )


def make_control(compiled: Callable[[Any], Any]) -> Callable[..., None]:
    """Sets the moments and the freewheel. compiled: what makes machine code of Python functions, if anything."""
    hill, cells = compiled(hill_factor), POINTS / (2 * math.pi)

    @compiled
    def control(arguments: Any, qpos: Any, speeds: Any, ctrl: Any) -> None:
        limit, places, actuators, joints, behind, fastest, tables, constants, memory = arguments
        fixed, travel, lag, measured, kept, curvature, plateau = constants
        angle, count = qpos[places[1]], len(actuators)
        if not fixed:
            limit[0] = max(limit[0], qpos[places[0]] / travel - angle)
        if lag > 0:
            angle += math.atan(speeds[places[2]] * lag) - math.atan(measured * lag)
        for muscle in range(count):
            place = (cells * angle - behind[muscle]) % POINTS
            row = int(place)
            table = tables[muscle]
            told = table[row] + (place - row) * (table[row + 1] - table[row])
            moment = told
            if lag > 0:
                if memory[muscle] == memory[muscle]:  # exact for a command that stays at its mean over the step
                    mean = (memory[count + muscle] + told) / 2
                    moment = mean + kept * (memory[muscle] - mean)
                memory[muscle], memory[count + muscle] = moment, told
            relative = (speeds[joints[muscle]] if moment > 0 else -speeds[joints[muscle]]) / fastest[muscle]
            shortening, lengthening = min(max(relative, 0.0), 1.0), max(-relative, 0.0)
            ctrl[actuators[muscle]] = moment * hill(curvature, plateau, shortening, lengthening)

    result: Callable[..., None] = control
    return result
