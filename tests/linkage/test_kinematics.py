"""Closed-form kinematics against loop closure, a general root finder and spectral derivatives."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import fsolve

from fes_mj.linkage import kinematics
from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.kinematics import FULL_TURN


def test_every_link_keeps_its_length(design: Design) -> None:
    points = kinematics.positions(design, FULL_TURN)
    for body, length in design.link_lengths.items():
        origin, tip = (points[name] for name in BODIES[body])
        if body != "shank" or design.linkage.kind == "trt":
            assert np.abs(np.abs(tip - origin) - length).max() < 1e-12, body
    assert np.abs(np.abs(points["knee"]) - design.rider.thigh).max() < 1e-12
    assert np.abs(np.abs(points["pedal"] - points["knee"]) - design.knee_to_pedal).max() < 1e-12


def test_vector_loops_of_the_paper_close(design: Design) -> None:
    """Eq. 2, 5 and 6, 10 and 11 (with the signs their figures need), link by link."""
    motion, linkage = kinematics.solve(design), design.linkage
    leg = design.rider.thigh * motion.direction("thigh") + design.knee_to_pedal * motion.direction("shank")
    crank = linkage.crank * motion.direction("crank")
    if linkage.kind == "trt":
        assert np.abs(linkage.ground + crank - leg).max() < 1e-12
        return
    rocker, coupler = motion.direction("rocker"), motion.direction("coupler")
    four_bar = linkage.pivot_to_crank + crank - linkage.coupler * coupler - linkage.rocker * rocker
    arm = rocker if linkage.kind == "crt" else coupler * np.exp(1j * linkage.coupler_angle)
    assert np.abs(four_bar).max() < 1e-12
    assert np.abs(linkage.ground + linkage.rocker * rocker + linkage.pedal_arm * arm - leg).max() < 1e-12


@pytest.mark.parametrize("crank_angle", [0.3, 2.0, 4.4])
def test_a_root_finder_agrees(design: Design, crank_angle: float) -> None:
    """Root finding on the raw distances, started nearby, lands on the same rocker joint and knee."""
    points = {name: complex(p.flat[-1]) for name, p in _at(design, crank_angle).items()}
    linkage = design.linkage
    dyads = [("hip", "pedal", "knee", design.rider.thigh, design.knee_to_pedal)]
    if "rocker_joint" in points:
        dyads.append(("rocker_pivot", "crank_pin", "rocker_joint", linkage.rocker, linkage.coupler))
    for start, end, joint, first, second in dyads:

        def distances(xy: np.ndarray, ends: tuple = (points[start], points[end], first, second)) -> list[float]:
            z = complex(*xy)
            return [abs(z - ends[0]) - ends[2], abs(z - ends[1]) - ends[3]]

        near = points[joint] + 0.01 - 0.005j
        solved = complex(*fsolve(distances, [near.real, near.imag], xtol=1e-13))
        assert abs(solved - points[joint]) < 1e-9


def test_coefficients_are_the_derivatives(design: Design) -> None:
    """First and second kinematic coefficients against Fourier differentiation, exact for smooth periodic motion."""
    turn = np.linspace(0, 2 * np.pi, 4096, endpoint=False)
    motion, order = kinematics.solve(design, turn), np.fft.fftfreq(4096, 1 / 4096)
    for name in ("crank_pin", "rocker_joint", "pedal", "knee"):
        if name in motion.points:
            value, first, second = motion.points[name]
            spectrum = np.fft.fft(value)
            assert np.abs(np.fft.ifft(1j * order * spectrum) - first).max() < 1e-7 * np.abs(first).max(), name
            assert np.abs(np.fft.ifft(-(order**2) * spectrum) - second).max() < 1e-6 * np.abs(second).max(), name


def test_joint_rates_are_the_derivatives_of_the_joint_angles(design: Design) -> None:
    step = 1e-6
    before, after = (kinematics.solve(design, FULL_TURN + sign * step) for sign in (-1, 1))
    here = kinematics.solve(design)
    for joint, rate in here.joint_rate.items():
        slope = (after.joint_angle[joint] - before.joint_angle[joint]) / (2 * step)
        assert np.abs(slope - rate).max() < 1e-6


def test_a_batch_equals_its_designs(design: Design) -> None:
    factors = np.array([1.0, 0.999, 1.001])
    numbers = {
        name: getattr(design.linkage, name)
        for name in ("ground", "crank", "foot", "pivot_to_crank", "pedal_arm", "coupler", "rocker", "coupler_angle")
    }
    linkages = [replace(design.linkage, **{n: v * f for n, v in numbers.items()}) for f in factors]
    batch = replace(design.linkage, **{n: v * factors[:, None] for n, v in numbers.items()})
    together = kinematics.solve(replace(design, linkage=batch), FULL_TURN)
    for row, linkage in enumerate(linkages):
        alone = kinematics.solve(replace(design, linkage=linkage), FULL_TURN)
        assert np.array_equal(together.points["pedal"].value[row], alone.points["pedal"].value, equal_nan=True)
        assert np.allclose(together.joint_rate.knee[row], alone.joint_rate.knee, rtol=0, atol=1e-12, equal_nan=True)


def _at(design: Design, crank_angle: float) -> dict[str, np.ndarray]:
    return {name: np.asarray(p) for name, p in kinematics.positions(design, np.array([crank_angle])).items()}
