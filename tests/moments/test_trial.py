"""Trials with a recorded crank angle, over time or row by row: cut into turns, compared with the knee, refused."""

from pathlib import Path

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.common.writing import csv_text
from fes_mj.moments.measurement import Measurement, load_measurement
from tests.moments.made_up import MEASURED_ON, Trial, work

TRIAL = Trial(convention="winter", turns=4.3, rate=100)
NAMES = {
    "time": "time",
    "crank": "crank",
    "knee": "kangle",
    "hip": "hangle",
    "knee_moment": "knee",
    "hip_moment": "hip",
}


def recorded(folder: Path, keys: str = "", only: tuple[str, ...] = tuple(NAMES), **changes: object) -> Path:
    """The trial as one CSV with a crank angle in degrees, and its measurement file."""
    columns = TRIAL.columns()
    columns["crank"] = np.degrees(columns["crank"]) % 360
    columns |= {name: change(columns[name]) for name, change in changes.items()}
    (folder / "a.csv").write_text(csv_text({NAMES[name]: columns[name] for name in only}))
    path = folder / "m.toml"
    angles = "".join(f'{name}_angle = "{NAMES[name]}"\n' for name in ("knee", "hip") if name in only)
    path.write_text(
        f'[moments]\nfile = "a.csv"\ncrank = "crank"\nknee = "knee"\nhip = "hip"\nconvention = "winter"\n'
        f"{angles}{keys}{MEASURED_ON}"
    )
    return path


def names(measurement: Measurement) -> set[str]:
    return {misreading.name for misreading in measurement.moments.misreadings}


def test_a_recorded_crank_angle_agrees_with_the_knee(tmp_path: Path) -> None:
    measurement = load_measurement(recorded(tmp_path))
    assert names(measurement) == set()
    assert len(measurement.turns) == 4
    assert measurement.summary()["work_per_turn_J"] == pytest.approx(work(), rel=1e-5)
    assert measurement.summary()["cadence_rpm"] == pytest.approx(TRIAL.cadence)


@pytest.mark.parametrize("shift", [-120, -20, 15, 90, 180])
def test_a_wrong_zero_is_seen_by_the_knee(shift: float, tmp_path: Path) -> None:
    measurement = load_measurement(recorded(tmp_path, crank=lambda angle: (angle + shift) % 360))
    assert {"zero", "knee_curve"} <= names(measurement) or abs(shift) < 30
    assert "zero" in names(measurement)
    text = next(m.text for m in measurement.moments.misreadings if m.name == "zero")
    assert f"{shift:+.0f} deg after" in text or abs(shift) == 180
    corrected = recorded(tmp_path, f"zero = {-shift}\n", crank=lambda angle: (angle + shift) % 360)
    assert names(load_measurement(corrected)) == set()


def test_the_left_crank_is_half_a_turn_behind(tmp_path: Path) -> None:
    path = recorded(tmp_path, 'leg = "left"\n', crank=lambda right: (right + 180) % 360)
    assert names(load_measurement(path)) == set()
    path = recorded(tmp_path, 'leg = "left"\nzero = -30\n', crank=lambda right: (right + 210) % 360)
    assert names(load_measurement(path)) == set()


@pytest.mark.parametrize(("unit", "factor"), [("rad", np.pi / 180), ("turn", 1 / 360), ("percent", 1 / 3.6)])
@pytest.mark.parametrize("timed", [True, False])
def test_units_of_the_crank_angle(unit: str, factor: float, timed: bool, tmp_path: Path) -> None:
    """Rows without a time are as many turns as they go round."""
    only = tuple(name for name in NAMES if timed or name != "time")
    path = recorded(tmp_path, f'angle_unit = "{unit}"\n', only, crank=lambda angle: angle * factor)
    measurement = load_measurement(path)
    assert names(measurement) == set()
    assert (len(measurement.turns), measurement.moments.cadence_known) == (4, timed)
    assert measurement.summary()["work_per_turn_J"] == pytest.approx(work(), rel=1e-4)


