"""The time step of a ride in MuJoCo, chosen beforehand from the linkage and the speeds that the ride reaches."""

import math

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.checks import definitions
from fes_mj.common.errors import InputError
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.riding.differences import speed_difference, work_scale
from fes_mj.riding.trace import Trace
from fes_mj.simulation.road import RoadRun
from fes_mj.simulation.road_mjcf import TIMESTEP
from fes_mj.simulation.time_step import FINE_TURN, SHARE, TRIAL, local_errors

MOST_ROAD_STEPS = 2_000_000  # with their records two thirds of a gigabyte and half a minute
# A run may ask for so much finer a step at once. The closed form knows no joint moments and no loose crank.
FINER = 4.0
# Of an error in the step: of second order, less what is not yet so small. A mistake, as moments of a step before, is of
# first order, and one that has nothing to do with the step of none: no finer step shall hide it.
LEAST_ORDER = 1.25


def ride_timestep(trace: Trace) -> float:
    """Longest time step that keeps the predicted errors of a ride within SHARE of their limits, s; TIMESTEP at most.

    trace: the ride by the reduced equation of motion, which says how fast the crank is at each angle. Errors are of
    second order in the step: the loop gap, and the work that the scheme loses. Raises InputError where the ride would
    take more than MOST_ROAD_STEPS.
    """
    lost, gap = predicted_losses(trace, TIMESTEP)
    return _within_reason(trace, TIMESTEP / math.sqrt(max(1.0, _share("ride_energy", lost), _share("loop_gap", gap))))


def tried_timestep(trace: Trace, trial: RoadRun) -> float:
    """The same, at most, once a trial run with twice that step shows its error (step_error)."""
    finer = math.sqrt(step_error(trace, trial) / 4)
    return _within_reason(trace, trial.timestep / 2 / min(max(1.0, finer), FINER))


def finer_timestep(trace: Trace, run: RoadRun, coarser: RoadRun | None) -> float | None:
    """The step that a run needs which fails a check for its loss or its speed; None if it fails none, or if `coarser`,
    a run that failed before, says that this is no matter of the step. Raises InputError as ride_timestep.
    """
    error = step_error(trace, run)
    if error * SHARE <= 1:
        return None
    if coarser and error * (coarser.timestep / run.timestep) ** LEAST_ORDER > step_error(trace, coarser):
        return None
    return _within_reason(trace, run.timestep / min(math.sqrt(error), FINER))


def step_error(trace: Trace, run: RoadRun) -> float:
    """Work that a run loses, or how far it is from the reference, whichever is more: in units of what is allowed."""
    lost, apart = abs(run.lost) / work_scale(run.trace), speed_difference(run.trace, trace)
    return max(_share("ride_energy", lost), _share("ride_speed", apart))


def _share(check: str, error: float) -> float:
    """An error in units of what is allowed: SHARE of the limit of the check that sees it."""
    return error / (SHARE * definitions()[check].limit)


def _within_reason(trace: Trace, step: float) -> float:
    """The step, s. Raises InputError where it takes too many of them."""
    needed = float(trace.time[-1]) / step
    if not needed <= MOST_ROAD_STEPS:
        size = f"{needed:,.0f}" if math.isfinite(needed) else "endlessly many"
        raise InputError(
            f"{trace.ride.name}: the ride needs {size} time steps, more than {MOST_ROAD_STEPS:,}; give a shorter "
            "duration, or keep the links farther from their dead centres"
        )
    return step


def predicted_losses(trace: Trace, timestep: float) -> tuple[float, float]:
    """Work that the scheme loses over a ride, per its work_scale, and the largest loop gap, m; timestep: s.

    At a crank speed w the error of the power is of w^5 by masses and of w^3 by weights (local_errors).
    """
    crank_speed = np.abs(trace.crank_speed)
    by_weight, gap = local_errors(trace.ride.design, 1.0, TRIAL, FINE_TURN)
    twice, _ = local_errors(trace.ride.design, 2.0, TRIAL, FINE_TURN)
    by_mass = (twice - 2 * by_weight) / 6
    by_weight = by_weight - by_mass
    steps = (crank_speed * timestep / TRIAL) ** 2
    power, gaps = np.zeros_like(steps), []
    for leg in TWO_LEGS:

        def passed(curve: FloatArray, lag: float = leg.lag) -> FloatArray:
            return np.asarray(np.interp(trace.crank_angle - lag, FINE_TURN, curve, period=2 * np.pi))

        power += steps * (passed(by_mass) * crank_speed**3 + passed(by_weight) * crank_speed)
        gaps.append(float((passed(gap) * steps).max()))
    return abs(float(np.trapezoid(power, trace.time))) / work_scale(trace), max(gaps)
