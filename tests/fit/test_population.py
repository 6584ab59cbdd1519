"""Who can ride, against each person on their own."""

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.fit.population import PopulationFit, PowerMap, fit_population
from fes_mj.fit.seat import fit_seat
from fes_mj.linkage.design import Rider

SIZE = 30
MAP_ERROR = 0.1  # W: half of what the standard deviations of these powers are at least


@pytest.fixture(scope="module")
def study() -> PopulationFit:
    return fit_population(fes_mj.load_design("r1"), fes_mj.load_moments("p1p2"), samples=SIZE, seed=4)


@pytest.mark.long
def test_who_can_ride_is_who_statics_accepts(study: PopulationFit) -> None:
    for riders in study.riders.values():
        for thigh, shank, mass, unmoved, fitted in zip(*riders.legs, riders.unmoved, riders.fitted, strict=True):
            rider = Rider(thigh, shank, mass, riders.people.sex)
            try:
                power = fes_mj.quasi_static(fes_mj.Design("r1", study.design.linkage, rider), study.moments).power_mean
            except InputError:
                power = np.nan
            assert unmoved == pytest.approx(power, abs=1e-3, nan_ok=True)
            assert fitted > power or np.isnan(power)


@pytest.mark.long
def test_the_map_gives_the_power_of_a_seat_sought_for_one(study: PopulationFit) -> None:
    assert study.map_error < MAP_ERROR
    for riders in study.riders.values():
        rider = Rider(*(float(lengths[-1]) for lengths in riders.legs), riders.people.sex)
        static = fit_seat(study.design, rider, study.moments).static
        assert static
        assert riders.fitted[-1] == pytest.approx(static.power_mean, abs=MAP_ERROR)


@pytest.mark.long
def test_shares_and_powers_of_the_summary(study: PopulationFit) -> None:
    content = study.summary()
    assert content["samples"] == SIZE
    for who, riders in study.riders.items():
        riding = riders.unmoved[np.isfinite(riders.unmoved)]
        assert content["share_unmoved"][who] == len(riding) / SIZE
        assert content["share_fitted"][who] == 1.0
        assert content["power_mean_unmoved_W"][who] == pytest.approx(riding.mean())
        assert content["power_p10_unmoved_W"][who] <= content["power_mean_unmoved_W"][who]


def test_a_map_says_nothing_beside_a_node_without_power() -> None:
    power_map = PowerMap(np.array([0.3, 0.4, 0.5]), np.array([0.4, 0.5]), np.array([[1.0, 3], [2, 4], [np.nan, 5]]))
    assert power_map.at(np.array([0.35, 0.45]), np.array([0.45, 0.45])) == pytest.approx([2.5, np.nan], nan_ok=True)
