"""Energy audit of a simulated turn: where the work of the joint moments went, every term measured on its own."""

from dataclasses import dataclass

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.legs import ONE_LEG
from fes_mj.simulation.bench import Energy, joint_drives
from fes_mj.simulation.mjcf import SERVO
from fes_mj.simulation.stepping import Sensors, feedback_loop, run_loop
from fes_mj.simulation.time_step import steps_per_turn


@dataclass(frozen=True)
class Audit(Energy):
    """Whole turns of one leg: joint_work = crank_work + kinetic + potential + damping - constraint_work + integration.

    Works in J. crank_moment is the torque sensor's, servo_moment what the servo applied, N m at crank_angle (rad),
    shape (steps - 1,).
    """

    damping: float  # taken by passive forces
    constraint_work: float  # done by the loops
    crank_angle: FloatArray
    crank_moment: FloatArray
    servo_moment: FloatArray

    @property
    def integration(self) -> float:
        """What the other terms leave: the error of the time step."""
        return self.lost - self.damping + self.constraint_work

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


def audit(case: Case) -> Audit:
    """Run one turn of a case as `simulate` does, and record the forces of every kind."""
    model, steps = case.steps.spec().compile(), steps_per_turn(case.design, case.cadence, case.timestep)
    drives = joint_drives(ONE_LEG)
    forces = ("ctrl", "qfrc_constraint", "qfrc_passive", "actuator_force")
    run = run_loop(model, feedback_loop(case.steps.torque, ONE_LEG, forces, every=1), steps)
    rows = Sensors(model, run.sensors)
    # of every joint in every step, rad
    travel = np.column_stack([rows.speed(joint) for joint in rows.joints]) * model.opt.timestep
    crank, crank_moment = model.joint("crank").dofadr[0], rows.crank_moment()[1:-1]
    motors = {model.joint(name).dofadr[0]: run.fields["ctrl"][:, model.actuator(name).id] for name in drives}

    def work(force: FloatArray) -> float:
        return float(np.sum(force * travel))

    return Audit(
        joint_work=sum(float(moment @ travel[:, joint]) for joint, moment in motors.items()),
        crank_work=float(crank_moment @ travel[:, crank]),
        kinetic=run.end_energy[1] - run.start_energy[1],
        potential=run.end_energy[0] - run.start_energy[0],
        damping=-work(run.fields["qfrc_passive"]),
        constraint_work=work(run.fields["qfrc_constraint"]),
        crank_angle=rows["crank_angle"][1:-2],
        crank_moment=crank_moment[: steps - 1],
        # the servo of the `discrete` integrator acts one step after the state that the sensors show
        servo_moment=-run.fields["actuator_force"][1:, model.actuator(SERVO).id],
    )
