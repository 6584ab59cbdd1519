"""How many time steps a turn takes, chosen from design and cadence before anything is simulated."""

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.checks import LEAST_POWER, definitions
from fes_mj.common.errors import InputError, require_within
from fes_mj.common.units import RPM
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import BODIES, BRANCHES, Design
from fes_mj.linkage.inertia import GRAVITY, crank_inertia, inertias
from fes_mj.linkage.legs import LEGS
from fes_mj.linkage.turning import turning

# Crank angles at which the error is evaluated: a dyad 0.1 mm from its dead centre passes it within 2 deg.
FINE_TURN = kinematics.uniform_turn(7200)


class Errors(NamedTuple):
    """Errors of the scheme at a step, by name of the check that sees them; W, W and m."""

    inverse_dynamics: float  # rms of the instantaneous crank power
    mean_power: float
    loop_gap: float


def predicted_errors(design: Design, cadence: float, step: float, angles: FloatArray = FINE_TURN) -> Errors:
    """Errors of the simulation of one leg with `step` (rad of the crank) between two samples, without joint moments.

    cadence: rad/s. angles: of the crank, uniform over a turn, at which they are evaluated, rad.
    """
    power, gap = local_errors(design, cadence, step, angles)
    return Errors(float(np.sqrt(np.mean(power**2))), abs(float(power.mean())), float(gap.max()))


