"""The headless run: joint moments fed back from the state, a servo on the crank, power measured on its load side."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import mujoco
import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.checks import Check, check, power_scale
from fes_mj.common.units import RPM, work_per_turn
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.legs import LEGS, Leg
from fes_mj.linkage.torque_source import TorqueSource
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.bearings import friction_on_crank
from fes_mj.simulation.mjcf import REAL, ModelOptions, Physics, build_mjcf
from fes_mj.simulation.stepping import PRE_ROLL, LoopMaker, Run, Sensors, feedback_loop, run_loop
from fes_mj.simulation.time_step import steps_per_turn
from fes_mj.statics.drive import Drive, driven_speed, torque_source


@dataclass(frozen=True)
class Energy:
    """Energy balance of the measured turns, J: joint_work = crank_work + kinetic + potential + lost."""

    joint_work: float  # by the hip and knee moments
    crank_work: float  # on the load
    kinetic: float  # change
    potential: float  # change

    @property
    def lost(self) -> float:
        """What went into the constraints and the integrator."""
        return self.joint_work - self.crank_work - self.kinetic - self.potential

    def as_json(self) -> dict[str, float]:
        """Every term by name, J."""
        return asdict(self) | {"lost": self.lost}


@dataclass(frozen=True, eq=False, repr=False)
class Simulation(Brief):
    """Whole measured turns; arrays have shape (steps,), sampled at the start of each step.

    drive: what moved the legs, and torque, the joint moments that it gave. activation: of the MUSCLE_GROUPS of all
    legs, one after the other, shape (steps, groups of all legs); none of them with joint moments.
    Dictionaries are by joint name ("hip", "knee", "crank", "rocker", "coupler"; with two legs "right_hip" ...; moments
    only of hips and knees), the loop ones by the name of the cut joint ("pedal", "crank_pin"). A loop's force is
    complex, in the linkage's plane, that of the first body named by Architecture.joints on the second, as
    QuasiStatic.reactions, and sampled at every eighth step (FORCE_EVERY).
    """

    design: Design
    drive: Drive
    torque: TorqueSource
    cadence: float  # rad/s, commanded
    timestep: float  # s
    turns: int
    legs: tuple[Leg, ...]
    mass_scale: float
    gravity: float  # m/s^2
    crank_angle: FloatArray  # rad
    crank_speed: FloatArray  # rad/s
    crank_moment: FloatArray  # N m on the load, all legs together
    joint_angle: dict[str, FloatArray]  # rad
    joint_speed: dict[str, FloatArray]  # rad/s
    joint_moment: dict[str, FloatArray]  # N m
    activation: FloatArray
    loop_gap: dict[str, FloatArray]  # m
    loop_force: dict[str, ComplexArray]  # N
    energy: Energy

    @property
    def brief(self) -> str:
        rpm, steps = self.cadence / RPM, len(self.crank_angle)
        return f"{self.design.name} {self.drive.name}: {self.power_mean:.2f} W at {rpm:.1f} rpm, {steps} steps"

    @property
    def activation_of(self) -> dict[str, FloatArray]:
        """Activation by name of leg and muscle group ("quadriceps", with two legs "right_quadriceps" ...)."""
        names = [leg.prefix + group for leg in self.legs for group in MUSCLE_GROUPS] if self.activation.size else []
        return dict(zip(names, self.activation.T, strict=True))

    @property
    def power(self) -> FloatArray:
        """Crank power on the load, all legs together, W."""
        return self.crank_moment * self.crank_speed

    @property
    def power_mean(self) -> float:
        """Mean crank power of one leg over the measured turns, W."""
        return float(self.power.mean()) / len(self.legs)

    @property
    def work_per_turn(self) -> float:
        """Mean work of one leg on the crank in a measured turn, J."""
        return float(work_per_turn(self.power_mean, self.cadence))

    @property
    def joint_range_deg(self) -> PerJoint[list[float]]:
        """Smallest and largest angle of knees and hips, deg."""

        def span(joint: str) -> list[float]:
            angles = np.degrees([angle for name, angle in self.joint_angle.items() if name.endswith(joint)])
            return [float(angles.min()), float(angles.max())]

        return PerJoint.of(span)

    @property
    def loop_gap_max(self) -> float:
        """Largest distance between the two sides of a cut joint, m."""
        return max(float(gap.max()) for gap in self.loop_gap.values())

    @property
    def cadence_ripple(self) -> float:
        """Largest relative deviation of the crank speed from the cadence."""
        return float(np.abs(self.crank_speed / self.cadence - 1).max())

    def checks(self, static_power: float, friction_loss: float = 0.0, subject: str = "") -> tuple[Check, ...]:
        """What of the cross-check a run and the quasi-static mean power of a leg, W, show by themselves.

        friction_loss: of the bearings of one leg, W.
        """
        scale, duration = power_scale(static_power), len(self.legs) * len(self.crank_angle) * self.timestep
        lost = self.energy.lost - friction_loss * duration
        values = {
            "mean_power": abs(self.power_mean - (static_power - friction_loss)) / scale,
            "loop_gap": self.loop_gap_max,
            "cadence_ripple": self.cadence_ripple,
            "energy_balance": abs(lost) / (scale * duration),
        }
        return tuple(check(name, value, subject) for name, value in values.items())


@dataclass(frozen=True)
class BenchOptions:
    """How a model is run.

    make_loop: compiled.compiled_loop steps in machine code, which pays beyond some hundred turns. torque: other joint
    moments than those of the drive. edit: changes the MjSpec before it is compiled. pre_roll: steps before the first
    that is measured.
    """

    physics: Physics = REAL
    make_loop: LoopMaker = feedback_loop
    torque: TorqueSource | None = None
    edit: Callable[[Spec], None] | None = None
    pre_roll: int = PRE_ROLL


PLAIN_BENCH = BenchOptions()


def simulate(
    design: Design,
    drive: Drive,
    *,
    cadence: float | None = None,
    timestep: float | None = None,
    turns: float = 1,
    legs: int = 1,
    options: BenchOptions = PLAIN_BENCH,
) -> Simulation:
    """Run turns of the model of build_mjcf (which has the same cadence, timestep and legs) under moments or muscles.

    drive: JointMoments, or Muscles, of which it is the most probable rider. Raises InputError for a linkage that does
    not turn and for joints that never enter the moments' range or leave that of the muscles' lengths, UnstableError if
    the integration breaks down.

    >>> fes_mj.simulate(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"))
    <Simulation d1 p1p2: 31.14 W at 96.4 rpm, 2880 steps>
    """
    cadence, pair = driven_speed(design, drive, cadence, legs), LEGS[legs]
    torque = options.torque or torque_source(drive, design, cadence)
    model_options = ModelOptions(options.physics, drawn=False)
    spec = build_mjcf(design, cadence=cadence, timestep=timestep, legs=legs, options=model_options)
    if options.edit:
        options.edit(spec)
    add_motor_sensors(spec, pair)
    model, steps = spec.compile(), round(turns * steps_per_turn(design, cadence, timestep, turns))
    run = run_loop(model, options.make_loop(torque, pair), steps, options.pre_roll)
    return Simulation(
        design=design,
        drive=drive,
        torque=torque,
        cadence=cadence,
        timestep=model.opt.timestep,
        turns=int(turns),
        legs=pair,
        mass_scale=options.physics.mass_scale,
        gravity=options.physics.gravity,
        **_measured(model, run, pair),
    )


def _measured(model: mujoco.MjModel, run: Run, legs: tuple[Leg, ...]) -> dict[str, Any]:
    """The measured fields of Simulation, out of the records of a run."""
    rows, loops = Sensors(model, run.sensors), [model.equality(i).name for i in range(model.neq)]
    forces, closed = run.fields["efc_force"], [loop for loop in loops if model.equality(loop).active0]
    angle = {name: rows[f"{name}_angle"][1:-1] for name in rows.joints}
    speed = {name: rows.speed(name) for name in rows.joints}
    moment = {name: rows[f"{name}_moment"][1:-1] for name in joint_drives(legs)}
    crank_moment = rows.crank_moment()[1:-1] - friction_on_crank(model, speed)

    def work(of: FloatArray, at: FloatArray) -> float:
        """Of a moment at speeds: the trapezium rule over whole turns."""
        return float(of @ at) * float(model.opt.timestep)

    return {
        "crank_angle": angle["crank"],
        "crank_speed": speed["crank"],
        "crank_moment": crank_moment,
        "joint_angle": angle,
        "joint_speed": speed,
        "joint_moment": moment,
        "activation": run.fields.get("activation", np.empty((len(angle["crank"]), 0))),
        "loop_gap": {loop: np.linalg.norm(rows.vector(f"{loop}_gap")[1:-1], axis=1) for loop in loops},
        "loop_force": {loop: -forces[:, 3 * i] - 1j * forces[:, 3 * i + 2] for i, loop in enumerate(closed)},
        "energy": Energy(
            joint_work=sum(work(moment[name], speed[name]) for name in moment),
            crank_work=work(crank_moment, speed["crank"]),
            kinetic=run.end_energy[1] - run.start_energy[1],
            potential=run.end_energy[0] - run.start_energy[0],
        ),
    }


def add_motor_sensors(spec: Spec, legs: tuple[Leg, ...]) -> None:
    """Have the moments recorded that the joints' motors are told."""
    kind, motor = mujoco.mjtSensor.mjSENS_ACTUATORFRC, mujoco.mjtObj.mjOBJ_ACTUATOR
    for name in joint_drives(legs):
        spec.add_sensor(name=f"{name}_moment", type=kind, objtype=motor, objname=name)


def joint_drives(legs: tuple[Leg, ...]) -> dict[str, str]:
    """Name of each driven joint in the model -> "knee" or "hip"."""
    return {leg.prefix + joint: joint for leg in legs for joint in JOINTS}
