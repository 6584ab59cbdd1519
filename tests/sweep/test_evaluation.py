"""What a row says, against what the quasi-static solver and the simulation say of the same design."""

from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError, UnstableError
from fes_mj.common.units import RPM
from fes_mj.linkage.variables import replaced
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.rules import BEST, BY_ANGLE
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import LegTurns, QuasiStatic
from fes_mj.sweep.evaluation import column_types, evaluate
from fes_mj.sweep.study import MuscleOptions, load_study
from tests.conftest import write_study

WIDE = """
[study]
characteristics = true
[grid]
design = ["trt", "r2", "d1"]
moments = ["p1p2", "mine.csv"]
[sample]
size = 20
seed = 2
thigh = [0.40, 0.60]
seat_angle = [0, 60]
R1x = [-0.80, -0.55]
"""


Wide: TypeAlias = list[tuple[dict[str, Any], QuasiStatic | InputError]]


def evaluated(study: Path, text: str) -> list[dict[str, Any]]:
    """The rows of a study in one chunk."""
    study.write_text(text)
    columns = evaluate(load_study(study), 0)
    assert columns.keys() == column_types(load_study(study)).keys()
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def alone(row: dict[str, Any], study: Path) -> QuasiStatic | InputError:
    """The quasi-static result of a row's design, or why there is none."""
    names = [name for name in ("thigh", "seat_angle", "R1x", "gear_ratio") if name in row]
    design = replaced(fes_mj.load_design(row["design"]), {name: float(row[name]) for name in names})
    source = study.parent / row["moments"] if row["moments"].endswith(".csv") else row["moments"]
    try:
        return fes_mj.quasi_static(design, fes_mj.load_moments(source), row["cadence_rpm"] * RPM)
    except InputError as error:
        return error


@pytest.fixture(scope="module")
def wide(tmp_path_factory: pytest.TempPathFactory) -> Wide:
    """The rows of a study, and of each the result of its design alone."""
    study = write_study(tmp_path_factory.mktemp("wide"))
    return [(row, alone(row, study)) for row in evaluated(study, WIDE)]


def test_rows_say_what_the_solver_says(wide: Wide) -> None:
    said = set()
    for row, single in wide:
        assert row["turns"] == (not isinstance(single, fes_mj.AssemblyError))
        said.add(row["why"])
        if isinstance(single, InputError):
            assert row["why"].partition(" never")[0].partition(" through")[0] in str(single)
            assert np.isnan([row["power_mean_W"], row["power_sd_W"], row["work_per_turn_J"]]).all()
            assert np.isnan(row["extrapolated_share"]) == (not row["turns"])
        else:
            assert row["why"] is None
            assert row["power_mean_W"] == pytest.approx(single.power_mean, rel=2e-4, abs=2e-3)
            assert row["extrapolated_share"] == pytest.approx(single.extrapolation.share, abs=4e-3)
            if single.power_sd is None:
                assert np.isnan(row["power_sd_W"])
            else:
                assert row["power_sd_W"] == pytest.approx(single.power_sd, rel=2e-3)
    assert said >= {None, "thigh and shank cannot close", "the hip never enters the range of the moments"}


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ("R2 = [0.4]", "rocker and coupler cannot close"),
        ("R2 = [0.16930]", "rocker and coupler within 0.1 mm of a dead centre"),
        ("thigh = [0.2]", "thigh and shank cannot close"),
        ("seat_angle = [0]", "the hip never enters the range of the moments"),
        ("thigh = [0.9]\nshank = [0.9]", "the knee never enters the range of the moments"),
        ("gear_ratio = [15]", "its cadence is not within 1 to 200 rpm"),
    ],
)
def test_every_reason_by_name(study: Path, change: str, why: str) -> None:
    (row,) = evaluated(study, f'[grid]\ndesign = ["d1"]\n{change}\n')
    assert row["why"] == why
    assert np.isnan(row["power_mean_W"])


