"""How many time steps a turn takes, chosen from design and cadence before anything is simulated."""

import math
from functools import lru_cache

import numpy as np

from fes_mj.common.checks import LEAST_POWER, definitions
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import crank_inertia
from fes_mj.linkage.legs import LEGS
from fes_mj.linkage.segments import GRAVITY
from fes_mj.linkage.turning import turning
from fes_mj.simulation.step_error import FINE_TURN, Errors, predicted_errors

# A predicted error may take up this share of its limit. The other half is for the joint moments, which the prediction
# leaves out, and for what is of higher order than the second.
SHARE = 0.5
# An eighth of a degree: the designs of the paper are then within 0.007 W rms, and a plain mj_step, as other tools take
# with an exported model, within 0.06 W.
FEWEST_STEPS = 2880
# Most designs are content with the fewest steps by far: if a degree between the angles shows no error above this share
# of what is allowed, 0.05 deg do not show one above all of it.
GLANCE, WELL_WITHIN = FINE_TURN[::20], 0.25
LONGEST_TIMESTEP = 0.02  # s, of those that a user asks for
# All turns together. With the near-massless run beside it that is a gigabyte and half a minute.
MOST_STEPS = 1_000_000
TRIAL = 2 * np.pi / 20_000  # rad a step: still of second order near a dead centre, not yet touched by rounding
# Runge-Kutta's steps in a turn at the fastest that a loose crank can turn: results/energy.md.
LOOSE_STEPS = 1920
POSES = 3600  # of a turn, between which a loose crank is not faster
# Second differences of positions lose 1e-16 N^2. Where that shows in the prediction at N itself, it is several times as
# large in the simulation.
ROUNDING = 1.1


def steps_per_turn(design: Design, cadence: float, timestep: float | None = None, turns: float = 1) -> int:
    """Fewest steps a turn that keep every predicted error within SHARE of its limit, and at least FEWEST_STEPS.

    cadence: rad/s. timestep: s; asks for the whole number of steps nearest to it instead. Errors are of second order
    in the step, so N is the largest of n sqrt(E(n) / (SHARE limit)) with n trial steps (docs/theory.md). Raises
    AssemblyError for a linkage that does not close, InputError where all turns together take more than MOST_STEPS, or
    a turn more than rounding allows.
    """
    needed = _needed_steps(design, cadence) if timestep is None else 2 * math.pi / cadence / timestep
    steps = max(1, round(needed)) if math.isfinite(needed) else math.inf
    if turns * steps > MOST_STEPS:
        if timestep is not None:
            way_out = "give fewer turns or a longer --timestep"
        elif steps <= MOST_STEPS:
            way_out = f"give at most {MOST_STEPS // steps} turns"
        else:
            way_out = "give a slower --cadence, or keep the links farther from their dead centres"
        size = f"{turns:g} x {steps:,}" if steps < math.inf else "endlessly many"
        raise InputError(
            f"{design.name}: at {cadence / RPM:.4g} rpm the run needs {size} time steps, more than {MOST_STEPS:,}; "
            f"{way_out}"
        )
    return int(steps)


@lru_cache(maxsize=256)
def _needed_steps(design: Design, cadence: float) -> float:
    """The rule; infinite where a link does not close in the scheme, or double precision does not bear so many steps."""
    turning(design)
    limits = definitions()
    allowed = Errors(*(SHARE * limits[name].limit for name in Errors._fields))
    allowed = allowed._replace(mean_power=LEAST_POWER * allowed.mean_power)
    with_fewest = predicted_errors(design, cadence, 2 * math.pi / FEWEST_STEPS, GLANCE)
    if np.max(np.divide(with_fewest, allowed)) <= WELL_WITHIN:
        return FEWEST_STEPS
    ratio = float(np.max(np.divide(predicted_errors(design, cadence, TRIAL), allowed)))
    if not math.isfinite(ratio):
        return math.inf
    steps = max(FEWEST_STEPS, math.ceil(2 * math.pi / TRIAL * math.sqrt(ratio)))
    final = predicted_errors(design, cadence, 2 * math.pi / steps).inverse_dynamics
    return steps if final <= ROUNDING * allowed.inverse_dynamics else math.inf


def loose_steps(design: Design, cadence: float, legs: int = 1, gravity: float = GRAVITY) -> int:
    """Steps of Runge-Kutta in a turn at the cadence for a crank that is set off with it and then left to itself.

    Weight speeds it up and moves kinetic energy to where the crank feels little inertia: I(a) w^2 / 2 + m g h(a) stays.
    At the fastest that it can turn so, a turn takes LOOSE_STEPS. Raises InputError as steps_per_turn.
    """
    steps = steps_per_turn(design, cadence)
    angle, cell = np.linspace(0, 2 * np.pi, POSES, endpoint=False, retstep=True)
    of_legs = [crank_inertia(kinematics.solve(design, angle - leg.lag)) for leg in LEGS[legs]]
    inertia = np.sum([leg.inertia for leg in of_legs], axis=0)
    rate = np.sum([leg.height_rate for leg in of_legs], axis=0)
    height = cell * (np.cumsum(rate) - (rate[0] + rate) / 2)  # from crank angle 0
    fastest = math.sqrt(float(np.max((inertia[0] * cadence**2 - 2 * gravity * height) / inertia)))
    needed = max(steps, math.ceil(LOOSE_STEPS * fastest / cadence))
    if needed > MOST_STEPS:
        raise InputError(
            f"{design.name}: a loose crank would reach {fastest / RPM:.3g} rpm, which takes {needed:,} time steps a "
            f"turn at {cadence / RPM:.4g} rpm, more than {MOST_STEPS:,}; keep the links farther from their dead centres"
        )
    return needed
