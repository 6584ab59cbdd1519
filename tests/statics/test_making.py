"""What 0.1 mm does, against two designs solved one by one; rounding and sprockets by hand."""

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.variables import LENGTHS, lengths, with_lengths
from fes_mj.statics.making import OFF, nearest_gears, rounded, sensitivity


@pytest.mark.parametrize("name", ["trt", "d1"])
def test_effects_are_differences_of_two_designs(name: str) -> None:
    """Power by free-body equilibrium instead of the area of loops, to the trapezium rule's 1e-5 of the power."""
    design, moments = fes_mj.load_design(name), fes_mj.load_moments("p1p2")
    effects = {effect.length: effect for effect in sensitivity(design, moments)}
    assert effects.keys() == ({*LENGTHS} if name == "d1" else {"R1x", "R1y", "R2", "R6"})
    for length in ("R2", "R1x"):
        step = OFF / 2 * np.array([length == other for other in LENGTHS])
        shorter, longer = (
            fes_mj.quasi_static(with_lengths(design, lengths(design) + sign * step), moments, points=36000)
            for sign in (-1, 1)
        )
        assert effects[length].power == pytest.approx(longer.power_mean - shorter.power_mean, abs=1e-4)
        ranges = [np.ptp(turn.joint_range_deg.knee) for turn in (shorter, longer)]
        assert effects[length].knee == pytest.approx(ranges[1] - ranges[0], abs=1e-5)


def test_a_crank_is_nearer_to_its_dead_centre_by_what_it_is_longer() -> None:
    """Grashof: the crank takes away of the margin what it gains."""
    effects = sensitivity(fes_mj.load_design("r2"), fes_mj.load_moments("p1p2"))
    by_length = {effect.length: effect.closing for effect in effects}
    assert by_length["R2"] == pytest.approx(-OFF)
    assert by_length["R9"] == by_length["R10"] == pytest.approx(OFF)


def test_lengths_are_rounded_to_half_a_millimetre(design: fes_mj.Design) -> None:
    after = lengths(rounded(design))
    assert after * 2000 == pytest.approx(np.round(after * 2000), abs=1e-9)
    assert np.abs(after - lengths(design)).max() <= 0.25e-3 + 1e-12


def test_sprockets() -> None:
    assert nearest_gears(2.1) == (20, 42, 0.0)
    assert nearest_gears(1.0) == (20, 20, 0.0)
    crank, wheel, error = nearest_gears(1.31)
    assert error == pytest.approx(wheel / crank / 1.31 - 1)
    assert abs(error) < 0.002
