"""Who can ride, against each person on their own."""

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.fit.population import PopulationFit, fit_population
from fes_mj.fit.seat import fit_seat
from fes_mj.fit.seats import SeatLimits
from fes_mj.linkage.design import Rider

SIZE = 30
MAP_ERROR = 0.1  # W: half of what the standard deviations of these powers are at least


@pytest.fixture(scope="module")
def study() -> PopulationFit:
    return fit_population(fes_mj.load_design("r1"), fes_mj.load_moments("p1p2"), samples=SIZE, seed=4)


@pytest.mark.long
def test_who_can_ride_is_who_statics_accepts(study: PopulationFit) -> None:
    for riders in study.riders.values():
        for thigh, shank, mass, unmoved, fitted in zip(
            *riders.legs, riders.unmoved.power, riders.fitted.power, strict=True
        ):
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
        assert riders.fitted.power[-1] == pytest.approx(static.power_mean, abs=MAP_ERROR)


@pytest.mark.long
def test_shares_and_powers_of_the_summary(study: PopulationFit) -> None:
    content = study.summary()
    assert content["samples"] == SIZE
    for who, riders in study.riders.items():
        riding = riders.unmoved.power[np.isfinite(riders.unmoved.power)]
        assert content["share_unmoved"][who] == len(riding) / SIZE
        assert content["share_fitted"][who] == 1.0
        assert content["power_mean_unmoved_W"][who] == pytest.approx(riding.mean())
        assert content["power_p10_unmoved_W"][who] <= content["power_mean_unmoved_W"][who]


@pytest.mark.parametrize(
    ("name", "limits"),
    [
        ("d1", SeatLimits((0.0, 0.0), (0.0, 0.0), (0.0, 0.0))),
        ("r1", SeatLimits((0.0, 0.02), (-0.01, 0.01), (0.0, 0.0))),
        pytest.param("trt", SeatLimits((-0.01, 0.0), (0.0, 0.03), (-0.05, 0.02)), marks=pytest.mark.long),
    ],
)
def test_nobody_loses_by_a_seat_that_may_move(name: str, limits: SeatLimits, monkeypatch: pytest.MonkeyPatch) -> None:
    """Who turns, rides, stays inside as drawn does so moved: no more degrees outside, at equal ones no less power."""
    for name_of, few in {"_NODES": 2, "_FINE": 2, "_PROBES": 1, "_GENERATIONS": (2, 2, 2)}.items():
        monkeypatch.setattr(f"fes_mj.fit.population.{name_of}", few)
    study = fit_population(fes_mj.load_design(name), fes_mj.load_moments("p1p2"), samples=100, limits=limits)
    for riders in study.riders.values():
        before, after = riders.unmoved, riders.fitted
        for grade, those in before.grades.items():
            assert np.all(after.grades[grade][those])
        assert np.all(after.outside[before.turns] <= before.outside[before.turns])
        same = before.turns & (after.outside == before.outside)
        assert np.all(np.nan_to_num(after.power)[same] >= np.nan_to_num(before.power)[same])
        if limits.forward == limits.up:
            assert np.array_equal(after.power, before.power, equal_nan=True)


@pytest.mark.parametrize(("options", "said"), [({"samples": 0}, "samples is 0"), ({"seed": -1}, "seed is -1")])
def test_numbers_that_are_none_are_refused(options: dict[str, int], said: str) -> None:
    with pytest.raises(InputError, match=said):
        fit_population(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), **options)


def test_one_design_is_fitted_and_no_batch() -> None:
    batch, moments = fes_mj.load_design("d1").with_linkage(gear_ratio=np.array([[2.0], [2.1]])), fes_mj.load_moments()
    for fitted in (lambda: fit_population(batch, moments), lambda: fit_seat(batch, Rider(), moments)):
        with pytest.raises(InputError, match="d1: a batch of designs"):
            fitted()
    with pytest.raises(InputError, match="d1: a batch of designs"):
        fes_mj.Case(batch, moments)
