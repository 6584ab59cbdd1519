"""Trials of known truth: right ones in every convention give no warning, wrong in one place each give theirs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.moments.measurement import load_measurement
from tests.moments.made_up import MEASURED_ON, R1, SIGNS, Trial, changed, measurement, work

PLAIN = Trial()


def warnings(path: Path) -> set[str]:
    return {misreading.name for misreading in load_measurement(path).moments.misreadings}


RIGHT = [
    *(replace(PLAIN, convention=name) for name in SIGNS),
    replace(PLAIN, noise=0.8, angle_noise=0.5),
    replace(PLAIN, uneven=0.6, rate=100),
    replace(PLAIN, uneven=-0.6, rate=100),
    replace(PLAIN, uneven=0.3, noise=0.8, angle_noise=0.5, rate=100),
    replace(PLAIN, pelvis=18),
    replace(PLAIN, pelvis=-18, convention="winter"),
    replace(PLAIN, cadence=30, rate=20),
    replace(PLAIN, cadence=90, rate=200),
]


@pytest.mark.parametrize("trial", RIGHT)
def test_a_right_trial_has_its_work_and_no_warning(trial: Trial, tmp_path: Path) -> None:
    measured = load_measurement(measurement(tmp_path, trial))
    assert measured.moments.misreadings == ()
    content = measured.summary()
    noisy = 0.02 if trial.noise else 3e-3  # the crank angle of a speed that comes and goes by 60 %: 1.5 deg
    assert content["work_per_turn_J"] == pytest.approx(work(), rel=noisy)


@pytest.mark.parametrize("name", SIGNS)
@pytest.mark.parametrize("other", SIGNS)
def test_a_wrong_convention_is_said(name: str, other: str, tmp_path: Path) -> None:
    """Whichever of the four signs differ: an angle's by its values, a moment's by who drives."""
    path = measurement(tmp_path, replace(PLAIN, convention=name), f'convention = "{other}"\n')
    assert bool(warnings(path)) == (name != other)


def test_what_is_not_declared_is_found_and_said(tmp_path: Path) -> None:
    path = measurement(tmp_path, replace(PLAIN, convention="winter"), 'extension = { hip = "positive" }\n')
    assert warnings(path) == {"knee_sense"}
    assert load_measurement(path).summary()["work_per_turn_J"] == pytest.approx(work(), rel=1e-3)
    path = measurement(tmp_path, replace(PLAIN, convention="rajagopal"), 'extension = { hip = "negative" }\n')
    assert warnings(path) == {"knee_sense", "negative_power", "exchanged"}
    path = measurement(
        tmp_path, replace(PLAIN, convention="rajagopal"), 'extension = { knee = "negative", hip = "negative" }\n'
    )
    assert warnings(path) == set()  # who says the moment's sign has looked; the angle's values tell its own
    path = measurement(tmp_path, PLAIN, "extension = {}\n")
    assert warnings(path) == {"hip_sign"}


def test_signs_one_by_one(tmp_path: Path) -> None:
    signs = 'extension = { knee = "positive", hip = "negative", knee_angle = "negative", hip_angle = "negative" }\n'
    columns = changed(PLAIN, knee=np.negative)
    path = measurement(tmp_path, columns, signs)
    assert warnings(path) == set()
    assert load_measurement(path).summary()["work_per_turn_J"] == pytest.approx(work(), rel=1e-3)


def spike(values: np.ndarray) -> np.ndarray:
    values = values.copy()
    values[100] += 60
    return values


def late(time: np.ndarray) -> np.ndarray:
    """A crank that stands for 1.5 s in the second turn."""
    angle = 1.5 * np.pi * time - 0.9
    return np.where(angle < 8, angle, np.maximum(8.0, angle - 1.5 * 1.5 * np.pi))


def back(time: np.ndarray) -> np.ndarray:
    """A crank that goes back by 60 deg, once."""
    return 1.5 * np.pi * time - 0.9 - 1.05 * 2 * np.exp(-(((time - 2.5) / 0.25) ** 2))


WRONG = {
    "knee moment's sign": (changed(PLAIN, knee_moment=np.negative), {"negative_power", "exchanged"}),
    "N m/kg": (changed(PLAIN, knee_moment=lambda m: m / 70, hip_moment=lambda m: m / 70), {"per_kg"}),
    "N mm": (changed(PLAIN, knee_moment=lambda m: 400 * m, hip_moment=lambda m: 400 * m), {"per_mm"}),
    "knee's zero": (changed(PLAIN, knee=lambda angle: angle + 8), {"knee_range"}),
    "knee's scale": (changed(PLAIN, knee=lambda angle: 1.2 * angle), {"knee_range"}),
    "hip's scale": (changed(PLAIN, hip=lambda angle: 1.4 * angle), {"hip_range"}),
    "pelvis": (replace(PLAIN, pelvis=30).columns(), {"hip_offset"}),
    "tricycle": (replace(PLAIN, ground=R1 * 0.96).columns(), {"knee_range"}),
    "a pause": (replace(PLAIN, crank_at=late, turns=6).columns(), {"uneven_turns"}),
    "a turn that goes back": (replace(PLAIN, crank_at=back).columns(), {"goes_back"}),
    "a spike": (changed(PLAIN, knee_moment=spike), {"spikes"}),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_in_one_place_is_said(name: str, tmp_path: Path) -> None:
    columns, expected = WRONG[name]
    assert warnings(measurement(tmp_path, columns, 'convention = "gait2392"\n')) >= expected


def test_a_spike_is_left_out(tmp_path: Path) -> None:
    columns = changed(PLAIN, knee_moment=spike)
    content = load_measurement(measurement(tmp_path, columns, 'convention = "gait2392"\n')).summary()
    assert content["work_per_turn_J"] == pytest.approx(work(), rel=2e-3)


@pytest.mark.parametrize(
    ("line", "names"),
    [
        ("cadence_rpm = 45", set()),
        ("cadence_rpm = 46.5", set()),
        ("cadence_rpm = 60", {"cadence"}),
        ("cadence_rpm = 22.5", {"cadence"}),
    ],
)
def test_the_times_tell_the_cadence(line: str, names: set[str], tmp_path: Path) -> None:
    on = MEASURED_ON.replace("R2", f"{line}\nR2")
    path = measurement(tmp_path, PLAIN, measured_on=on)
    assert warnings(path) == names
    warned = load_measurement(path).moments.misreadings
    assert all("45.0 rpm recorded" in misreading.text and line.split()[-1] in misreading.text for misreading in warned)
    if names:
        assert load_measurement(path).summary()["power_mean_W"] == pytest.approx(work() * 45 / 60, rel=2e-3)


def test_a_tricycle_that_is_not_declared_is_the_papers(tmp_path: Path) -> None:
    path = measurement(tmp_path, PLAIN, measured_on="")
    assert "knee_range" in warnings(path)
    text = " ".join(misreading.text for misreading in load_measurement(path).moments.misreadings)
    assert "74 to 131 deg recorded, 69 to 122 deg on the tricycle" in text


def test_milliseconds_are_refused_or_declared(tmp_path: Path) -> None:
    columns = changed(PLAIN, time=lambda time: 1e3 * time)
    with pytest.raises(InputError, match=r"m\.toml: a turn lasts 1333 s .*time_unit"):
        load_measurement(measurement(tmp_path, columns, 'convention = "gait2392"\n'))
    path = measurement(tmp_path, columns, 'convention = "gait2392"\ntime_unit = "ms"\n')
    assert warnings(path) == set()


def test_degrees_that_the_header_calls_radians(tmp_path: Path) -> None:
    path = measurement(tmp_path, PLAIN)
    kinematics = tmp_path / "ik.mot"
    kinematics.write_text(kinematics.read_text().replace("inDegrees=yes", "inDegrees=no"))
    assert warnings(path) == {"knee_unit", "hip_unit"}
    columns = changed(PLAIN, knee=np.radians, hip=np.radians)
    path = measurement(tmp_path, columns, 'convention = "gait2392"\n')
    assert warnings(path) == {"knee_unit", "hip_unit"}
    kinematics.write_text(kinematics.read_text().replace("inDegrees=yes", "inDegrees=no"))
    assert warnings(path) == set()
    assert load_measurement(path).summary()["work_per_turn_J"] == pytest.approx(work(), rel=1e-3)
