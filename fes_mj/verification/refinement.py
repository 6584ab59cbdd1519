"""Refinement of one simulated turn along two axes, time step and loop softness, and the numerical uncertainty left.

The two are varied one at a time: on the softness axis a finer step converges, to the wrong answer.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fes_mj import kinematics
from fes_mj.checks import Check
from fes_mj.crosscheck import power_scale
from fes_mj.mjcf import LOOP_SOLREF, steps_per_turn
from fes_mj.simulation import Simulation, simulate
from fes_mj.statics import joint_moments, quasi_static, virtual_work
from fes_mj.verification.case import Case

STEP_FACTORS = (1, 2, 4)  # steps a turn, times the recommended number
LOOP_TIMES = (8e-3, 4e-3, 2e-3)  # s, soft enough for the softness to dominate the loop gap
SOFTNESS_STEP_FACTOR = 2
EXACT_POINTS = 36_000  # of the quasi-static turn: its own quadrature error is below 1e-7
SAFETY = 1.25  # Roache's factor for three grids


@dataclass(frozen=True)
class Level:
    """One run: time step and loop time constant (s), loop gap (m), energy lost and error of the work a turn, relative.

    Relative is to the work of a turn, as crosscheck.power_scale has it. The work is the crank's over one exact turn,
    what is stored at its ends given back.
    """

    timestep: float
    loop_time: float
    gap: float
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
    def energy_order(self) -> float:
        """Observed order of the lost energy in the time step."""
        return observed_order([level.timestep for level in self.steps], [level.lost for level in self.steps])

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
        """Error of the work a turn at a time step of zero, by Richardson's extrapolation at first order, relative."""
        middle, fine = (level.work_error for level in self.steps[-2:])
        return 2 * fine - middle

    @property
    def uncertainty(self) -> float:
        """Discretisation error of the mean power at the recommended step, with Roache's safety factor, relative."""
        return SAFETY * abs(self.steps[0].work_error - self.extrapolated)

    def as_json(self) -> dict[str, Any]:
        """Levels, orders and what follows from them."""
        return {
            "steps": [asdict(level) for level in self.steps],
            "softness": [asdict(level) for level in (*self.softness, self.recommended, self.stiffer)],
            "gap_order": self.gap_order,
            "energy_order": self.energy_order,
            "softness_order": self.softness_order,
            "extrapolated_work_error": self.extrapolated,
            "power_uncertainty": self.uncertainty,
        }


def observed_order(sizes: list[float], errors: list[float]) -> float:
    """Slope of log |error| over log size, by least squares; NaN for errors that have no logarithm."""
    if not (np.isfinite(errors).all() and np.all(errors)):
        return math.nan
    return float(np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0])


def refine(case: Case) -> Refinement:
    """Run a case at every level."""
    count = steps_per_turn(case.cadence)
    exact = quasi_static(case.design, case.moments, case.cadence, EXACT_POINTS)
    scale = power_scale(exact) * 2 * math.pi / case.cadence  # J

    def level(factor: int, loop_time: float) -> Level:
        run = simulate(
            case.design,
            case.moments,
            cadence=case.cadence,
            timestep=2 * math.pi / case.cadence / (factor * count),
            loop_solref=(loop_time, LOOP_SOLREF[1]),
        )
        lost, error = run.energy.lost / scale, (_work(run) - exact.work_per_turn) / scale
        return Level(run.timestep, loop_time, run.loop_gap_max, lost, error)

    stiff = LOOP_SOLREF[0]
    steps = tuple(level(factor, stiff) for factor in STEP_FACTORS)
    softness = tuple(level(SOFTNESS_STEP_FACTOR, loop_time) for loop_time in LOOP_TIMES)
    return Refinement(
        steps, softness, steps[STEP_FACTORS.index(SOFTNESS_STEP_FACTOR)], level(SOFTNESS_STEP_FACTOR, stiff / 10)
    )


def _work(run: Simulation) -> float:
    """Crank work of one exact turn, J.

    The servo yields a little, so the run covers a few millionths of a rad more than a turn: the work of that angle is
    taken off, and the energy that masses and weight hold at its end and not at its beginning is added.
    """
    overrun = float(run.crank_speed.sum() * run.timestep) - 2 * math.pi * run.turns
    motion = kinematics.solve(run.design, run.crank_angle[:1])
    beyond = float(virtual_work(motion, *joint_moments(motion, run.moments, run.cadence))[0]) * overrun
    energy = run.energy
    return (energy.crank_work + energy.kinetic + energy.potential - beyond) / run.turns


def refinement_checks(case: Case) -> list[Check]:
    """Orders, floor, uncertainty and what is left at a step of zero."""
    result = refine(case)
    return [
        case.check("gap_order", abs(result.gap_order - 2)),
        case.check("energy_order", 1 - result.energy_order),
        case.check("softness_order", 1 - result.softness_order),
        case.check("softness_floor", result.softness_floor),
        case.check("finest_work", abs(result.steps[-1].work_error)),
        case.check("extrapolated_work", abs(result.extrapolated)),
        case.check("power_uncertainty", result.uncertainty),
    ]
