"""Energy audit of a simulated turn: where the work of the joint moments went, every term measured on its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fes_mj.mjcf import LEGS, build_mjcf, steps_per_turn
from fes_mj.simulation import joint_drives
from fes_mj.stepping import recording_loop, run_loop
from fes_mj.torque import TorqueMap
from fes_mj.verification.case import Case


@dataclass(frozen=True)
class Audit:
    """Whole turns of one leg: joint_work = crank_work + kinetic + potential + damping - constraint_work + integration.

    Works in J. crank_moment is the torque sensor's, servo_moment what the servo applied, N m at crank_angle (rad),
    shape (steps - 1,); advance: what the crank turned, rad.
    """

    joint_work: float
    crank_work: float
    kinetic: float  # change
    potential: float  # change
    damping: float  # taken by passive forces
    constraint_work: float  # done by the loops
    crank_angle: NDArray[np.float64]
    crank_moment: NDArray[np.float64]
    servo_moment: NDArray[np.float64]
    advance: float
    turns: int

    @property
    def integration(self) -> float:
        """What the other terms leave: the error of the time step."""
        return self.joint_work - self.crank_work - self.kinetic - self.potential - self.damping + self.constraint_work

    @property
    def terms(self) -> dict[str, float]:
        """Every term by name, J."""
        return {
            "joint work": self.joint_work,
            "crank work": self.crank_work,
            "kinetic energy, change": self.kinetic,
            "potential energy, change": self.potential,
            "damping": self.damping,
            "work of the constraints": self.constraint_work,
            "integration error": self.integration,
        }


def audit(case: Case, turns: int = 1) -> Audit:
    """Run the model of a case as `simulate` does, and record the forces of every kind."""
    model, steps = build_mjcf(case.design, cadence=case.cadence).compile(), turns * steps_per_turn(case.cadence)
    torque_map = TorqueMap(case.moments)
    drives = joint_drives(LEGS[1])
    feedback = {name: torque_map.feedback(joint) for name, joint in drives.items()}
    forces = ("ctrl", "qfrc_constraint", "qfrc_passive", "actuator_force")
    run = run_loop(model, recording_loop(feedback, forces, every=1), steps)
    column = {model.sensor(i).name: int(model.sensor(i).adr[0]) for i in range(model.nsensor)}
    speeds = [column[f"{model.joint(i).name}_speed"] for i in range(model.njnt)]
    speed = run.sensors[:, speeds]
    travel = (speed[:steps] + speed[1 : steps + 1]) / 2 * model.opt.timestep  # of every joint in every step, rad
    crank, servo = model.joint("crank").dofadr[0], model.actuator("crank_servo").id
    sensor = run.sensors[:steps, column["crank_torque"] + 1]
    motors = {model.joint(name).dofadr[0]: run.fields["ctrl"][:steps, model.actuator(name).id] for name in drives}

    def work(force: NDArray[np.float64]) -> float:
        return float(np.sum(force[:steps] * travel))

    return Audit(
        joint_work=sum(float(moment @ travel[:, joint]) for joint, moment in motors.items()),
        crank_work=float(sensor @ travel[:, crank]),
        kinetic=run.end_energy[1] - run.start_energy[1],
        potential=run.end_energy[0] - run.start_energy[0],
        damping=-work(run.fields["qfrc_passive"]),
        constraint_work=work(run.fields["qfrc_constraint"]),
        crank_angle=run.sensors[: steps - 1, column["crank_angle"]],
        crank_moment=sensor[: steps - 1],
        # the servo of the `discrete` integrator acts one step after the state that the sensors show
        servo_moment=-run.fields["actuator_force"][1:, servo],
        advance=float(run.sensors[steps, column["crank_angle"]] - run.sensors[0, column["crank_angle"]]),
        turns=turns,
    )
