"""`fes_mj sweep`: its summary, and what it leaves behind when it cannot run."""

import json
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from fes_mj.cli.app import run
from fes_mj.sweep.study import load_study
from fes_mj.sweep.sweep import Sweep
from tests.conftest import rows_of

pytest.importorskip("pyarrow")


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


def test_a_study_that_gives_nothing_is_no_success(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "study.toml"
    path.write_text('[grid]\ndesign = ["d1"]\nmoments = ["p1p2"]\nR2 = [0.4, 0.5]\n')
    assert run(["sweep", str(path), "-o", str(tmp_path / "out"), "--jobs", "1", "--json"]) == 2
    captured = capsys.readouterr()
    assert re.fullmatch(rf"fes_mj: {re.escape(str(path))}: .* 2 .*: rocker and coupler .*\n", captured.err)
    summary = json.loads(captured.out)
    assert (summary["turning"], summary["computed"]) == (0, 0)
    assert summary["best"] is None


@pytest.mark.parametrize(
    "address",
    [
        "tcp://127.0.0.1:9",
        "tcp://no.such.host.invalid:8786",
        "nonsense",
        "",
        "tcp://",
        "tcp://:8786",
        "tcp://127.0.0.1",
        "tcp://127.0.0.1:99999",
        "tcp://127.0.0.1:port",
        "tcp://[::1",
        "tcp://host:1/path",
        "http://x",
        "tls://127.0.0.1:9",
        "scheduler.json",
        ".",
        "\u4e2d\U0001f4a5",
        f"tcp://{'x' * 300}:80",
    ],
)
@pytest.mark.process
def test_no_scheduler_loses_nothing(
    done: Sweep, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, address: str
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("fes_mj.common.parallel.SCHEDULER_PATIENCE", "1s")
    done.path(1).unlink()
    before = sorted(path.name for path in done.folder.iterdir())
    study = done.folder.with_name("study.toml")
    assert run(["sweep", str(study), "-o", str(done.folder), f"--cluster={address}"]) == 2
    said = capsys.readouterr().err.replace("\n", " ")
    assert re.search(r"no Dask scheduler (has|answers)", said, re.IGNORECASE)
    assert address in said
    assert "--cluster" in said or f"cluster {address}: no Dask" in said
    assert sorted(path.name for path in done.folder.iterdir()) == before


@pytest.mark.process
def test_no_scheduler_leaves_no_folder(study: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("fes_mj.common.parallel.SCHEDULER_PATIENCE", "1s")
    out = study.with_name("new")
    assert run(["sweep", str(study), "-o", str(out), "--cluster", "tcp://127.0.0.1:9"]) == 2
    assert not out.exists()


def test_a_cadence_for_all_points(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "study.toml"
    path.write_text('[grid]\ndesign = ["d1", "r2"]\n')
    command = ["sweep", str(path), "-o", str(tmp_path / "out"), "--jobs", "1", "--cadence", "50", "--json"]
    assert run(command) == 0
    best = json.loads(capsys.readouterr().out)["best"]
    assert run(["static", best["design"], "--cadence", "50", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["power_mean_W"] == pytest.approx(best["power_mean_W"], rel=1e-4)
    path.write_text('[grid]\ndesign = ["d1"]\ncadence_rpm = [60]\n')
    assert run(command) == 2
    assert "cadence_rpm is given here; leave out the one beside the study" in capsys.readouterr().err


def test_the_terminal_shows_the_ten_best(study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["sweep", str(study), "-o", str(tmp_path / "out"), "--jobs", "1"]) == 0
    lines = capsys.readouterr().out.partition("Points with the most mean crank power")[2].splitlines()
    heading = next(line for line in lines if "point" in line)
    for part in ("design", "moments", "cadence, rpm", "thigh, m", "R1x, m", "gear_ratio", "power, W", "+-, W"):
        assert part in heading
    shown = [line.split() for line in lines if line.strip()[:1].isdigit()]
    top = Sweep(load_study(study), tmp_path / "out").summary()["top"]
    assert [int(cells[0]) for cells in shown] == [row["point"] for row in top]
    assert [float(cells[7]) for cells in shown] == pytest.approx([row["power_mean_W"] for row in top], abs=0.006)


def test_rows_and_plot_are_written_when_asked(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    study, out = tmp_path / "study.toml", tmp_path / "out"
    study.write_text('[grid]\ndesign = ["d1"]\nR2 = { from = 0.14, to = 0.18, steps = 9 }\n')
    rows, plot = out / "rows.csv", tmp_path / "power.png"
    command = ["sweep", str(study), "-o", str(out), "--jobs", "1", "-q", "--csv", str(rows), "--plot", str(plot)]
    assert run(command) == 0
    assert len(rows.read_text().splitlines()) == 10
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert run(command) == 0  # over its own


def test_the_rows_never_replace_the_moments(study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    moments = tmp_path / "mine.csv"
    before = moments.read_text()
    assert run(["sweep", str(study), "-o", str(tmp_path / "out"), "--csv", str(tmp_path / "." / "mine.csv")]) == 2
    assert "which this command reads" in capsys.readouterr().err.replace("\n", " ")
    assert moments.read_text() == before


@pytest.mark.parametrize(
    ("grid", "option", "said"),
    [
        ("R2 = [0.15]", "--plot=a.png", "none varies"),
        ("R2 = [0.15, 0.16]\nR6 = [0.1, 0.11]\nR8 = [0.1, 0.11]", "--plot=a.png", "R2, R6, R8 varies"),
        ('moments = ["p1p2", "p1p3"]\nR2 = [0.15, 0.16]\nR6 = [0.1, 0.11]', "--plot=a.png", "moments, R2, R6 varies"),
        (
            "R2 = { from = 0.1, to = 0.2, steps = 1000 }\nR6 = { from = 0.1, to = 0.2, steps = 1001 }",
            "--plot=a.png",
            "1,001,000",
        ),
        ("R2 = [0.15, 0.16]", "--plot=a.pdf", "must end in .png"),
        ("R2 = [0.15, 0.16]", "--csv=a.txt", "must end in .csv"),
        ("R2 = [0.15, 0.16]", "--csv=no/a.csv", "does not exist"),
    ],
)
def test_what_cannot_be_written_is_said_before_anything_runs(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    grid: str,
    option: str,
    said: str,
) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(f'[grid]\ndesign = ["d1"]\n{grid}\n')
    assert run(["sweep", "study.toml", "-o", "out", option]) == 2
    assert said in capsys.readouterr().err.replace("\n", " ")
    assert not Path("out").exists()


MANY_CHUNKS = """
[study]
chunk = 100
[grid]
design = ["d1", "r2"]
[sample]
size = 3000
seed = 1
thigh = [0.50, 0.54]
"""
KILLS = 6


@pytest.mark.process
def test_a_sweep_killed_at_random_has_the_rows_of_an_undisturbed_one(tmp_path: Path) -> None:
    """Stop a sweep at random times in random ways, then let it end: the rows of an undisturbed one, bit for bit."""
    random, study = np.random.default_rng(2), tmp_path / "study.toml"
    study.write_text(MANY_CHUNKS)
    sweep = Sweep(load_study(study), tmp_path / "out")
    command = [sys.executable, "-m", "fes_mj", "sweep", str(study), "-o", str(sweep.folder), "--jobs", "1", "-q"]
    for _ in range(KILLS):
        before = len([*sweep.folder.glob("chunk-*")])
        with subprocess.Popen(command, stderr=subprocess.DEVNULL) as process:
            while process.poll() is None and len([*sweep.folder.glob("chunk-*")]) == before < sweep.study.chunks:
                time.sleep(0.002)
            time.sleep(random.uniform(0, 0.05))
            process.send_signal(random.choice([signal.SIGINT, signal.SIGTERM, signal.SIGKILL]))
        for path in random.choice([*sweep.folder.glob("chunk-*")], 2):  # what is there counts, and only once
            path.unlink(missing_ok=True)
    assert len(sweep.finished()) < sweep.study.chunks
    subprocess.run(command, check=True)
    assert not [*sweep.folder.glob(".*")]
    undisturbed = Sweep(sweep.study, tmp_path / "undisturbed")
    undisturbed.run()
    assert sweep.read().equals(undisturbed.read())
