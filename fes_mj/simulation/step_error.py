"""The error of the simulation's time step in closed form: the scheme's own poses, differenced, without MuJoCo."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import BODIES, BRANCHES, Design
from fes_mj.linkage.segments import GRAVITY, inertias

# Crank angles at which the error is evaluated: a dyad 0.1 mm from its dead centre passes it within 2 deg.
FINE_TURN = np.linspace(0.0, 2 * np.pi, 7200, endpoint=False)


class Errors(NamedTuple):
    """Errors of the scheme at a step, by name of the check that sees them; W, W and m."""

    inverse_dynamics: float  # rms of the instantaneous crank power
    mean_power: float
    loop_gap: float


def predicted_errors(design: Design, cadence: float, step: float, angles: FloatArray = FINE_TURN) -> Errors:
    """Errors of the simulation of one leg with `step` (rad of the crank) between two samples, without joint moments.

    cadence: rad/s. angles: of the crank, uniform over a turn, at which they are evaluated, rad.

    The scheme puts every link where its loops close up to the gap g = step^2/2 * (difference of sum arm * turning^2
    along the two chains), takes speeds and accelerations as differences of such poses and balances the forces there.
    """
    now, before, earlier, after = (_pose(design, angles + shift * step, step) for shift in (0, -1, -2, 1))
    motion, power = now.motion, 0.0
    for body, inertia in inertias(design).items():
        first = {link: _turned(before, now, link) / step for link in _CHAINS[body]}
        second = {link: _turned(now, after, link) / step**2 - first[link] / step for link in _CHAINS[body]}
        # speeds lag positions by half a step, which the loop makes good by extrapolation
        speed = {link: 1.5 * first[link] - 0.5 * _turned(earlier, before, link) / step for link in _CHAINS[body]}
        arms = _arms(body, now.links, inertia.centre / design.link_lengths[body])
        acceleration = cadence**2 * sum(arm * (1j * second[link] - speed[link] ** 2) for link, arm in arms)
        velocity = sum(1j * arm * now.rates[link] for link, arm in arms)
        centre = motion.body_point(body, inertia.centre)
        force = np.conj(acceleration + 1j * GRAVITY) * velocity
        exact = np.conj(cadence**2 * centre.second + 1j * GRAVITY) * centre.first
        couple = cadence**2 * (
            second[body] * now.rates[body] - motion.rotation[body].second * motion.rotation[body].first
        )
        power = power - cadence * (inertia.mass * (force - exact).real + inertia.moment * couple)
    error = np.asarray(power)
    return Errors(float(np.sqrt(np.mean(error**2))), abs(float(error.mean())), now.gap)


class _Pose(NamedTuple):
    motion: kinematics.Motion  # exact
    links: Mapping[str, ComplexArray]  # origin to tip, with the gaps, m
    rates: Mapping[str, FloatArray]  # rate of each link per crank angle, with the gaps
    gap: float  # largest, m


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


def _turned(start: _Pose, end: _Pose, link: str) -> FloatArray:
    """Angle by which a link turns between two poses, rad."""
    return np.asarray(np.angle(end.links[link] * np.conj(start.links[link])))


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
        gaps.append(float(np.abs(gap).max()))
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
    return _Pose(motion, links, rates, float(np.max(gaps)))
