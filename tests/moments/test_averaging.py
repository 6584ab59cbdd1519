"""The error bar of several trials and riders, by their own powers; what tape measure and cadence add; spikes."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from fes_mj.common.writing import csv_text
from fes_mj.linkage.variables import component, replaced
from fes_mj.moments.averaging import CADENCE_ERROR, DECLARED_ERRORS, spikes
from fes_mj.moments.measurement import Measurement, load_measurement
from tests.moments.made_up import MEASURED_ON, moments

DEGREES = np.arange(0, 360, 4.0)


def student(values: list[float]) -> float:
    """One standard error of a mean, widened as few values need it."""
    return float(stats.t.ppf(stats.norm.cdf(1), len(values) - 1) * stats.sem(values))


def written(folder: Path, turns: list[tuple[str, str, float]]) -> Path:
    """A CSV with a rider, a trial and the size of the moments for each turn."""
    knee, hip = moments(np.radians(DEGREES))
    rows = ["who,run,crank_angle_deg,knee_Nm,hip_Nm"]
    for rider, trial, size in turns:
        rows += [f"{rider},{trial},{d},{size * k},{size * h}" for d, k, h in zip(DEGREES, knee, hip, strict=True)]
    (folder / "a.csv").write_text("\n".join(rows) + "\n")
    path = folder / "m.toml"
    path.write_text(f'[moments]\nfile = "a.csv"\nrider = "who"\ntrial = "run"\n{MEASURED_ON}')
    return path


def scatter(measurement: Measurement) -> float:
    assert measurement.power_sd is not None
    assert measurement.declared_sd is not None
    return float(np.sqrt(measurement.power_sd**2 - measurement.declared_sd**2))


def test_trials_that_differ_more_than_their_turns(tmp_path: Path) -> None:
    """Three trials of 20.72, 20.04 and 18.81 W, each of turns that hardly differ."""
    sizes = {"one": 1.036, "two": 1.002, "three": 0.9405}
    turns = [("A", trial, size * more) for trial, size in sizes.items() for more in (0.995, 1.0, 1.005)]
    measurement = load_measurement(written(tmp_path, turns))
    content = measurement.summary()
    assert (content["riders"], content["trials"], content["turns"]) == (1, 3, 9)
    unit = content["power_mean_W"] / np.mean([*sizes.values()])
    assert scatter(measurement) == pytest.approx(unit * student([*sizes.values()]), rel=1e-6)


def test_riders_count_the_same_however_many_trials_they_have(tmp_path: Path) -> None:
    turns = [("A", "1", 1.0), ("A", "1", 1.02), ("A", "2", 1.1), ("B", "1", 0.7), ("C", "1", 1.3)]
    measurement = load_measurement(written(tmp_path, turns))
    riders = [(1.01 + 1.1) / 2, 0.7, 1.3]
    content = measurement.summary()
    assert content["riders"] == 3
    unit = load_measurement(written(tmp_path, [("A", "1", 1.0), ("A", "1", 1.0)])).summary()["power_mean_W"]
    assert content["power_mean_W"] == pytest.approx(unit * np.mean(riders), rel=1e-9)
    assert scatter(measurement) == pytest.approx(unit * student(riders), rel=1e-6)


def test_turns_that_differ_more_than_their_trials(tmp_path: Path) -> None:
    turns = [("A", trial, size) for trial in ("1", "2") for size in (0.8, 1.0, 1.2)]
    measurement = load_measurement(written(tmp_path, turns))
    unit = measurement.summary()["power_mean_W"]
    assert scatter(measurement) == pytest.approx(unit * student([0.8, 1.0, 1.2] * 2), rel=1e-6)


def test_a_list_of_files_are_trials_and_may_name_their_riders(tmp_path: Path) -> None:
    knee, hip = moments(np.radians(DEGREES))
    for name, size in (("a", 0.9), ("b", 1.0), ("c", 1.1)):
        columns = {"crank_angle_deg": DEGREES, "knee_Nm": size * knee, "hip_Nm": size * hip}
        (tmp_path / f"{name}.csv").write_text(csv_text(columns))
    path = tmp_path / "m.toml"
    for line, riders in (("", 1), ('rider = ["A", "A", "B"]\n', 2)):
        path.write_text(f'[moments]\nfile = ["a.csv", "b.csv", "c.csv"]\n{line}{MEASURED_ON}')
        content = load_measurement(path).summary()
        assert (content["trials"], content["riders"]) == (3, riders)


def test_tape_measure_and_cadence_are_in_the_error_bar(tmp_path: Path) -> None:
    """Each number changed by its error in the file's own tricycle: what the power changes by, in squares."""
    measurement = load_measurement(written(tmp_path, [("A", "1", 1.0), ("A", "1", 1.0)]))
    on, own = measurement.moments.measured_on, measurement.moments
    mean = sum(own.power_mean)
    parts = [CADENCE_ERROR * mean]
    for name, error in DECLARED_ERRORS.items():
        design = replaced(on.design, {name: component(on.design, name) + error})
        parts.append(sum(replace(own, measured_on=replace(on, design=design)).power_mean) - mean)
    assert measurement.declared_sd == pytest.approx(np.linalg.norm(parts), rel=1e-6)
    assert measurement.power_sd == pytest.approx(measurement.declared_sd, rel=1e-6)


@pytest.mark.parametrize("count", [36, 90, 500])
def test_spikes_stand_alone(count: int) -> None:
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    knee, hip = moments(angle)
    step = np.where(angle < 2, 20.0, 0.0)  # stimulation switched on and off is no spike
    noisy = knee + np.random.default_rng(1).standard_normal(count)
    assert not any(spikes(values).any() for values in (knee, hip, step, noisy, 0 * knee))
    knee[[5, 20]] += (40, -40)
    assert np.flatnonzero(spikes(knee)).tolist() == [5, 20]
