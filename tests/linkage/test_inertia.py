"""Masses of bodies against the sum of their parts."""

import numpy as np
import pytest

from fes_mj.linkage.inertia import Inertia, combine, inertias


def test_a_stretched_leg_weighs_what_it_should() -> None:
    """Static moment about the hip of thigh and shank with foot lying horizontally, against the sum of their parts."""
    from fes_mj.linkage.design_file import load_design
    from fes_mj.linkage.inertia import ANKLE_FROM_HEEL, DE_LEVA, FOOT_LENGTH

    design, table = load_design("trt"), DE_LEVA["male"]
    bodies = inertias(design)
    assert bodies["thigh"].mass == pytest.approx(0.1416 * 75)
    assert bodies["shank"].mass == pytest.approx((0.0433 + 0.0137) * 75)
    to_ankle = np.exp(1j * design.boot_angle)
    foot = table["foot"].centre - ANKLE_FROM_HEEL
    centre = (
        table["shank"].mass * table["shank"].centre * 0.52
        + table["foot"].mass * (0.52 - 1j * foot * FOOT_LENGTH["male"])
    ) / (table["shank"].mass + table["foot"].mass)
    assert bodies["shank"].centre == pytest.approx(centre * to_ankle)


def test_two_halves_make_a_whole() -> None:
    """A slender bar of 2 kg and 0.6 m, cut in the middle."""
    halves = (Inertia(1.0, centre, 1.0 * 0.3**2 / 12) for centre in (0.15j, 0.45j))
    assert combine(*halves) == pytest.approx(Inertia(2.0, 0.3j, 2.0 * 0.6**2 / 12))
