"""The tricycle by the joint angles alone, against the one that the made-up trial was turned on."""

from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.moments.identification import identify_tricycle
from fes_mj.moments.measurement import load_measurement
from tests.moments.made_up import R1, R2, SEAT, Trial, measurement


@pytest.mark.parametrize(
    ("trial", "expected"),
    [
        (Trial(), (abs(R1), R2, SEAT)),
        (Trial(ground=0.94 * R1), (0.94 * abs(R1), R2, SEAT)),
        (Trial(pelvis=10), (abs(R1), R2, SEAT + 10)),  # a tilt is read as another seat
        (Trial(ground=R1 * np.exp(0.1j)), (abs(R1), R2, SEAT - np.degrees(0.1))),
        (Trial(uneven=0.5), (abs(R1), R2, SEAT)),  # no time is needed
    ],
)
def test_what_was_not_declared_is_found(trial: Trial, expected: tuple[float, ...], tmp_path: Path) -> None:
    own = load_measurement(measurement(tmp_path, trial))
    numbers = identify_tricycle(own.turns, own.moments.measured_on)
    assert [number.symbol for number in numbers] == ["R1", "R2", "seat_angle"]
    assert [number.identified for number in numbers] == pytest.approx(expected, abs=1e-5)
    assert [number.declared for number in numbers] == pytest.approx((abs(R1), R2, SEAT))


@pytest.mark.long
def test_noise_is_in_the_error(tmp_path: Path) -> None:
    """Of thirty trials with half a degree of noise two thirds are within one deviation."""
    within = []
    for seed in range(30):
        own = load_measurement(measurement(tmp_path, Trial(angle_noise=0.5, seed=seed)))
        numbers = identify_tricycle(own.turns, own.moments.measured_on)
        within += [abs(number.identified - number.declared) < number.sd for number in numbers]
        assert all(number.sd < {"m": 0.002, "deg": 0.3}[number.unit] for number in numbers)
    assert 0.5 < np.mean(within) < 0.85


def test_both_angles_are_needed(tmp_path: Path) -> None:
    path = measurement(tmp_path, Trial())
    path.write_text(path.read_text().replace("[measured_on]", 'hip_angle = "none"\n[measured_on]', 1))
    with pytest.raises(InputError, match="no column 'none'"):
        load_measurement(path)
    own = load_measurement(measurement(tmp_path, Trial(turns=2.2)))
    with pytest.raises(InputError, match="1 such turns are there"):
        identify_tricycle(own.turns[:1], own.moments.measured_on)
