"""The headless run: joint moments fed back from the state, a servo on the crank, power measured on its load side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from fes_mj.design import Design
from fes_mj.mjcf import LEGS, Leg, build_mjcf, steps_per_turn
from fes_mj.segments import GRAVITY
from fes_mj.stepping import LoopMaker, Run, feedback_loop, run_loop
from fes_mj.torque import JOINTS, JointMoments, TorqueMap


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


@dataclass(frozen=True)
class Simulation:
    """Whole measured turns; arrays have shape (steps,), sampled at the start of each step.

    Dictionaries are by joint name ("hip", "knee", "crank", "rocker", "coupler"; with two legs "right_hip" ...; moments
    only of hips and knees), the loop ones by the name of the cut joint ("pedal", "crank_pin"). A loop's force is
    complex, in the linkage's plane, and sampled at every eighth step (FORCE_EVERY).
    """

    design: Design
    moments: JointMoments
    cadence: float  # rad/s, commanded
    timestep: float  # s
    turns: int
    legs: tuple[Leg, ...]
    mass_scale: float
    gravity: float  # m/s^2
    crank_angle: NDArray[np.float64]  # rad
    crank_speed: NDArray[np.float64]  # rad/s
    crank_moment: NDArray[np.float64]  # N m on the load, all legs together
    joint_angle: dict[str, NDArray[np.float64]]  # rad
    joint_speed: dict[str, NDArray[np.float64]]  # rad/s
    joint_moment: dict[str, NDArray[np.float64]]  # N m
    loop_gap: dict[str, NDArray[np.float64]]  # m
    loop_force: dict[str, NDArray[np.complex128]]  # N
    energy: Energy

    @property
    def power(self) -> NDArray[np.float64]:
        """Crank power on the load, all legs together, W."""
        return self.crank_moment * self.crank_speed

    @property
    def power_mean(self) -> float:
        """Mean crank power of one leg over the measured turns, W."""
        return float(self.power.mean()) / len(self.legs)

    @property
    def loop_gap_max(self) -> float:
        """Largest distance between the two sides of a cut joint, m."""
        return max(float(gap.max()) for gap in self.loop_gap.values())

    @property
    def cadence_ripple(self) -> float:
        """Largest relative deviation of the crank speed from the cadence."""
        return float(np.abs(self.crank_speed / self.cadence - 1).max())


def simulate(
    design: Design,
    moments: JointMoments,
    *,
    cadence: float | None = None,
    timestep: float | None = None,
    turns: int = 1,
    legs: int = 1,
    mass_scale: float = 1.0,
    gravity: float = GRAVITY,
    loop_solref: tuple[float, float] | None = None,
    make_loop: LoopMaker = feedback_loop,
) -> Simulation:
    """Run whole turns of the model of build_mjcf (same arguments) under the torque map of `moments`.

    make_loop: compiled.compiled_loop steps in machine code, which pays beyond some hundred turns. Raises AssemblyError
    if the linkage does not close, UnstableError if the integration breaks down.
    """
    cadence = design.linkage.cadence if cadence is None else cadence
    spec = build_mjcf(
        design,
        cadence=cadence,
        timestep=timestep,
        legs=legs,
        mass_scale=mass_scale,
        gravity=gravity,
        loop_solref=loop_solref,
        drawn=False,
    )
    model, steps = spec.compile(), turns * steps_per_turn(cadence, timestep)
    drives, torque_map = joint_drives(LEGS[legs]), TorqueMap(moments)
    run = run_loop(model, make_loop(torque_map, drives), steps)
    return Simulation(
        design=design,
        moments=moments,
        cadence=cadence,
        timestep=model.opt.timestep,
        turns=turns,
        legs=LEGS[legs],
        mass_scale=mass_scale,
        gravity=gravity,
        **_measured(model, run, torque_map, drives, steps),
    )


def _measured(
    model: mujoco.MjModel, run: Run, torque_map: TorqueMap, drives: dict[str, str], steps: int
) -> dict[str, Any]:
    """The measured fields of Simulation, out of the records of a run."""
    column = {model.sensor(i).name: int(model.sensor(i).adr[0]) for i in range(model.nsensor)}
    rows, loops = run.sensors[:steps], [model.equality(i).name for i in range(model.neq)]
    forces, closed = run.fields["efc_force"], [loop for loop in loops if model.equality(loop).active0]
    angle = {model.joint(i).name: rows[:, column[f"{model.joint(i).name}_angle"]] for i in range(model.njnt)}
    speed = {name: run.sensors[:, column[f"{name}_speed"]] for name in angle}
    moment = {name: torque_map.moment(joint, angle[name], speed[name][:steps]) for name, joint in drives.items()}
    # the frame brakes the crank with this moment about +y, against its turning about -y
    crank_moment = rows[:, column["crank_torque"] + 1]

    def work(of: NDArray[np.float64], at: NDArray[np.float64]) -> float:
        """A moment that is held over each step, times the angle of the step."""
        return float(of @ (at[:-1] + at[1:])) / 2 * model.opt.timestep

    return {
        "crank_angle": angle["crank"],
        "crank_speed": speed["crank"][:steps],
        "crank_moment": crank_moment,
        "joint_angle": angle,
        "joint_speed": {name: values[:steps] for name, values in speed.items()},
        "joint_moment": moment,
        "loop_gap": {loop: np.linalg.norm(rows[:, (at := column[f"{loop}_gap"]) : at + 3], axis=1) for loop in loops},
        "loop_force": {loop: forces[:, 3 * i] + 1j * forces[:, 3 * i + 2] for i, loop in enumerate(closed)},
        "energy": Energy(
            joint_work=sum(work(moment[name], speed[name]) for name in drives),
            crank_work=work(crank_moment, speed["crank"]),
            kinetic=run.end_energy[1] - run.start_energy[1],
            potential=run.end_energy[0] - run.start_energy[0],
        ),
    }


def joint_drives(legs: tuple[Leg, ...]) -> dict[str, str]:
    """Name of each driven joint in the model -> "knee" or "hip"."""
    return {leg.prefix + joint: joint for leg in legs for joint in JOINTS}
