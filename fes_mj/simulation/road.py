"""The ride in MuJoCo: run, and described as the reduced model describes it."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, ClassVar, TypeAlias

import mujoco
import numpy as np
from scipy.integrate import cumulative_trapezoid

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.machine_code import COMPILED, readable
from fes_mj.linkage.legs import TWO_LEGS, Leg
from fes_mj.riding.ride import Ride
from fes_mj.riding.trace import Trace, ride as ride_by_equation
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.bench import joint_drives
from fes_mj.simulation.mjcf import UNDRAWN
from fes_mj.simulation.road_control import RoadControl, act, memory_of, road_control
from fes_mj.simulation.road_mjcf import DRIVETRAIN, ROAD, TIMESTEP, build_road_mjcf, start_state
from fes_mj.simulation.stepping import Loop, Run, Sensors, controlled_loop, energy, run_loop

INSTANT = 1e-5  # s, in which the acceleration at the start is read off
MakeControl: TypeAlias = Callable[[mujoco.MjModel], RoadControl]  # the control of a ride in its model


def road_loop(make_control: MakeControl) -> Loop:
    """The loop that steps a ride under a control: in machine code where numba is installed, elsewhere in Python."""
    if COMPILED:
        from fes_mj.simulation.compiled import compiled_road_loop

        return compiled_road_loop(make_control)
    return interpreted_road_loop(make_control)


def interpreted_road_loop(make_control: MakeControl) -> Loop:
    """The loop in Python."""

    def bound(model: mujoco.MjModel, data: mujoco.MjData, speeds: Any) -> Callable[[], None]:
        control, memory = readable(make_control(model)), memory_of(model)
        position, ctrl, rates = data.qpos, data.ctrl, np.asarray(speeds)
        return lambda: act(control, memory, position, rates, ctrl)

    return controlled_loop(bound)


@dataclass(frozen=True, eq=False, repr=False)
class RoadRun(Brief):
    """A ride simulated by MuJoCo; every sensor of the model at every step, shape (steps, ...).

    start_energy: potential and kinetic, of the exact start, J.
    """

    ride: Ride
    timestep: float  # s
    model: mujoco.MjModel
    start_energy: float
    run: Run
    legs: ClassVar[tuple[Leg, ...]] = TWO_LEGS  # whose muscles count

    @property
    def brief(self) -> str:
        return f"{self.ride.name}, {len(self.run.sensors) - 1} steps"

    @cached_property
    def sensors(self) -> Sensors:
        return Sensors(self.model, self.run.sensors)

    @cached_property
    def trace(self) -> Trace:
        """The ride as the reduced model describes it."""
        rows, speed = self.sensors, self.sensors.following_speed(ROAD)
        free = np.zeros(len(speed), bool) if self.ride.fixed else rows[DRIVETRAIN][:-1] == 0
        return Trace(
            ride=self.ride,
            time=self.timestep * np.arange(len(speed)),
            crank_angle=rows["crank_angle"][:-1],
            crank_speed=rows.following_speed("crank"),
            distance=rows[f"{ROAD}_angle"][:-1],
            speed=speed,
            coasting=free,
            muscle_work=self._work(self.muscle_power()),
            road_work=self._work(self.resistance(speed) * speed),
        )

    def muscle_power(self) -> FloatArray:
        """Of all joint moments, W."""
        rows = self.sensors
        powers = [rows[f"{joint}_moment"][:-1] * rows.following_speed(joint) for joint in joint_drives(self.legs)]
        return np.asarray(np.sum(powers, axis=0))

    def resistance(self, speed: FloatArray) -> FloatArray:
        """Force of the road against going forward at these speeds (m/s), N."""
        load = self.ride.load
        return np.asarray(load.rolling * np.sign(speed) + load.climb + load.drag * speed * np.abs(speed))

    def _work(self, power: FloatArray) -> FloatArray:
        """Energy since the start, J."""
        return np.asarray(cumulative_trapezoid(power, dx=self.timestep, initial=0))

    @property
    def lost(self) -> float:
        """Muscle work that neither the road took nor motion and height hold at the end, J: the scheme's error."""
        speed = self.sensors.following_speed(ROAD)
        friction = self.resistance(speed) - self.ride.load.climb  # the height is a part of the energy
        power = self.muscle_power() - friction * speed
        work = float(self._work(power)[-1] + power[-1] * self.timestep)  # the energy is that after the last step
        return work - (sum(self.run.end_energy) - self.start_energy)

    @cached_property
    def loop_gap_max(self) -> float:
        """Largest distance between the two sides of a cut joint, m."""
        gaps = [name for name in self.sensors.names if name.endswith("_gap")]
        return max(float(np.linalg.norm(self.sensors.vector(gap), axis=1).max()) for gap in gaps)


def ride_on_road(
    ride: Ride,
    timestep: float = TIMESTEP,
    *,
    until: float | None = None,
    edit: Callable[[Spec], None] = lambda _: None,
    control: MakeControl | None = None,
    make_loop: Callable[[MakeControl], Loop] = road_loop,
    record: type[RoadRun] = RoadRun,
) -> RoadRun:
    """Ride in MuJoCo.

    until: s, if not to the end of the ride. edit: changes the model before it is compiled. control: another than
    road_control. make_loop: another loop than road_loop. record: what is made of the sensors. Raises InputError as
    trace.ride, UnstableError if the integration breaks down.
    """
    ride.require_possible()
    spec = build_road_mjcf(ride, timestep, options=UNDRAWN)
    edit(spec)
    model, loop = spec.compile(), make_loop(control or partial(road_control, ride))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    start_energy = sum(energy(model, data))
    _start_half_a_step_early(model, ride)
    run = run_loop(model, loop, round((until or ride.duration) / timestep) + 1, pre_roll=0)
    return record(ride, timestep, model, start_energy, run)


def _start_half_a_step_early(model: mujoco.MjModel, ride: Ride) -> None:
    """Give the keyframe the speeds that MuJoCo has there: they lag its positions by half a step.

    What changes in that time is as the reduced equation has it: that the ride begins at its launch speed is no result.
    """
    rates = None
    if ride.launch:
        begun = ride_by_equation(replace(ride, duration=INSTANT))
        speeds = {ROAD: begun.speed, "crank": begun.crank_speed}
        rates = {name: float(speed[-1] - speed[0]) / INSTANT for name, speed in speeds.items()}
    for joint, (_, speed) in start_state(ride, model.opt.timestep, rates).items():
        model.key_qvel[0, model.joint(joint).dofadr[0]] = speed
