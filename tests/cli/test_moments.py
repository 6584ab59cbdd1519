"""`fes_mj moments`: what it prints, draws and writes, and what it refuses."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from fes_mj.cli.app import run
from fes_mj.common.writing import csv_text
from fes_mj.moments.joint_moments import COLUMNS
from tests.cli.conftest import answer, names, result

TRIAL = Path(__file__).parents[2] / "examples" / "trial" / "trial.toml"


def test_json_and_table_say_the_same(capsys: pytest.CaptureFixture[str]) -> None:
    code, content = answer(capsys, "moments", str(TRIAL))
    assert code == 0
    assert content["turns"] == 4
    assert content["cadence_rpm"] == pytest.approx(47)
    assert content["warnings"] == []
    assert content["knee_Nm"][0] < 0 < content["knee_Nm"][1]
    assert content["work_per_turn_J"] == pytest.approx(content["power_mean_W"] * 60 / 47)
    code, out, _ = result(capsys, "moments", str(TRIAL))
    assert f"{content['power_mean_W']:.2f} +- {content['power_sd_W']:.2f}" in out
    assert "47.00 rpm" in out


def test_what_is_plausible_is_the_same_in_table_and_json(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """The rows that contradict are the warnings, with both numbers, on standard error and in JSON."""
    for name in ("id.sto", "ik.mot"):
        shutil.copy(TRIAL.with_name(name), tmp_path)
    (path := tmp_path / "wrong.toml").write_text(TRIAL.read_text().replace("cadence_rpm = 47", "cadence_rpm = 80"))
    code, content = answer(capsys, "moments", str(path))
    assert code == 0
    assert [row["name"] for row in content["plausibility"] if not row["agrees"]] == ["cadence"]
    assert [warning["name"] for warning in content["warnings"]] == ["cadence"]
    _, out, err = result(capsys, "moments", str(path))
    for text in (content["warnings"][0]["text"], err):
        assert "47.0 rpm recorded, declared 80.0" in text
    (row,) = (line for line in out.splitlines() if line.split()[:1] == ["cadence"])
    assert row.split() == ["cadence", "47.0", "rpm", "declared", "80.0", "contradicts"]


def test_the_tricycle_is_identified(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    _, content = answer(capsys, "moments", str(TRIAL), "--identify")
    assert [number["symbol"] for number in content["identified"]] == ["R1", "R2", "seat_angle"]
    assert all(number["identified"] == pytest.approx(number["declared"], rel=1e-4) for number in content["identified"])
    _, out, _ = result(capsys, "moments", str(TRIAL), "--identify")
    assert "0.130 +- 0.000" in out
    assert "identified" not in answer(capsys, "moments", str(TRIAL))[1]
    (own := tmp_path / "own.csv").write_text(",".join(COLUMNS) + "\n0,1,2\n90,20,-3\n200,-5,4\n")
    code, _, err = result(capsys, "moments", str(own), "--identify")
    assert code == 2
    assert "angles of knee and hip" in err


def test_what_is_written_keeps_its_tricycle(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    written = tmp_path / "mine.csv"
    assert run(["moments", str(TRIAL), "-o", str(written), "-q"]) == 0
    assert names(tmp_path) == {"mine.csv", "mine.toml"}
    original, again = (answer(capsys, "moments", str(path))[1] for path in (TRIAL, written.with_suffix(".toml")))
    for key in ("power_mean_W", "cadence_rpm", "work_per_turn_J"):
        assert again[key] == pytest.approx(original[key], rel=1e-6)
    assert again["warnings"] == []
    written.with_suffix(".toml").write_text("mine\n")
    code, _, err = result(capsys, "moments", str(TRIAL), "-o", str(written))
    assert code == 2
    assert "mine.toml: cannot write" in err


def test_groups_are_shown_too(capsys: pytest.CaptureFixture[str]) -> None:
    _, content = answer(capsys, "moments", "p1p2")
    _, static = answer(capsys, "static", "trt")
    assert content["power_sd_W"] == pytest.approx(static["power_sd_W"], rel=0.1)  # legs of another length


def test_what_is_written_gives_the_same_power(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    written, picture = tmp_path / "plain.csv", tmp_path / "moments.svg"
    assert run(["moments", "p1p3", "-o", str(written), "--plot", str(picture), "-q"]) == 0
    assert picture.read_text().startswith("<?xml")
    _, original = answer(capsys, "static", "r2", "--group", "p1p3")
    _, again = answer(capsys, "static", "r2", "--moments", str(written))
    assert again["power_mean_W"] == pytest.approx(original["power_mean_W"], rel=1e-6)


@pytest.mark.parametrize(
    "command",
    [
        ("static",),
        ("simulate",),
        ("moments",),
        ("optimize", "--budget", "1000", "--searches", "1", "--limits", "paper"),
    ],
)
def test_every_command_repeats_the_warnings(
    command: tuple[str, ...], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    half = np.arange(0.0, 151.0, 10.0)
    (path := tmp_path / "half.csv").write_text(
        csv_text(dict(zip(COLUMNS, (half, 10 + 0 * half, 0 * half), strict=True)))
    )
    what, *more = command
    of = {"moments": [str(path)], "optimize": ["crt", "--moments", str(path)]}
    code, _, err = result(capsys, what, *of.get(what, ["d1", "--moments", str(path)]), *more, "-q")
    assert code in (0, 1)
    assert "warning: half: largest gap: 210 deg recorded, at most 60 expected" in err


def test_what_is_refused(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    own = tmp_path / "own.csv"
    own.write_text(",".join(COLUMNS) + "\n0,1,2\n90,20,-3\n200,-5,4\n")
    before = own.read_bytes()
    for arguments, words in (
        ((str(own), "-o", str(own)), "it would replace"),
        ((str(TRIAL), "-o", str(TRIAL.with_name("id.sto"))), "must end in .csv"),
        ((str(own), "--plot", str(tmp_path / "a.gif")), "the name must end in .png or .svg"),
        ((str(tmp_path / "none.toml"),), "No such file"),
    ):
        code, out, err = result(capsys, "moments", *arguments)
        assert (code, out) == (2, "")
        assert words in err
    assert own.read_bytes() == before
    assert [*tmp_path.iterdir()] == [own]


def test_two_files_are_the_two_legs(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    own = tmp_path / "own.csv"
    own.write_text(",".join(COLUMNS) + "\n0,1,2\n90,20,-3\n200,-5,4\n")
    pair = ("--moments", str(TRIAL), "--moments", str(own))
    for refused in (("static", "d1", *pair), ("simulate", "d1", *pair), ("validate", "d1", *pair)):
        code, _, err = result(capsys, *refused)
        assert code == 2
        assert "--moments is given 2 times" in err
    code, both = answer(capsys, "simulate", "d1", "--legs", "2", *pair)
    assert code == 0
    assert both["agrees"]
    alone = [answer(capsys, "static", "d1", "--moments", str(path))[1]["power_mean_W"] for path in (TRIAL, own)]
    assert both["static_power_mean_W"] == pytest.approx(sum(alone) / 2)
    assert both["power_mean_W"] == pytest.approx(sum(alone) / 2, rel=5e-4)
    code, out, _ = result(capsys, "simulate", "d1", "--legs", "2", "-v", *pair)
    assert code == 0
    assert "quasi-static, right" in out


def test_muscles_of_a_trial_drive_a_design(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the trial to static, with as few riders as make a file."""
    monkeypatch.setattr("fes_mj.cli.moments._CANDIDATES", 200)
    monkeypatch.setattr("fes_mj.cli.moments._STEPS", 1)
    riders = tmp_path / "rider.npz"
    code, content = answer(capsys, "moments", str(TRIAL), "--fit-muscles", "-o", str(riders))
    assert code == 0
    assert names(tmp_path) == {"rider.npz"}
    fitted = content["fitted"]
    assert fitted["members"] == 200
    assert 0.8 < fitted["explained_share"] <= 1
    assert {row["identified"] for row in fitted["muscles"]} == {True, False}
    assert content["riders"] == 1
    _, out, _ = result(capsys, "moments", str(TRIAL), "--fit-muscles", "-o", str(riders))
    assert "not identified" in out
    assert f"--muscles {riders}" in out
    for timing in ("best", "by-angle"):
        code, solved = answer(
            capsys, "static", "trt", "--drive", "muscles", "--muscles", str(riders), "--timing", timing
        )
        assert (code, solved["group"]) == (0, "rider")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("p1p2", "--fit-muscles", "-o", "{folder}/r.npz"), "--drive muscles --group p1p2"),
        ((str(TRIAL), "--fit-muscles"), "--fit-muscles -o RIDER.npz"),
        ((str(TRIAL), "--fit-muscles", "-o", "{folder}/r.csv"), "must end in .npz"),
        (("{own}", "--fit-muscles", "-o", "{folder}/r.npz"), "a single turn"),
    ],
)
def test_what_muscles_cannot_be_fitted_to(
    arguments: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (own := tmp_path / "own.csv").write_text(",".join(COLUMNS) + "\n0,1,2\n90,20,-3\n200,-5,4\n")
    code, out, err = result(capsys, "moments", *(part.format(folder=tmp_path, own=own) for part in arguments))
    assert (code, out) == (2, "")
    assert said in err
    assert names(tmp_path) == {"own.csv"}
