"""`fes_mj sweep`: its summary, and what it leaves behind when it cannot run."""

import json
from pathlib import Path

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
