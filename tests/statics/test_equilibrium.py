"""The massive reference against Lagrange's equation with spectral derivatives, which shares only the positions."""

import numpy as np
import pytest

from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import GRAVITY, inertias
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import torque_map
from fes_mj.statics.equilibrium import crank_moment, virtual_work
from fes_mj.statics.turn import quasi_static


def test_power_balance_with_spectral_energy(design: Design, smooth_moments: JointMoments) -> None:
    """At constant speed: crank power = joint power - d(kinetic + potential energy)/dt."""
    turn = np.linspace(0, 2 * np.pi, 4096, endpoint=False)
    motion, cadence = kinematics.solve(design, turn), design.linkage.cadence
    energy, order = np.zeros(turn.size), np.fft.fftfreq(turn.size, 1 / turn.size)

    def derivative(values: np.ndarray) -> np.ndarray:
        return np.fft.ifft(1j * order * np.fft.fft(values))

    for body, inertia in inertias(design).items():
        centre = motion.body_point(body, inertia.centre).value
        direction = motion.direction(body)
        turning = (derivative(direction) / (1j * direction)).real  # d angle / d crank angle
        speed = cadence * np.abs(derivative(centre))
        energy += inertia.mass * (speed**2 / 2 + GRAVITY * centre.imag)
        energy += inertia.moment * (cadence * turning) ** 2 / 2
    expected = virtual_work(motion, torque_map(smooth_moments).along(motion, cadence)) - derivative(energy).real
    exact = crank_moment(motion, torque_map(smooth_moments), cadence)
    assert np.abs(exact - expected).max() < 1e-6 * np.abs(exact).max()


def test_masses_do_not_change_the_mean(design: Design, moments: JointMoments) -> None:
    static = quasi_static(design, moments)
    massive = crank_moment(static.motion, static.torque, static.cadence)
    assert massive.mean() == pytest.approx(static.crank_moment.mean(), rel=1e-9)
    assert np.ptp(massive - static.crank_moment) > 1.0  # and yet the moment itself is another