def local_errors(design: Design, cadence: float, step: float, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Errors of crank power (W) and loop gap (m) at each of the crank angles; arguments as of predicted_errors.

    The scheme puts every link where its loops close up to the gap g = step^2/2 * (difference of sum arm * turning^2
    along the two chains), takes speeds and accelerations as differences of such poses and balances the forces there.
    """
    poses = _pose(design, angles + step * np.arange(-2, 2)[:, None], step)  # two before, one before, now, one after
    links, rates = ({link: values[_NOW] for link, values in part.items()} for part in (poses.links, poses.rates))
    power = np.zeros(angles.shape)
    # angles by which links turn between neighbours
    turned = {link: np.angle(tips[1:] * np.conj(tips[:-1])) for link, tips in poses.links.items()}
    for body, inertia in inertias(design).items():
        first = {link: turned[link][1] / step for link in _CHAINS[body]}
        second = {link: turned[link][2] / step**2 - first[link] / step for link in _CHAINS[body]}
        # speeds lag positions by half a step, which the loop makes good by extrapolation
        speed = {link: 1.5 * first[link] - 0.5 * turned[link][0] / step for link in _CHAINS[body]}
        arms = _arms(body, links, inertia.centre / design.link_lengths[body])
        acceleration = cadence**2 * sum(arm * (1j * second[link] - speed[link] ** 2) for link, arm in arms)
        velocity = sum(1j * arm * rates[link] for link, arm in arms)
        _, centre_first, centre_second = (part[_NOW] for part in poses.motion.body_point(body, inertia.centre))
        turning_first, turning_second = (part[_NOW] for part in poses.motion.rotation[body])
        force = np.conj(acceleration + 1j * GRAVITY) * velocity
        exact = np.conj(cadence**2 * centre_second + 1j * GRAVITY) * centre_first
        couple = cadence**2 * (second[body] * rates[body] - turning_second * turning_first)
        power = power - cadence * (inertia.mass * (force - exact).real + inertia.moment * couple)
    return power, poses.gap[_NOW]


_NOW = 2  # of the poses of local_errors


class _Pose(NamedTuple):
    motion: kinematics.Motion  # exact
    links: Mapping[str, ComplexArray]  # origin to tip, with the gaps, m
    rates: Mapping[str, FloatArray]  # rate of each link per crank angle, with the gaps
    gap: FloatArray  # m


# Bodies between the frame and a body's own points: the tree that the loops close.
_CHAINS = {
    "crank": ("crank",),
    "rocker": ("rocker",),
    "coupler": ("rocker", "coupler"),
    "thigh": ("thigh",),
    "shank": ("thigh", "shank"),
}


def _arms(body: str, links: Mapping[str, ComplexArray], offset: complex) -> list[tuple[str, ComplexArray]]:
    """The chain's arms from the frame to the point at `offset` of a body, in units of its link."""
    return [(link, links[link] * (offset if link == body else 1.0)) for link in _CHAINS[body]]


def _pose(design: Design, crank_angle: FloatArray, step: float) -> _Pose:
    """Links at the crank angles with the loops as far open as the scheme leaves them."""
    motion, linkage, gaps = kinematics.solve(design, crank_angle), design.linkage, []
    point = {name: jet.value for name, jet in motion.points.items()}
    exact = {body: point[BODIES[body][1]] - point[BODIES[body][0]] for body in motion.rotation}
    links, rates = {"crank": exact["crank"]}, {"crank": motion.rotation["crank"].first}

    def close(dyad: tuple[str, str], carrier: str, offset: complex, start: complex, end: complex) -> None:
        """Close the second body's tip onto the carrier's point (chain from `end`), the first body on `start`."""
        pull = [
            sum(arm * motion.rotation[link].first ** 2 for link, arm in _arms(*chain))
            for chain in ((carrier, exact, offset), (dyad[1], exact, 1.0))
        ]
        gap = step**2 / 2 * (pull[0] - pull[1])
        gaps.append(np.abs(gap))
        arms = _arms(carrier, links, offset)
        tip = end + sum(arm for _, arm in arms) + gap - start
        velocity = sum(1j * arm * rates[link] for link, arm in arms)
        lengths = [design.link_lengths[body] for body in dyad]
        side = -1 if dyad[0] == "thigh" else BRANCHES[linkage.branch]  # the knee lies right of hip -> pedal
        along = 0.5 + (lengths[0] ** 2 - lengths[1] ** 2) / (2 * np.abs(tip) ** 2)
        links[dyad[0]] = tip * (along + side * 1j * np.sqrt(lengths[0] ** 2 / np.abs(tip) ** 2 - along**2))
        links[dyad[1]] = tip - links[dyad[0]]
        cross = (np.conj(links[dyad[0]]) * links[dyad[1]]).imag
        rates[dyad[0]] = (np.conj(velocity) * links[dyad[1]]).real / cross
        rates[dyad[1]] = -(np.conj(velocity) * links[dyad[0]]).real / cross

    with np.errstate(invalid="ignore", divide="ignore"):
        if "coupler" in exact:
            close(("rocker", "coupler"), "crank", 1.0, linkage.ground, linkage.crank_centre)
        carrier = linkage.architecture.pedal_body
        base = linkage.crank_centre if carrier == "crank" else linkage.ground
        close(("thigh", "shank"), carrier, linkage.pedal_offset, 0j, base)
    return _Pose(motion, links, rates, np.max(gaps, axis=0))


# A predicted error may take up this share of its limit. The other half is for the joint moments, which the prediction
# leaves out, and for what is of higher order than the second.
SHARE = 0.5
# An eighth of a degree: the designs of the paper are then within 0.007 W rms, and a plain mj_step, as other tools take
# with an exported model, within 0.06 W.
FEWEST_STEPS = 2880
# Most designs are content with the fewest steps by far: if a degree between the angles shows no error above this share
# of what is allowed, 0.05 deg do not show one above all of it.
GLANCE, WELL_WITHIN = FINE_TURN[::20], 0.25
SHORTEST_TIMESTEP, LONGEST_TIMESTEP = 1e-9, 0.02  # s, of those that a user asks for
LEAST_TURN = 1e-3
# All turns together. With the near-massless run beside it that is a gigabyte and half a minute.
MOST_STEPS = 1_000_000
TRIAL = 2 * np.pi / 20_000  # rad a step: still of second order near a dead centre, not yet touched by rounding
# Runge-Kutta's steps in a turn at the fastest that a loose crank can turn: results/energy.md.
LOOSE_STEPS = 1920
LOOSE_POSES = 3600  # of a turn, between which a loose crank is not faster
# Second differences of positions lose 1e-16 N^2. Where that shows in the prediction at N itself, it is several times as
# large in the simulation.
STEP_ROUNDING = 1.1


def steps_per_turn(design: Design, cadence: float, timestep: float | None = None, turns: float = 1) -> int:
    """Fewest steps a turn that keep every predicted error within SHARE of its limit, and at least FEWEST_STEPS.

    cadence: rad/s. timestep: s; asks for the whole number of steps nearest to it instead. Errors are of second order
    in the step, so N is the largest of n sqrt(E(n) / (SHARE limit)) with n trial steps (docs/theory.md). Raises
    AssemblyError for a linkage that does not close, InputError where all turns together take more than MOST_STEPS, or
    a turn more than rounding allows, and for turns or a time step that are none.
    """
    require_within("turns", turns, LEAST_TURN)
    if timestep is not None:
        require_within("timestep", timestep, SHORTEST_TIMESTEP, LONGEST_TIMESTEP, "s")
    needed = _needed_steps(design, cadence) if timestep is None else 2 * math.pi / cadence / timestep
    steps = max(1, round(needed)) if math.isfinite(needed) else math.inf
    if turns * steps > MOST_STEPS:
        if timestep is not None:
            way_out = "give fewer turns or a longer time step"
        elif steps <= MOST_STEPS:
            way_out = f"give at most {MOST_STEPS // steps} turns"
        else:
            way_out = "give a slower cadence, or keep the links farther from their dead centres"
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
    return steps if final <= STEP_ROUNDING * allowed.inverse_dynamics else math.inf


def loose_steps(design: Design, cadence: float, legs: int = 1, gravity: float = GRAVITY) -> int:
    """Steps of Runge-Kutta in a turn at the cadence for a crank that is set off with it and then left to itself.

    Weight speeds it up and moves kinetic energy to where the crank feels little inertia: I(a) w^2 / 2 + m g h(a) stays.
    At the fastest that it can turn so, a turn takes LOOSE_STEPS. Raises InputError as steps_per_turn.
    """
    steps = steps_per_turn(design, cadence)
    angle, cell = np.linspace(0, 2 * np.pi, LOOSE_POSES, endpoint=False, retstep=True)
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
