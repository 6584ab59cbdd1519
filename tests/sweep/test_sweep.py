"""Sweeps: every point once, results against the solvers, and a folder that is another's is left alone."""

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError
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
        design = replace(design, linkage=linkage).with_rider(thigh=row["thigh"])
        moments = fes_mj.load_moments(tmp_path / "mine.csv" if row["moments"] == "mine.csv" else row["moments"])
        static = fes_mj.quasi_static(design, moments, row["cadence_rpm"] * math.pi / 30)
        assert row["power_mean_W"] == pytest.approx(static.power_mean, rel=2e-4, abs=1e-3)
        assert row["knee_min_deg"] == pytest.approx(math.degrees(static.joint_angle.knee.min()), abs=2e-3)


def test_cadence_follows_the_gear_ratio_unless_it_varies(study: Path, tmp_path: Path) -> None:
    study.write_text(GRID.replace("cadence_rpm = [60, 90]", ""))
    sweep = Sweep(load_study(study), tmp_path / "out")
    sweep.run()
    for row in rows_of(sweep):
        design = replace(fes_mj.load_design("d1").linkage, gear_ratio=row["gear_ratio"])
        assert row["cadence_rpm"] == pytest.approx(design.cadence * 30 / math.pi)


@pytest.mark.long
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
    with pytest.raises(InputError, match=r"different: sample\)"):
        Sweep(load_study(study), folder).run()
    with pytest.raises(InputError, match=r"different: sample, legs|different: legs, sample"):
        Sweep(load_study(study, legs=2), folder).run()
    (tmp_path / "mine.csv").write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,21,-3\n200,-5,4\n")
    study.write_text(GRID)
    with pytest.raises(InputError, match=r"different: moments"):
        Sweep(load_study(study), folder).run()
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_damaged_record_of_the_study_is_one_message(study: Path, tmp_path: Path) -> None:
    (tmp_path / "study.json").write_text('{"chunk": ')
    with pytest.raises(InputError, match=r"study\.json: .*not valid JSON"):
        Sweep(load_study(study), tmp_path).run()


