"""Refinement of one simulated turn along two axes, time step and loop softness, and the numerical uncertainty left.

The two are varied one at a time: on the softness axis a finer step converges, to the wrong answer.
"""

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fes_mj.common.units import work_per_turn
from fes_mj.crosscheck.turn_case import Case
from fes_mj.simulation.bench import BenchOptions, Simulation
from fes_mj.simulation.mjcf import LOOP_SOLREF, Physics
from fes_mj.simulation.time_step import steps_per_turn
from fes_mj.statics.equilibrium import virtual_work

STEP_FACTORS = (1, 2, 4)  # steps a turn, times the recommended number
LOOP_TIMES = (8e-3, 4e-3, 2e-3)  # s, soft enough for the softness to dominate the loop gap
SOFTNESS_STEP_FACTOR = 2
EXACT_POINTS = 36_000  # of the quasi-static turn: its own quadrature error is below 1e-7
GRID_SAFETY = 1.25  # Roache's factor for three grids


@dataclass(frozen=True)
class Level:
    """One run: time step and loop time constant (s), loop gap (m), rms error of the crank power (W), energy lost and
    error of the work a turn, both relative.

    Relative is to the work of a turn, as Case.power_scale has it. The work is the crank's over one exact turn,
    what is stored at its ends given back.
    """

    timestep: float
    loop_time: float
    gap: float
    power_rms: float
    lost: float
    work_error: float


@dataclass(frozen=True)
class Refinement:
    """Levels along both axes, coarse to fine or soft to stiff, and the floor of the loop gap."""

    steps: tuple[Level, ...]
    softness: tuple[Level, ...]
    recommended: Level  # loops as recommended, at the step of the softness axis
    stiffer: Level  # ten times stiffer than recommended

    @property
    def gap_order(self) -> float:
        """Observed order of the loop gap in the time step."""
        return observed_order([level.timestep for level in self.steps], [level.gap for level in self.steps])

    @property
    def power_order(self) -> float:
        """Observed order of the instantaneous crank power's error in the time step."""
        return observed_order([level.timestep for level in self.steps], [level.power_rms for level in self.steps])

    @property
    def softness_order(self) -> float:
        """Observed order of the loop gap in the loops' time constant."""
        return observed_order([level.loop_time for level in self.softness], [level.gap for level in self.softness])

    @property
    def softness_floor(self) -> float:
        """Share of the recommended loop gap that ten times stiffer loops would save."""
        return 1 - self.stiffer.gap / self.recommended.gap

    @property
    def extrapolated(self) -> float:
        """Error of the work a turn at a time step of zero, by Richardson's extrapolation at second order, relative."""
        middle, fine = (level.work_error for level in self.steps[-2:])
        return (4 * fine - middle) / 3

    @property
    def uncertainty(self) -> float:
        """Discretisation error of the mean power at the recommended step, with Roache's safety factor, relative."""
        return GRID_SAFETY * abs(self.steps[0].work_error - self.extrapolated)

    def as_json(self) -> dict[str, Any]:
        """Levels, orders and what follows from them."""
        return {
            "steps": [asdict(level) for level in self.steps],
            "softness": [asdict(level) for level in (*self.softness, self.recommended, self.stiffer)],
            "gap_order": self.gap_order,
            "power_order": self.power_order,
            "softness_order": self.softness_order,
            "extrapolated_work_error": self.extrapolated,
            "power_uncertainty": self.uncertainty,
        }


def observed_order(sizes: list[float], errors: list[float]) -> float:
    """Slope of log error over log size, by least squares; NaN for errors that have no logarithm."""
    if not (np.isfinite(errors).all() and np.all(errors)):
        return math.nan
    return float(np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0])


def refine(case: Case) -> Refinement:
    """Run a case at every level; the first is the case's own run."""
    count = steps_per_turn(case.design, case.cadence, case.timestep)
    exact = case.steps.quasi_static(points=EXACT_POINTS).work_per_turn
    scale = work_per_turn(case.power_scale, case.cadence)

    def level(run: Simulation, loop_time: float) -> Level:
        lost, error = run.energy.lost / scale, (_work(case, run) - exact) / scale
        return Level(run.timestep, loop_time, run.loop_gap_max, case.rms_per_leg(run), lost, error)

    def again(factor: int, loop_time: float) -> Level:
        timestep, solref = 2 * math.pi / case.cadence / (factor * count), (loop_time, LOOP_SOLREF[1])
        return level(case.steps.run(BenchOptions(Physics(loop_solref=solref)), timestep=timestep), loop_time)

    stiff = LOOP_SOLREF[0]
    steps = (level(case.simulation, stiff), *(again(factor, stiff) for factor in STEP_FACTORS[1:]))
    softness = tuple(again(SOFTNESS_STEP_FACTOR, loop_time) for loop_time in LOOP_TIMES)
    recommended = steps[STEP_FACTORS.index(SOFTNESS_STEP_FACTOR)]
    return Refinement(steps, softness, recommended, again(SOFTNESS_STEP_FACTOR, stiff / 10))


def _work(case: Case, run: Simulation) -> float:
    """Crank work of one exact turn, J.

    The servo yields a little, so the run covers a few millionths of a rad more than a turn: the work of that angle is
    taken off, and the energy that masses and weight hold at its end and not at its beginning is added.
    """
    overrun = float(run.crank_speed.sum() * run.timestep) - 2 * math.pi * run.turns
    motion = case.steps.motion(run.crank_angle[:1])
    beyond = float(virtual_work(motion, case.steps.joint_moment(motion))[0]) * overrun
    energy = run.energy
    return (energy.crank_work + energy.kinetic + energy.potential - beyond) / run.turns
