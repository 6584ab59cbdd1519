"""Studies and sweeps: every point once, results against the solvers, one message for bad input."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import fes_mj
from fes_mj.cli.app import run
from fes_mj.errors import InputError
from fes_mj.sweep.study import load_study
from fes_mj.sweep.sweep import Sweep

pytest.importorskip("pyarrow")

GRID = """
[study]
chunk = 7
[grid]
design = ["d1", "r2", "mine.toml"]
moments = ["p1p2", "mine.csv"]
cadence_rpm = [60, 90]
thigh = { from = 0.50, to = 0.54, steps = 3 }
[sample]
size = 4
seed = 3
R1x = [-0.80, -0.60]
gear_ratio = [1.0, 2.0]
"""


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A study with a design and moments of its own beside it."""
    source = Path(fes_mj.__file__).parent / "data"
    (tmp_path / "mine.toml").write_text((source / "designs/identified/d2.toml").read_text())
    (tmp_path / "mine.csv").write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n200,-5,4\n")
    path = tmp_path / "study.toml"
    path.write_text(GRID)
    return path


def rows_of(sweep: Sweep) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = sweep.read().to_pylist()
    return rows


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


def test_the_example_is_a_study() -> None:
    study = load_study(Path(__file__).parents[2] / "examples" / "study.toml")
    assert study.points == 2 * 2 * 2 * 5 * 1000
    assert study.chunks == 20


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


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("R1x = [-0.80", "R12 = [-0.80", "unknown key sample.R12; allowed here: size, seed, R1x"),
        ("[-0.80, -0.60]", "[-0.60, -0.80]", "sample.R1x is [-0.6, -0.8]; the bounds contradict"),
        ("steps = 3", "steps = 0", "grid.thigh.steps is 0; it must be a whole number from 1"),
        ("from = 0.50", "from = 52", "grid.thigh is 52; it must be from 0.001 to 2"),
        ('"d1", ', '"d7", ', "d7: no such design"),
        ("[60, 90]", "[]", "grid.cadence_rpm is []; it must be a list"),
        ("[60, 90]", "[60, 900]", "grid.cadence_rpm is 900; it must be from 1 to 200"),
        ("[study]", "[stduy]", "unknown key stduy"),
        ("chunk = 7", "chunk = 0.5", "study.chunk is 0.5"),
        ("chunk = 7", 'analysis = "kinetic"', "study.analysis is 'kinetic'; it must be one of static, dynamic"),
        ("thigh = {", "R1x = {", "R1x is both in grid and in sample"),
        ('design = ["d1", "r2", "mine.toml"]', "", "grid.design is missing"),
        ('"r2"', '"trt"', ""),
        ("size = 4", "size = 9e9", "sample.size is 9000000000.0; it must be a whole number"),
    ],
)
def test_a_bad_study_is_one_message_and_exit_code_2(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, said: str
) -> None:
    assert old in GRID
    text = GRID.replace(old, new)
    if not said:  # a variable that one of the designs does not have
        text, said = text.replace("gear_ratio", "R9").replace("[1.0, 2.0]", "[0.3, 0.4]"), "trt is a trt without it"
    study.write_text(text)
    assert run(["sweep", str(study), "-o", str(tmp_path / "out"), "--jobs", "1"]) == 2
    captured = capsys.readouterr()
    assert said in captured.err.replace("\n", " ")
    assert "Traceback" not in captured.err
    assert captured.out == ""
    assert not (tmp_path / "out").exists()


def test_the_command_reports_and_resumes(study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["sweep", str(study), "-o", str(tmp_path / "out"), "--jobs", "1", "--json"]
    assert run(command) == 0
    first = json.loads(capsys.readouterr().out)
    assert first["points"] == 144
    assert first["found_finished"] == 0
    powers = [row["power_mean_W"] for row in rows_of(Sweep(load_study(study), tmp_path / "out")) if row["turns"]]
    assert first["best"]["power_mean_W"] == max(powers)
    assert run(command) == 0
    assert json.loads(capsys.readouterr().out)["found_finished"] == 144


def test_a_study_without_turning_points_has_no_best(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "study.toml"
    path.write_text('[grid]\ndesign = ["d1"]\nmoments = ["p1p2"]\nR2 = [0.4, 0.5]\n')
    assert run(["sweep", str(path), "-o", str(tmp_path / "out"), "--jobs", "1", "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["turning"] == 0
    assert summary["best"] is None


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense"])
def test_no_scheduler_loses_nothing(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, address: str
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("fes_mj.parallel.PATIENCE", "1s")
    folder = tmp_path / "out"
    sweep = Sweep(load_study(study), folder)
    sweep.run()
    sweep.path(1).unlink()
    before = sorted(path.name for path in folder.iterdir())
    assert run(["sweep", str(study), "-o", str(folder), "--cluster", address]) == 2
    assert f"--cluster {address}: no Dask scheduler" in capsys.readouterr().err.replace("\n", " ")
    assert sorted(path.name for path in folder.iterdir()) == before
