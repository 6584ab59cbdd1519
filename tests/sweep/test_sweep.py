"""Sweeps: every point once, results against the solvers, and a folder that is another's is left alone."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

import fes_mj
from fes_mj.errors import InputError
from fes_mj.sweep.study import load_study
from fes_mj.sweep.sweep import Sweep
from tests.conftest import GRID, rows_of

pytest.importorskip("pyarrow")


def test_every_point_once_and_as_the_solver_says(study: Path, tmp_path: Path) -> None:
    loaded = load_study(study)
    assert loaded.points == 3 * 2 * 2 * 3 * 4
    sweep = Sweep(loaded, tmp_path / "out")
    sweep.run()
    rows = rows_of(sweep)
    assert [row["point"] for row in rows] == list(range(144))
    keys = ("design", "moments", "cadence_rpm", "thigh", "R1x", "gear_ratio")
    assert len({tuple(row[key] for key in keys) for row in rows}) == 144
    assert {row["design"] for row in rows} == {"d1", "r2", "mine.toml"}
    turning = [row for row in rows if row["turns"]]
    assert 20 < len(turning) < 144
    for row in turning[::9]:
        design = fes_mj.load_design("d2") if row["design"] == "mine.toml" else fes_mj.load_design(row["design"])
        moved = row["R1x"] + 1j * design.linkage.ground.imag
        linkage = replace(design.linkage, ground=moved, gear_ratio=row["gear_ratio"])
        design = replace(design, linkage=linkage, rider=replace(design.rider, thigh=row["thigh"]))
        moments = fes_mj.load_moments(tmp_path / "mine.csv" if row["moments"] == "mine.csv" else row["moments"])
        static = fes_mj.quasi_static(design, moments, row["cadence_rpm"] * math.pi / 30)
        assert row["power_mean_W"] == pytest.approx(static.power_mean, rel=2e-4, abs=1e-3)
        assert row["knee_min_deg"] == pytest.approx(math.degrees(static.joint_angle.knee.min()), abs=2e-3)
    for row in rows:
        if not row["turns"]:
            assert row["power_mean_W"] is None


def test_cadence_follows_the_gear_ratio_unless_it_varies(study: Path, tmp_path: Path) -> None:
    study.write_text(GRID.replace("cadence_rpm = [60, 90]", ""))
    sweep = Sweep(load_study(study), tmp_path / "out")
    sweep.run()
    for row in rows_of(sweep):
        design = replace(fes_mj.load_design("d1").linkage, gear_ratio=row["gear_ratio"])
        assert row["cadence_rpm"] == pytest.approx(design.cadence * 30 / math.pi)


def test_a_dynamic_study_agrees_with_statics(tmp_path: Path) -> None:
    pytest.importorskip("numba")
    path = tmp_path / "study.toml"
    path.write_text(
        '[study]\nanalysis = "dynamic"\n[grid]\ndesign = ["r1", "trt"]\nmoments = ["p1p2"]\n'
        "cadence_rpm = [50, 90]\nmass = [60, 90]\nthigh = [0.52, 0.30]\n"
    )
    sweep = Sweep(load_study(path), tmp_path / "out")
    sweep.run()
    rows = rows_of(sweep)
    assert [row["turns"] for row in rows].count(True) == 8
    for row in rows:
        if row["turns"]:
            assert row["simulated_power_mean_W"] == pytest.approx(row["power_mean_W"], rel=5e-4)
            assert row["loop_gap_max_m"] < 1e-5
        else:
            assert row["simulated_power_mean_W"] is None


def test_only_what_is_missing_is_done(study: Path, tmp_path: Path) -> None:
    sweep = Sweep(load_study(study), tmp_path / "out")
    sweep.run()
    whole = sweep.read()
    kept = {path.name: path.stat().st_mtime_ns for path in sweep.folder.glob("*.parquet")}
    sweep.path(3).unlink()
    done: list[int] = []
    sweep.run(progress=done.append)
    assert done == [7]
    assert sweep.read().equals(whole)
    again = {path.name: path.stat().st_mtime_ns for path in sweep.folder.glob("*.parquet")}
    assert [name for name in kept if kept[name] != again[name]] == [sweep.path(3).name]


def test_a_folder_of_another_study_is_left_alone(study: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    Sweep(load_study(study), folder).run()
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    study.write_text(GRID.replace("seed = 3", "seed = 4"))
    with pytest.raises(InputError, match=r"results of another study \(different: sample\)"):
        Sweep(load_study(study), folder).run()
    (tmp_path / "mine.csv").write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,21,-3\n200,-5,4\n")
    study.write_text(GRID)
    with pytest.raises(InputError, match=r"different: moments"):
        Sweep(load_study(study), folder).run()
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_damaged_record_of_the_study_is_one_message(study: Path, tmp_path: Path) -> None:
    (tmp_path / "study.json").write_text('{"chunk": ')
    with pytest.raises(InputError, match=r"study\.json: the record of the study is not valid JSON"):
        Sweep(load_study(study), tmp_path).run()


def test_a_folder_of_something_else_is_left_alone(study: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not empty and holds no study"):
        Sweep(load_study(study), tmp_path).run()