def test_the_moments_are_those_of_simulate_unless_named(study: Path) -> None:
    (unnamed,) = evaluated(study, '[grid]\ndesign = ["d1"]\n')
    (named,) = evaluated(study, '[grid]\ndesign = ["d1"]\nmoments = ["p1p2"]\n')
    assert unnamed == named


def test_one_run_that_fails_costs_one_row(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Refused, broken down, and simulated, in one chunk."""
    pytest.importorskip("numba")
    from fes_mj.simulation import bench

    original = bench.simulate

    def simulate(design: fes_mj.Design, *arguments: Any, **options: Any) -> bench.Simulation:
        if design.rider.mass == 60:
            raise InputError(f"{design.name}: at 60 rpm the run needs endlessly many time steps")
        if design.rider.mass == 70:
            raise UnstableError("the simulation breaks down at step 9")
        return original(design, *arguments, **options)

    monkeypatch.setattr(bench, "simulate", simulate)
    rows = evaluated(study, '[study]\nanalysis = "dynamic"\n[grid]\ndesign = ["d1"]\nmass = [60, 70, 80]\n')
    whys = ["at 60 rpm the run needs endlessly many time steps", "the simulation breaks down at step 9", None]
    assert [row["why"] for row in rows] == whys
    assert [bool(np.isnan(row["simulated_power_mean_W"])) for row in rows] == [True, True, False]
    assert not np.isnan([row["power_mean_W"] for row in rows]).any()


def test_a_run_of_too_many_steps_costs_one_row(study: Path) -> None:
    pytest.importorskip("numba")
    text = '[study]\nanalysis = "dynamic"\ntimestep = 2e-5\n[grid]\ndesign = ["d1"]\ncadence_rpm = [1, 200]\n'
    refused, good = evaluated(study, text)
    assert "at 1 rpm the run needs 1 x 3,000,000 time steps, more than" in refused["why"]
    assert refused["power_mean_W"] == pytest.approx(good["power_mean_W"] / 200)
    assert np.isnan(refused["simulated_power_mean_W"])
    assert good["why"] is None
    assert good["simulated_power_mean_W"] == pytest.approx(good["power_mean_W"], rel=1e-3)


def test_characteristics_are_those_of_single_designs(wide: Wide) -> None:
    """Over 720 angles instead of 3600: shares are right to an angle at each end of a zone."""
    compared = 0
    for row, single in wide:
        if isinstance(single, InputError):
            assert np.isnan([row["inactive_zone_share"], row["length_m"], row["energy_fluctuation"]]).all()
            continue
        summary, compared = single.summary(), compared + 1
        assert row["inactive_zone_share"] == pytest.approx(summary["inactive_zone_share"], abs=6 / 720)
        for name in ("power_peak_to_peak_W", "transmission_angle_min_deg", "length_m", "height_m"):
            assert row[name] == pytest.approx(summary[name], rel=0.02, abs=0.02)
        for name in ("power_peak_to_mean", "energy_fluctuation"):
            assert row[name] == pytest.approx(summary[name], rel=0.02, abs=0.02, nan_ok=True)
    assert compared > 20


def test_characteristics_are_true_or_false(study: Path) -> None:
    study.write_text('[study]\ncharacteristics = "yes"\n[grid]\ndesign = ["d1"]\n')
    with pytest.raises(InputError, match=r"study\.characteristics is 'yes'"):
        load_study(study)


def test_rows_of_muscles_are_those_of_the_designs_alone(tmp_path: Path) -> None:
    """A knee that the lengths of muscles do not know has the reason of `static`; timing by angle has no windows."""
    path, riders = tmp_path / "study.toml", load_riders("p1p3").taken(slice(0, 3))
    riders.save(tmp_path / "mine.npz")
    path.write_text(
        '[study]\ncharacteristics = true\n[grid]\ndesign = ["trt"]\nthigh = [0.42, 0.52]\nR2 = [0.14, 0.3]\n'
    )
    for rule in (BEST, BY_ANGLE):
        study = load_study(path, 50.0, MuscleOptions(rule, 0.25, tmp_path / "mine.npz"))
        columns = evaluate(study, 0)
        assert columns.keys() == column_types(study).keys()
        for row in range(study.points):
            varied = {name: float(columns[name][row]) for name in ("thigh", "R2")}
            design = replaced(fes_mj.load_design("trt"), varied)
            why: str | None = None
            try:
                summary = MuscleStatic.solve(design, riders, 50 * RPM, rule, 0.25).summary()
            except InputError as error:
                why, summary = str(error).removeprefix("trt: "), {}
            assert columns["why"][row] == why
            for name in ("power_mean_W", "power_sd_W", "power_peak_to_peak_W", "extrapolated_share"):
                assert columns[name][row] == pytest.approx(summary.get(name, np.nan), nan_ok=True), name
        assert sum(why is None for why in columns["why"]) == 2


def test_muscles_are_simulated_of_the_most_probable_rider(tmp_path: Path) -> None:
    """Whose power by statics is beside it; where there is none, nothing is simulated."""
    path, riders = tmp_path / "study.toml", load_riders("p1p2").taken(slice(0, 3))
    riders.save(tmp_path / "mine.npz")
    path.write_text('[study]\nanalysis = "dynamic"\n[grid]\ndesign = ["trt"]\nR2 = [0.16, 0.3]\n')
    study = load_study(path, 50.0, MuscleOptions(riders=tmp_path / "mine.npz"), legs=2)
    columns = evaluate(study, 0)
    assert columns.keys() == column_types(study).keys()
    design = replaced(fes_mj.load_design("trt"), {"R2": 0.16})
    run = fes_mj.simulate(design, Muscles(riders), cadence=50 * RPM)
    assert columns["simulated_power_mean_W"][0] == pytest.approx(run.power_mean, rel=1e-3)
    assert columns["power_mode_W"][0] == pytest.approx(run.power_mean, rel=1e-3)
    assert columns["why"][0] is None
    assert columns["why"][1]
    assert np.isnan(columns["simulated_power_mean_W"][1])


@pytest.mark.parametrize("drive", ["moments", "muscles"])
def test_two_legs_are_as_even_as_static_says(tmp_path: Path, drive: str) -> None:
    """And each has the power of one alone."""
    path, cadence, riders = tmp_path / "study.toml", 50 * RPM, load_riders("p1p2").taken([0, 1])
    riders.save(tmp_path / "mine.npz")
    muscles = MuscleOptions(riders=tmp_path / "mine.npz") if drive == "muscles" else None
    path.write_text('[study]\ncharacteristics = true\n[grid]\ndesign = ["d1"]\n')
    two, one = (evaluate(load_study(path, 50.0, muscles, legs), 0) for legs in (2, 1))
    design, moments = fes_mj.load_design("d1"), fes_mj.load_moments("p1p2")
    by_muscles = MuscleStatic.solve(design, riders, cadence, BEST, legs=2) if muscles else None
    summary = (by_muscles or LegTurns.solve(design, moments, cadence, 2)).summary()
    assert two["power_mean_W"] == one["power_mean_W"] == pytest.approx(summary["power_mean_W"], rel=1e-4)
    for name in ("power_peak_to_peak_W", "power_peak_to_mean", "energy_fluctuation"):
        assert two[name][0] == pytest.approx(summary[name], rel=0.02), name
    assert two["energy_fluctuation"][0] < one["energy_fluctuation"][0]


def test_a_duty_that_is_none_is_refused(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text('[grid]\ndesign = ["trt"]\n')
    with pytest.raises(InputError, match="duty is 0"):
        load_study(tmp_path / "study.toml", muscles=MuscleOptions(duty=0))


def test_moments_of_which_no_muscles_are_known_are_refused(tmp_path: Path) -> None:
    path = write_study(tmp_path)
    path.write_text('[grid]\ndesign = ["trt"]\nmoments = ["p1p2", "mine.csv"]\n')
    with pytest.raises(InputError, match=r"study\.toml: grid\.moments has mine\.csv"):
        load_study(path, muscles=MuscleOptions())
    with pytest.raises(InputError, match=r"study\.toml: grid\.moments has 2 names"):
        load_study(path, muscles=MuscleOptions(riders=tmp_path / "mine.npz"))
