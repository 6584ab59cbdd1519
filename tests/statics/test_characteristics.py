"""What a turn is like, on curves and linkages with known answers."""

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage import kinematics
from fes_mj.linkage.variables import replaced
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.statics.characteristics import (
    energy_swing,
    extent,
    inactive_share,
    motion_characteristics,
    power_characteristics,
)

ANGLE = np.linspace(0, 2 * np.pi, 3600, endpoint=False)
STEP = 1 / len(ANGLE)


def test_extent_of_the_trt() -> None:
    """From the hip to the far side of the crank circle."""
    motion = kinematics.solve(PAPER_TRICYCLE.design)
    crank = PAPER_TRICYCLE.design.linkage.crank
    assert extent(motion)[0] == pytest.approx(-PAPER_TRICYCLE.design.linkage.crank_centre.real + crank, abs=1e-5)


def test_inactive_share_of_a_sine() -> None:
    assert inactive_share(np.sin(ANGLE)) == pytest.approx(0.5, abs=1e-3)
    assert inactive_share(2 + np.sin(ANGLE)) == 0


def test_energy_swing_of_a_sine() -> None:
    """The integral of A sin(wt) swings by 2 A / w."""
    assert energy_swing(10 + 4 * np.sin(ANGLE), 5.0) == pytest.approx(2 * 4 / 5.0, rel=1e-3)


@pytest.mark.parametrize("turns", [1, 3])
def test_power_of_a_sine(turns: int) -> None:
    """With A sin about a mean P the energy swings by 2 A / w, per work 2 pi P / w of a turn: A / (pi P)."""
    summary = power_characteristics(np.tile(10 + 4 * np.sin(ANGLE), turns), turns)
    assert summary["power_peak_to_peak_W"] == pytest.approx(8)
    assert summary["power_peak_to_mean"] == pytest.approx(1.4)
    assert summary["energy_fluctuation"] == pytest.approx(4 / (np.pi * 10), rel=2 * STEP * np.pi)
    negative = power_characteristics(np.sin(ANGLE) - 2)
    assert negative["inactive_zone_share"] == 1
    assert np.isnan([negative["power_peak_to_mean"], negative["energy_fluctuation"]]).all()


def test_a_batch_has_the_characteristics_of_each() -> None:
    design, thighs = fes_mj.load_design("d1"), [0.50, 0.52, 0.54]
    batch = motion_characteristics(kinematics.solve(replaced(design, {"thigh": np.array(thighs)[:, None]})))
    for i, thigh in enumerate(thighs):
        single = motion_characteristics(kinematics.solve(replaced(design, {"thigh": thigh})))
        for key, value in single.items():
            assert batch[key][i] == pytest.approx(value, rel=1e-12)
