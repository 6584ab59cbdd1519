"""Speed of optimisation and sweeps, in ratios within one run.

Power evaluations beside scipy's fsolve in a loop over crank angles and beside pylinkage's kinematics alone; simulated
turns of the batch path beside the single path and beside a bare mujoco.rollout of the same models. Needs the group
"benchmark". Prints a table and writes results/benchmarks/optimization.json.
"""

import cmath
import math
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import count
from typing import Any

import mujoco
import numpy as np
from mujoco import rollout
from scipy.optimize import fsolve

from benchmarks import record
from benchmarks.core import pylinkage_six_bar, rates
from fes_mj.common.console import print_table
from fes_mj.common.units import turns_per_second
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.legs import ONE_LEG
from fes_mj.linkage.variables import lengths, with_lengths
from fes_mj.moments.files import load_moments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.torque_map import torque_map
from fes_mj.optimization.evenness import RippleLimit
from fes_mj.optimization.limits import load_limits
from fes_mj.optimization.people import sampled
from fes_mj.optimization.problem import Problem, make_problem
from fes_mj.optimization.search import BudgetSpentError, Search, differential
from fes_mj.simulation.bench import BenchOptions, simulate
from fes_mj.simulation.compiled import compiled_loop
from fes_mj.simulation.mjcf import UNDRAWN, build_mjcf
from fes_mj.simulation.time_step import steps_per_turn
from fes_mj.statics.cycles import CYCLE_POINTS, cycles, joint_speeds
from fes_mj.statics.work_table import WorkTable

DESIGNS, TURNS, THREADS = 2000, 16, 2
MOMENTS = load_moments("p1p2")
MACHINE_CODE = BenchOptions(make_loop=compiled_loop)


def population(design: Design, count: int, step: float = 0.002) -> np.ndarray:
    """Lengths of designs around one, all of which turn, shape (9, count)."""
    drawn = lengths(design)[:, None] + np.random.default_rng(0).uniform(-step, step, (9, 2 * count))
    closed = np.flatnonzero(cycles(with_lengths(design, drawn[..., None]), WorkTable.of(MOMENTS)).turns)
    return drawn[:, closed[:count]]


class ByHand:
    """The power of a CDT as one would write it without this package: fsolve at each of 360 crank angles, one table
    of moments over joint angle for each direction, virtual work.
    """

    def __init__(self, design: Design) -> None:
        from fes_mj.linkage import kinematics

        self.design = design
        crank_angle = np.radians(np.arange(360.0))
        motion = kinematics.solve(PAPER_TRICYCLE.design, crank_angle)
        torque = torque_map(MOMENTS)
        self.tables: dict[tuple[str, bool], tuple[Any, Any]] = {}
        for joint, angle in motion.joint_angle.items():
            rate = motion.joint_rate[joint]
            for extending in (True, False):
                part = (rate >= 0) == extending
                order = np.argsort(angle[part])
                moment = torque.moment(joint, angle[part], rate[part])
                self.tables[joint, extending] = angle[part][order], moment[order]
        start = kinematics.positions(design, np.zeros(1))
        legs = (
            start["rocker_joint"] - start["rocker_pivot"],
            start["crank_pin"] - start["rocker_joint"],
            start["pedal"] - start["knee"],
            start["knee"],
        )
        self.guess = [float(np.angle(leg[0])) for leg in legs]

    def closure(self, angles: Any, theta2: float) -> list[float]:
        crank, rocker, coupler, shank, thigh = (cmath.rect(1, angle) for angle in (theta2, *angles))
        linkage, rider = self.design.linkage, self.design.rider
        pedal_arm = linkage.pedal_arm * coupler * cmath.rect(1, linkage.coupler_angle)
        crank_loop = (
            linkage.pivot_to_crank + linkage.crank * crank - linkage.rocker * rocker - linkage.coupler * coupler
        )
        leg = float(self.design.knee_to_pedal) * shank + rider.thigh * thigh
        leg_loop = linkage.ground + linkage.rocker * rocker + pedal_arm - leg
        return [crank_loop.real, crank_loop.imag, leg_loop.real, leg_loop.imag]

    def power(self) -> float:
        solutions, guess = [], self.guess
        for degree in range(360):
            guess = fsolve(self.closure, guess, args=(math.radians(degree),))
            solutions.append(guess)
        _, _, shank, thigh = np.unwrap(np.array(solutions), axis=0).T
        angles = {
            "knee": math.pi - shank + thigh - float(self.design.boot_angle),
            "hip": thigh - self.design.linkage.seat_angle,
        }
        work = 0.0
        for joint, angle in angles.items():
            angle = angle - 2 * math.pi * np.round((angle[0] - 1.7) / (2 * math.pi))
            rate = (np.roll(angle, -1) - np.roll(angle, 1)) / (2 * math.radians(1))
            for extending in (True, False):
                part = (rate >= 0) == extending
                work += float(np.sum(np.interp(angle[part], *self.tables[joint, extending]) * rate[part]))
        return work / 360 * self.design.linkage.cadence