PLAIN = Trial().columns()


def plain(folder: Path, *knees: float) -> Path:
    """The plain file, the whole turn once for each factor on the knee's moment."""
    degrees = np.arange(0, 360, 10.0)
    knee, hip = 12 * np.cos(np.radians(degrees) - 1), 4 * np.cos(np.radians(degrees) - 1.3)
    columns = [np.tile(degrees, len(knees)), np.concatenate([k * knee for k in knees]), np.tile(hip, len(knees))]
    path = folder / "plain.csv"
    path.write_text(csv_text(dict(zip(("crank_angle_deg", "knee_Nm", "hip_Nm"), columns, strict=True))))
    return path


def test_an_angle_that_stands_twice_is_two_turns(tmp_path: Path) -> None:
    measurement = load_measurement(plain(tmp_path, 1.05, 0.95))
    assert names(measurement) == set()
    assert len(measurement.turns) == 2
    once = load_measurement(plain(tmp_path, 1.0)).summary()
    assert measurement.summary()["power_mean_W"] == pytest.approx(once["power_mean_W"], rel=1e-6)
    assert once["power_sd_W"] is None
    assert measurement.power_sd > 0.05 * measurement.moments.power_mean.knee
    lines = plain(tmp_path, 1.05, 0.95).read_text().splitlines()
    (tmp_path / "plain.csv").write_text(
        "\n".join([lines[0], *sorted(lines[1:], key=lambda row: float(row.split(",")[0]))])
    )
    again = load_measurement(tmp_path / "plain.csv")
    assert len(again.turns) == 2
    assert again.summary()["power_mean_W"] == pytest.approx(once["power_mean_W"], rel=1e-6)


def test_two_riders_in_one_file(tmp_path: Path) -> None:
    assert "contradiction" in names(load_measurement(plain(tmp_path, 1, -1)))
    assert "contradiction" in names(load_measurement(plain(tmp_path, 3, 0.5)))


def test_a_turn_that_does_not_close(tmp_path: Path) -> None:
    """A moment that grows all along, as of a start, jumps back at the end."""
    lines = plain(tmp_path, 1).read_text().splitlines()
    rows = [[*map(float, line.split(","))] for line in lines[1:]]
    grown = [lines[0], *(f"{angle},{knee + angle / 20},{hip}" for angle, knee, hip in rows)]
    (tmp_path / "plain.csv").write_text("\n".join(grown) + "\n")
    assert names(load_measurement(tmp_path / "plain.csv")) == {"open_turn"}


def test_a_time_that_stands_twice(tmp_path: Path) -> None:
    """OpenSim prints a row twice, with the last digits changed; two rows that differ at one time are refused."""
    path = recorded(tmp_path)
    lines = (tmp_path / "a.csv").read_text().splitlines()
    doubled = [*lines[:40], lines[39], *lines[40:], lines[-1]]
    (tmp_path / "a.csv").write_text("\n".join(doubled) + "\n")
    assert load_measurement(path).summary()["work_per_turn_J"] == pytest.approx(work(), rel=1e-5)
    other = ",".join([*lines[39].split(",")[:4], "99", "0"])
    (tmp_path / "a.csv").write_text("\n".join([*lines[:40], other, *lines[40:]]) + "\n")
    with pytest.raises(InputError, match=r"a\.csv: line 41: time is .* it must grow"):
        load_measurement(path)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (np.radians, "radians"),
        (lambda angle: angle / 360, "whole turns"),
        (lambda angle: angle % 180, "two turns of the signal"),
        (lambda angle: np.convolve(angle, np.ones(9) / 9, "same"), "filtered after it was wrapped"),
        (lambda angle: (np.arange(len(angle)) % 133 == 0) * 1.0, "index pulse"),
        (lambda angle: angle / 3.6, "per cent of the turn"),
        (lambda angle: 360 - angle, "moments.turning must be the other"),
    ],
)
def test_why_there_is_no_whole_turn(change: object, words: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=words):
        load_measurement(recorded(tmp_path, crank=change))
