"""Published problems: the chain A02 and Newton's four-bar, and what MuJoCo's defaults make of the chain."""

import numpy as np
import pytest

from fes_mj.verification.problems import (
    COUPLER,
    CRANK,
    DEFAULTS,
    GROUND,
    RECOMMENDED,
    ROCKER,
    exact_top,
    freudenstein,
    run_chain,
    run_four_bar,
)


def test_the_chain_keeps_its_energy_and_its_path() -> None:
    chain = run_chain(RECOMMENDED)
    assert chain.time[-1] == pytest.approx(10.0, abs=1e-3)
    assert chain.energy_drift < 1e-3
    assert chain.gap.max() < 1e-6
    assert chain.path_error < 1e-3
    swing = 2 * 9.81 * 3.5  # J: three bars lifted by half a metre each way, two couplers by one
    height = chain.top.imag
    assert height.min() < -0.999  # it does turn over, through the singular positions
    assert chain.energy_drift < 2e-5 * swing


def test_the_defaults_waste_energy_and_lose_the_path() -> None:
    chain = run_chain(DEFAULTS)
    assert chain.energy_drift > 0.5
    assert chain.gap.max() > 1e-4
    assert chain.path_error > 1.0


def test_the_softness_of_the_defaults_is_not_cured_by_a_finer_step() -> None:
    from dataclasses import replace

    drift = [run_chain(replace(DEFAULTS, timestep=step), duration=5.0).energy_drift for step in (2e-3, 1e-3, 5e-4)]
    assert min(drift) > 0.3 * max(drift)
    assert min(drift) > 0.2


def test_the_exact_chain_is_the_physical_pendulum_it_is_said_to_be() -> None:
    """Energy of the closed form, bar by bar: the windows are parallelograms, so couplers travel with the bars' tops."""
    time = np.arange(0, 3, 1e-4)
    top = exact_top(time, windows=2)
    speed = np.abs(np.gradient(top, time, edge_order=2))
    kinetic = 3 * 0.5 * (1 / 3) * speed**2 + 2 * 0.5 * speed**2
    potential = 9.81 * (3 * top.imag / 2 + 2 * top.imag)
    energy = kinetic + potential
    assert speed[0] == pytest.approx(1.0, rel=1e-6)
    assert np.ptp(energy[2:-2]) < 1e-4


@pytest.mark.long
def test_forty_windows() -> None:
    """The library's own size."""
    chain = run_chain(RECOMMENDED, windows=40)
    assert chain.energy_drift < 1e-3 * 20  # J, as two windows per joule of weight
    assert chain.gap.max() < 1e-6
    assert chain.path_error < 1e-3


def test_newtons_four_bar_is_a_thousand_times_inside_its_limits() -> None:
    angle, gap = run_four_bar()
    assert angle < 0.1 / 1000
    assert gap < 1e-3 / 1000


def test_freudensteins_angles_close_the_loop() -> None:
    crank = np.linspace(0, 2 * np.pi, 100)
    coupler, rocker = freudenstein(crank)
    loop = CRANK * np.exp(1j * crank) + COUPLER * np.exp(1j * coupler) - ROCKER * np.exp(1j * rocker) - GROUND
    assert np.abs(loop).max() < 1e-14
    assert np.all(np.sin(rocker) > 0)  # the open branch