def evaluations() -> dict[str, np.ndarray]:
    """Power evaluations of a CDT per second on one core."""
    design, table = load_design("d1"), WorkTable.of(MOMENTS)
    by_hand, step_fast = ByHand(design), pylinkage_six_bar(design)
    exact = cycles(design, table).work[0, 0] * turns_per_second(design.linkage.cadence)
    assert abs(by_hand.power() / exact - 1) < 2e-3, "not the same power"
    drawn = population(design, DESIGNS)
    batch = with_lengths(design, drawn[..., None])
    problem = Problem(design, table, load_limits(), joint_speeds(design, table))
    evenly = replace(problem, ripple=RippleLimit(0.2, MOMENTS))
    for_all = replace(problem, people=sampled("population", 1000, 0))
    seated = np.insert(drawn[:, : DESIGNS // 4].T, [len(drawn)] * len(for_all.people.search), 0.0, axis=1)
    return rates(
        {
            f"ours, work of a turn from {CYCLE_POINTS} angles": (DESIGNS, lambda: cycles(batch, table)),
            "ours, with all constraints": (DESIGNS, lambda: problem.evaluate(drawn.T)),
            "ours, with all constraints and a limit on the ripple": (DESIGNS, lambda: evenly.evaluate(drawn.T)),
            "ours, for people": (DESIGNS // 4, lambda: for_all.evaluate(seated)),
            f"pylinkage step_fast, kinematics of {CYCLE_POINTS} angles": (
                DESIGNS,
                lambda: step_fast(DESIGNS * CYCLE_POINTS),
            ),
            "pylinkage step_fast, kinematics of 360 angles": (DESIGNS // 4, lambda: step_fast(DESIGNS // 4 * 360)),
            "fsolve at 360 angles": (2, lambda: [by_hand.power() for _ in range(2)]),
        }
    )


class Thorough(Search):
    """A search that computes forces and clearances of every design that keeps the limits which are known at once."""

    def __call__(self, x: np.ndarray, to_beat: object = None) -> np.ndarray:
        return super().__call__(x)


def searches() -> dict[str, np.ndarray]:
    """Designs per second of a search under the limits of what can be built, which finds the same both times."""

    def searched(kind: type[Search], problem: Problem) -> None:
        search = kind(problem, DESIGNS)
        with suppress(BudgetSpentError):
            differential(search, None, np.random.default_rng(1))

    return rates(
        {
            f"search, {linkage}{words}": (DESIGNS, partial(searched, kind, make_problem(linkage, MOMENTS)))
            for linkage in ("trt", "crt", "cdt")
            for words, kind in (("", Search), (", all computed", Thorough))
        },
        rounds=3,
    )


def simulated() -> dict[str, np.ndarray]:
    """Simulated turns of D1 with riders of different mass per second; simulate never meets a rider twice."""
    masses = (60.0 + step / 1000 for step in count())

    def new_riders() -> list[Design]:
        return [load_design("d1").with_rider(mass=next(masses)) for _ in range(TURNS)]

    riders = new_riders()
    steps = steps_per_turn(riders[0], riders[0].linkage.cadence)
    models = [build_mjcf(design, options=UNDRAWN).compile() for design in riders]
    loop = compiled_loop(torque_map(MOMENTS), ONE_LEG)
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    states = np.empty((TURNS, mujoco.mj_stateSize(models[0], full)))
    control = np.zeros((TURNS, steps, models[0].nu))
    for model, state, control_row in zip(models, states, control, strict=True):
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        mujoco.mj_getState(model, data, state, full)
        control_row[:] = data.ctrl
    workspace = [mujoco.MjData(models[0]) for _ in range(THREADS)]
    own_data = [mujoco.MjData(model) for model in models]  # made beforehand, as the rollout's workspace is

    def fed_back(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        mujoco.mj_resetDataKeyframe(model, data, 0)
        loop(model, data, steps)

    def threads(function: Any, *items: Any) -> None:
        with ThreadPoolExecutor(THREADS) as pool:
            list(pool.map(function, *items))

    return rates(
        {
            "single path: simulate": (TURNS, lambda: [simulate(design, MOMENTS) for design in new_riders()]),
            "batch path: simulate, compiled": (
                TURNS,
                lambda: [simulate(design, MOMENTS, options=MACHINE_CODE) for design in new_riders()],
            ),
            "stepping of the batch path, one thread": (TURNS, lambda: list(map(fed_back, models, own_data))),
            "bare rollout, one thread": (
                TURNS,
                lambda: rollout.rollout(models, workspace[:1], states, control, nstep=steps),
            ),
            f"stepping of the batch path, {THREADS} threads": (TURNS, lambda: threads(fed_back, models, own_data)),
            f"bare rollout, {THREADS} threads": (
                TURNS,
                lambda: rollout.rollout(models, workspace, states, control, nstep=steps),
            ),
        }
    )


RATIOS = (
    *((f"search, {linkage}", f"search, {linkage}, all computed") for linkage in ("trt", "crt", "cdt")),
    ("ours, with all constraints and a limit on the ripple", "ours, with all constraints"),
    ("ours, for people", "ours, with all constraints"),
    ("ours, with all constraints", "fsolve at 360 angles"),
    (f"ours, work of a turn from {CYCLE_POINTS} angles", f"pylinkage step_fast, kinematics of {CYCLE_POINTS} angles"),
    (f"ours, work of a turn from {CYCLE_POINTS} angles", "pylinkage step_fast, kinematics of 360 angles"),
    ("batch path: simulate, compiled", "single path: simulate"),
    ("batch path: simulate, compiled", "bare rollout, one thread"),
    ("stepping of the batch path, one thread", "bare rollout, one thread"),
    (f"stepping of the batch path, {THREADS} threads", f"bare rollout, {THREADS} threads"),
)


def main() -> None:
    """Run everything, print tables, write the results."""
    started = time.perf_counter()
    measured = evaluations() | searches() | simulated()
    print_table(
        "Rates, median of one run", ("", "per second"), [(n, f"{np.median(v):,.3g}") for n, v in measured.items()]
    )
    ratios = {f"{first} / {second}": float(np.median(measured[first] / measured[second])) for first, second in RATIOS}
    print_table("Ratios", ("", "ratio"), [(name, f"{ratio:,.3g}") for name, ratio in ratios.items()])
    content = {
        "seconds": time.perf_counter() - started,
        "median_per_s": {name: float(np.median(values)) for name, values in measured.items()},
        "ratios": ratios,
    }
    record("optimization", content)


if __name__ == "__main__":
    main()
