"""What each setting of the simulation is worth, and what a mean over the turn: the numbers of docs/theory.md.

    python -m studies.settings [--out results/settings.md]

Every design of the paper with the moments of group p1p2, one setting changed at a time.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any
from unittest.mock import patch

import mujoco
import numpy as np

import fes_mj
from fes_mj.common.arrays import FloatArray
from fes_mj.common.console import track
from fes_mj.common.markdown import Table
from fes_mj.common.units import RPM
from fes_mj.common.writing import write_text
from fes_mj.crosscheck.pipeline import Pipeline
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.linkage.inertia import inertias
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.legs import Leg
from fes_mj.linkage.torque_source import TorqueSource
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.simulation import mjcf, stepping
from fes_mj.simulation.bench import BenchOptions, Simulation
from fes_mj.simulation.mjcf import Physics
from fes_mj.simulation.stepping import FORCE_EVERY, Loop, actuation
from fes_mj.simulation.time_step import predicted_errors
from fes_mj.statics.turn import quasi_static

ROOT = Path(__file__).parents[1]
SLOW = 1.0  # rpm
FINE = 2e-5  # s
MANY = 36_000  # crank angles
_TURN = np.radians(np.arange(360.0))
NO_MOMENTS = JointMoments("none", _TURN, 0 * _TURN, 0 * _TURN)


def measured(name: str) -> dict[str, Any]:
    """One row: as shipped, then with each setting changed."""
    design, moments = fes_mj.load_design(name), fes_mj.load_moments("p1p2")
    case = Case(design, moments)
    step = case.cadence * case.simulation.timestep
    rms, predicted = case.rms_per_leg(case.simulation), predicted_errors(design, case.cadence, step).inverse_dynamics
    with patch.object(stepping, "LOOP_SOFTNESS", 1.0):
        soft, default = case.steps.run(), _DefaultLoops(design, moments).run()
    with patch.object(mjcf, "SERVO_GAIN", 1e6):
        weak, slow = case.steps.run(), Case(design, moments, SLOW * RPM).simulation
    loops = (Physics(loop_solref=(constant, 1.0)) for constant in (1e-5, 1e-7))
    slower, stiff = (case.steps.run(BenchOptions(physics), timestep=FINE) for physics in loops)
    idle = Case(design, NO_MOMENTS)
    mean = quasi_static(design, moments).power_mean
    return {
        "design": name.upper(),
        "rms, W @.4f": rms,
        "of it by joint moments, W @.4f": float(np.sqrt(max(0.0, rms**2 - predicted**2))),
        "MuJoCo's loops: gap, mm @.1f": 1e3 * default.loop_gap_max,
        "mean power, % @+.0f": 100 * (default.power_mean / case.statics.power_mean - 1),
        "1e-5 s at 0.02 ms: gap, times @.1f": slower.loop_gap_max / stiff.loop_gap_max,
        "MuJoCo's softness: rms, W @.3f": case.rms_per_leg(soft),
        "servo of 1e6: rms, W @.4f": case.rms_per_leg(weak),
        "its ripple at 1 rpm @.1e": slow.cadence_ripple,
        "plain mj_step: rms, W @.4f": case.rms_per_leg(case.steps.run(PLAIN_LOOP)),
        "its error per e1 @.2f": per_first_order(idle, idle.steps.run(PLAIN_LOOP)),
        "static mean against 36,000 angles @.0e": abs(mean / quasi_static(design, moments, points=MANY).power_mean - 1),
    }


class _DefaultLoops(Pipeline):
    """With what MuJoCo takes for a constraint that says nothing."""

    def edit_model(self, spec: Any) -> None:
        for loop in spec.equalities:
            loop.solref, loop.solimp = [0.02, 1.0], [0.9, 0.95, 0.001, 0.5, 2.0]


def plain_loop(torque: TorqueSource, legs: tuple[Leg, ...]) -> Loop:
    """mj_step as other tools take it: moments and centrifugal forces by the speeds of half a step before."""

    def loop(model: mujoco.MjModel, data: mujoco.MjData, count: int) -> tuple[FloatArray, dict[str, FloatArray]]:
        controls = {leg: torque.control(leg, model.opt.timestep) for leg in legs}
        act = actuation(controls, model, data, memoryview(data.qvel))
        sensors, forces = np.empty((count + 1, model.nsensordata)), []
        for row in range(count):
            act()
            mujoco.mj_step(model, data)
            sensors[row] = data.sensordata
            if not row % FORCE_EVERY:
                forces.append(data.efc_force.copy())
        return sensors, {"efc_force": np.array(forces)}

    return loop


PLAIN_LOOP = BenchOptions(make_loop=plain_loop)


def per_first_order(case: Case, run: Simulation) -> float:
    """Error of the crank power per the e1 of docs/theory.md, by least squares."""
    motion = case.steps.motion(run.crank_angle)
    expected = first_order_error(motion, case.cadence, run.timestep)
    error = run.power - case.reference_power(run)
    return float(np.einsum("a,a->", error, expected) / np.einsum("a,a->", expected, expected))


def first_order_error(motion: Motion, cadence: float, timestep: float) -> FloatArray:
    """e1 = h w^4 sum m Re(conj(z') H(phi', phi'')), W; H(x, y) = - sum r x y over the chain to each centre of mass."""
    design, total = motion.design, 0.0
    for body, inertia in inertias(design).items():
        lagging = -sum(arm * first * second for arm, first, second in _chain(motion, design, body, inertia.centre))
        velocity = motion.body_point(body, inertia.centre).first
        total = total + inertia.mass * (np.conj(velocity) * lagging).real
    return np.asarray(timestep * cadence**4 * total)


def _chain(motion: Motion, design: Design, body: str, centre: complex) -> list[tuple[Any, Any, Any]]:
    """Arms from the frame to a body's centre of mass, m, with both rates of the link that each belongs to."""
    before = {"coupler": "rocker", "shank": "thigh"}.get(body)
    arms = [(body, motion.body_point(body, centre).value - motion.points[BODIES[body][0]].value)]
    if before:
        origin, tip = (motion.points[name].value for name in BODIES[before])
        arms.append((before, tip - origin))
    return [(arm, motion.rotation[link].first, motion.rotation[link].second) for link, arm in arms]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "results" / "settings.md")
    arguments = parser.parse_args()
    rows = [measured(name) for name in track(DESIGNS, "measuring the settings")]
    columns = {name: form for name, _, form in (key.partition(" @") for key in rows[0])}
    note = (
        "rms: crank power over the turn against the exact inverse dynamics. Of it by joint moments: beyond what the "
        "closed form of the time step's error says. MuJoCo's loops: solref 0.02 s, solimp 0.9, and its softness, a "
        "ten-thousandth of the bodies' inverse weights; that softness alone in the column after next. 1e-5 s: time "
        "constant of the loops, against 1e-7 s. Servo in N m s/rad. Plain mj_step: without the lead of half a step; "
        "its error per the e1 of docs/theory.md is by least squares and without joint moments."
    )
    table = Table("One setting changed at a time", columns, [tuple(row.values()) for row in rows], note)
    origin = "Written by `python -m studies.settings`; see docs/theory.md."
    write_text(arguments.out, f"# What each setting of the simulation is worth\n\n{origin}\n\n{table.markdown()}")


if __name__ == "__main__":
    main()