def test_a_folder_of_something_else_is_left_alone(study: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not empty"):
        Sweep(load_study(study), tmp_path).run()


def _another_study(study: Path) -> Sweep:
    study.write_text(GRID.replace("seed = 3", "seed = 4"))
    other = Sweep(load_study(study), study.parent / "other")
    other.run()
    return other


@pytest.mark.parametrize("damage", ["empty", "cut", "text", "copied", "foreign", "column", "not ours", "turned"])
def test_a_chunk_that_is_not_whole_and_its_own_is_done_again(done: Sweep, study: Path, damage: str) -> None:
    parquet, whole, path = pytest.importorskip("pyarrow.parquet"), done.read(), done.path(5)
    sound = path.read_bytes()
    table = parquet.read_table(path)
    content = {
        "empty": b"",
        "cut": sound[: len(sound) // 2],
        "text": b"point,power\n35,20\n",
        "copied": done.path(3).read_bytes(),
    }
    if damage in content:
        path.write_bytes(content[damage])
    elif damage == "foreign":
        path.write_bytes(_another_study(study).path(5).read_bytes())
    elif damage == "column":
        parquet.write_table(table.drop_columns(["power_sd_W"]), path)
    elif damage == "not ours":
        parquet.write_table(table.replace_schema_metadata(), path)
    else:  # with the right marks
        parquet.write_table(table.take([*reversed(range(7))]), path)
    assert done.finished() == [chunk for chunk in range(21) if chunk != 5]
    assert done.read().num_rows == 144 - 7
    assert done.summary()["points"] == 144 - 7
    done.run()
    assert done.read().equals(whole)


def test_no_flipped_bit_is_taken_for_a_result(done: Sweep) -> None:
    """Bits flipped, bytes cut out or put in at random: the same rows, or none."""
    random, sound, table = np.random.default_rng(0), done.path(0).read_bytes(), done.table(0)
    refused = 0
    for _ in range(400):
        content, at = bytearray(sound), int(random.integers(len(sound)))
        how = random.integers(3)
        if how == 0:
            content[at] ^= 1 << int(random.integers(8))
        elif how == 1:
            del content[at : at + int(random.integers(1, 60))]
        else:
            content[at:at] = random.bytes(int(random.integers(1, 60)))
        done.path(0).write_bytes(content)
        read = done.table(0)
        assert read is None or read.equals(table)
        refused += read is None
    assert refused > 300


def test_a_folder_in_the_place_of_a_chunk_is_named(done: Sweep) -> None:
    done.path(2).unlink()
    done.path(2).mkdir()
    with pytest.raises(InputError, match=r"chunk-0000002\.parquet: .* folder"):
        done.run()


def test_the_order_of_the_grid_is_part_of_the_study(done: Sweep, study: Path) -> None:
    """It numbers the points: chunks of two orders together would have some twice and others never."""
    lines = GRID.splitlines()
    cadence, thigh = (next(i for i, line in enumerate(lines) if line.startswith(key)) for key in ("cadence", "thigh"))
    lines[cadence], lines[thigh] = lines[thigh], lines[cadence]
    study.write_text("\n".join(lines))
    with pytest.raises(InputError, match=r"different: order of grid\)"):
        Sweep(load_study(study), done.folder).run()


@pytest.mark.parametrize("content", ["", "[]", "{", "\x00", '{"grid": 3}', '{"grid": {"design": null}}'])
def test_a_damaged_record_is_one_message_and_nothing_is_touched(done: Sweep, content: str) -> None:
    (done.folder / "study.json").write_text(content)
    before = {path.name: path.read_bytes() for path in done.folder.iterdir()}
    with pytest.raises(InputError, match=r"record of the study|results of another study"):
        done.run()
    assert {path.name: path.read_bytes() for path in done.folder.iterdir()} == before


def test_hidden_and_browser_files_leave_a_folder_empty(study: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    for name in (".DS_Store", "Thumbs.db", "desktop.ini", ".fes_mj-abcd.json"):
        (folder / name).write_text("")
    sweep = Sweep(load_study(study), folder)
    sweep.run()
    assert len(sweep.finished()) == 21
    assert (folder / ".DS_Store").exists()
    assert not [*folder.glob(".fes_mj-*")]  # what a kill left
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes.txt").write_text("")
    with pytest.raises(InputError, match="not empty"):
        Sweep(load_study(study), tmp_path / "full").claim()


def test_a_large_sample_can_be_resumed(tmp_path: Path) -> None:
    """Its record is not longer than what a record may be to be read again."""
    path = tmp_path / "study.toml"
    ranges = "R2 = [0.1, 0.2]\nthigh = [0.4, 0.6]\nshank = [0.4, 0.6]\nmass = [50, 90]\nseat_angle = [0, 60]"
    path.write_text(f'[study]\nchunk = 50000\n[grid]\ndesign = ["d1"]\n[sample]\nsize = 1000000\n{ranges}\n')
    sweep = Sweep(load_study(path), tmp_path / "out")
    sweep.claim()
    sweep.claim()
    assert (tmp_path / "out" / "study.json").stat().st_size < 10_000


def test_nothing_finished_is_an_empty_table(study: Path, tmp_path: Path) -> None:
    sweep = Sweep(load_study(study), tmp_path / "out")
    assert sweep.read().num_rows == 0
    counts = {"points": 0, "turning": 0, "computed": 0, "why": None}
    assert sweep.summary() == {"folder": str(tmp_path / "out"), **counts, "best": None, "best_at_end_of": [], "top": []}


def test_a_best_at_the_end_of_its_range_says_so(tmp_path: Path) -> None:
    (path := tmp_path / "study.toml").write_text('[grid]\ndesign = ["d1"]\ngear_ratio = [1.0, 1.5, 2.0]\n')
    sweep = Sweep(load_study(path), tmp_path / "out")
    sweep.run()
    assert sweep.summary()["best_at_end_of"] == ["gear_ratio"]  # power is proportional to it


def test_the_summary_has_the_ten_best_of_all_chunks(done: Sweep) -> None:
    rows = [row for row in rows_of(done) if row["power_mean_W"] is not None]
    assert len(rows) > 10
    assert done.summary()["top"] == sorted(rows, key=lambda row: -row["power_mean_W"])[:10]


def test_the_csv_has_every_row(done: Sweep, tmp_path: Path) -> None:
    done.write_csv(tmp_path / "rows.csv")
    with (tmp_path / "rows.csv").open(newline="") as file:
        written = [*csv.DictReader(file)]
    for row, cells in zip(rows_of(done), written, strict=True):
        for name, value in row.items():
            if value is None:
                assert cells[name] == ""
            elif isinstance(value, float):
                assert float(cells[name]) == value
            else:
                assert cells[name].lower() == str(value).lower()
