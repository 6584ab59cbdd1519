"""Riders against the percentiles they were made from."""

from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.inertia import inertias
from fes_mj.linkage.riders import _SCORE_95, Population, leg_mass_after_injury, populations, preset
from tests.linkage.test_design_file import written

SIZE = 40_000
TO_PEDAL = 0.105


@pytest.fixture(params=["man", "woman"])
def people(request: pytest.FixtureRequest) -> Population:
    return populations()[request.param]


def test_a_rider_at_a_measured_percentile_has_the_measured_legs(people: Population) -> None:
    for percentile, index in ((5, 0), (50, 1), (95, 2)):
        rider = people.rider(percentile)
        measured = (people.thigh[index], people.shank[index] + TO_PEDAL, people.mass[index])
        assert (rider.thigh, rider.shank, rider.mass) == pytest.approx(measured)


def test_a_sample_has_the_percentiles_and_that_of_the_leg_which_no_draw_was_told(people: Population) -> None:
    """Percentiles 5, 50 and 95 of the sum follow from the correlation: within 3.5 of their own standard errors."""
    legs = people.sample(SIZE, np.random.default_rng(1))
    for values, measure in (
        (legs.thigh, people.thigh),
        (legs.shank - TO_PEDAL, people.shank),
        (legs.mass, people.mass),
        (legs.thigh + legs.shank - TO_PEDAL, people.leg),
    ):
        # standard error of a quantile: sqrt(p (1 - p) / n) per density there; of a normal 0.103 / sd at its 5 %
        error = np.array([np.sqrt(0.05 * 0.95) / 0.103, 0.5 / 0.399, np.sqrt(0.05 * 0.95) / 0.103]) * measure.sd
        rounding = 0.0005 * np.ones(3) if measure is not people.mass else 0.05 * np.ones(3)
        percentiles = np.percentile(values, [5, 50, 95])
        slack = 0.003 if measure is people.leg else 0.0  # m: a sum of lognormal halves has none of the measured shape
        assert np.all(np.abs(percentiles - measure) < 3.5 * error / np.sqrt(SIZE) + rounding + slack)


def test_the_percentile_95_of_the_normal_distribution() -> None:
    from statistics import NormalDist

    assert NormalDist().inv_cdf(0.95) == pytest.approx(_SCORE_95, rel=1e-14)


def test_a_stature_scales_the_median(people: Population) -> None:
    assert people.of_stature(people.stature.middle) == people.rider(50)
    taller = people.of_stature(1.1 * people.stature.middle)
    assert taller.thigh == pytest.approx(1.1 * people.thigh.middle)
    assert taller.mass / people.mass.middle == pytest.approx(1.1**2)


def test_a_design_file_names_its_rider(tmp_path: Path) -> None:
    path = written(tmp_path)
    text = path.read_text()
    path.write_text(f'rider = "ansur-woman-p95-sci"\n{text}')
    rider = load_design(path).rider
    assert (rider.thigh, rider.sex, rider.leg_mass_factor) == (pytest.approx(0.418), "female", 0.8)
    for name in ("ansur-man-p0", "ansur-man-p100", "ansur-child-p50", "ansur-man-p50-", "p50"):
        path.write_text(f'rider = "{name}"\n{text}')
        with pytest.raises(InputError, match=r"rider is 'ansur|rider is 'p50'.*ansur-man-pN"):
            load_design(path)
    path.write_text(f'{text}rider = "ansur-man-p50"\n')
    with pytest.raises(InputError, match=r"rider = .*\[linkage\]"):
        load_design(path)


def test_legs_after_injury_weigh_less_and_nothing_else_does() -> None:
    rider, factor = preset("ansur-man-p50-sci"), leg_mass_after_injury()[0]
    assert rider
    design = load_design("r1")
    light, full = (inertias(design.with_rider(mass=80.0, leg_mass_factor=f)) for f in (factor, 1.0))
    for body, inertia in full.items():
        leg = body in ("thigh", "shank")
        assert light[body].mass == pytest.approx((factor if leg else 1.0) * inertia.mass)
        assert light[body].moment == pytest.approx((factor if leg else 1.0) * inertia.moment)
