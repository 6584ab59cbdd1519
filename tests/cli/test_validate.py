"""`fes_mj validate`: verdicts, exit codes, JSON."""

import re
import sys
from pathlib import Path

import pytest

from fes_mj.cli.app import run
from fes_mj.common.checks import definitions
from fes_mj.linkage.design_file import load_design
from fes_mj.simulation.time_step import steps_per_turn
from tests.cli.conftest import answer


def test_validate_quick_says_that_all_is_well(capsys: pytest.CaptureFixture[str]) -> None:
    code, content = answer(capsys, "validate", "trt", "d1", "--quick")
    assert code == 0
    assert content["ok"] is True
    assert {"name", "value", "limit", "unit", "ok", "subject", "kind"} <= set(content["checks"][0])
    assert {check["subject"] for check in content["checks"]} == {"trt p1p2", "d1 p1p2", "A02", "four-bar"}
    assert all(check["ok"] for check in content["checks"])
    assert [row["design"] for row in content["runs"]] == ["trt", "d1"]
    assert "faults" not in content
    for row in content["runs"]:
        design = load_design(row["design"])
        steps = steps_per_turn(design, design.linkage.cadence)
        assert row["timestep_s"] * steps == pytest.approx(60 / row["cadence_rpm"], rel=1e-12)


def test_quick_checks_two_legs_when_asked(capsys: pytest.CaptureFixture[str]) -> None:
    code, content = answer(capsys, "validate", "r1", "--quick", "--legs", "2")
    both = [check for check in content["checks"] if check["subject"] == "r1 p1p2, two legs"]
    assert code == 0
    assert {"mean_power", "loop_gap"} <= {check["name"] for check in both}


def test_a_failed_check_exits_with_1_and_is_named(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fes_mj.simulation.mjcf.LOOP_SOLREF", (0.02, 1.0))
    assert run(["validate", "r2", "--quick"]) == 1
    text = " ".join(capsys.readouterr().out.split())
    assert "checks failed" in text
    assert "loop_gap (r2 p1p2)" in text


def test_a_run_that_breaks_down_is_a_verdict(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    import mujoco

    from fes_mj.simulation import mjcf

    monkeypatch.setitem(mjcf.INTEGRATORS, "discrete", mujoco.mjtIntegrator.mjINT_IMPLICITFAST)
    code, content = answer(capsys, "validate", "d1", "--quick")
    failed = [check["name"] for check in content["checks"] if not check["ok"]]
    assert code == 1
    assert "stability" in failed
    assert content["runs"] == []


def test_an_own_design_is_validated_without_the_paper(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    from fes_mj import load_design
    from fes_mj.linkage.design_file import design_toml

    path = tmp_path / "own.toml"
    path.write_text(design_toml(load_design("r2")))
    code, content = answer(capsys, "validate", str(path), "--quick")
    names = {check["name"] for check in content["checks"]}
    assert code == 0
    assert "mean_power" in names
    assert not {"joint_range", "printed_power"} & names


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("r9",), "no such design"),
        (("r2", "--dims", "printed"), "rocker and coupler cannot close"),
        (("d1", "--report", "out.txt"), "must end in .html"),
        (("d1", "--junit", "nowhere/out.xml"), "does not exist"),
        (("d1", "--video", "a.mp4"), "--report"),
        (("d1", "--report", "out.html", "--video", "none.mp4"), "cannot read the video"),
        (("d1", "--group", "p1p2", "--moments", "x.csv"), "Mutually exclusive"),
    ],
)
def test_bad_input(
    arguments: tuple[str, ...],
    words: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["validate", "--quick", *arguments]) == 2
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.out == ""
    assert list(tmp_path.iterdir()) == []


def test_a_missing_package_names_the_extra(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "jinja2", None)
    assert run(["validate", "d1", "--quick", "--report", str(tmp_path / "out.html")]) == 3
    assert "pip install 'fes-mj[report]'" in capsys.readouterr().err


@pytest.mark.parametrize(("option", "name"), [("--report", "m.html"), ("--junit", "m.xml")])
def test_no_report_replaces_an_input(
    option: str, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("jinja2")
    (moments := tmp_path / name).write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n")
    assert run(["validate", "d1", "--moments", str(moments), option, str(moments)]) == 2
    assert "which this command reads" in capsys.readouterr().err
    assert moments.read_text().startswith("crank")


def test_every_check_of_simulate_can_be_explained(capsys: pytest.CaptureFixture[str]) -> None:
    _, content = answer(capsys, "simulate", "r1")
    for check in content["checks"]:
        assert run(["validate", "--explain", check["name"]]) == 0
        assert run(["validate", "--explain", check["name"].replace("_", " ").upper()]) == 0
        text = capsys.readouterr().out
        assert "guards against" in text
        assert "usually broken by" in text


def test_every_check_printed_by_simulate_is_named_as_explain_knows_it(capsys: pytest.CaptureFixture[str]) -> None:
    run(["simulate", "r1", "-v"])
    lines = capsys.readouterr().out.split("Checks")[1].splitlines()
    names = [line.split("  ")[1].strip() for line in lines if line.rstrip().endswith("ok")]
    assert len(names) >= 6
    assert set(names) <= set(definitions())


def test_all_are_listed_and_an_unknown_one_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["validate", "--explain", "all"]) == 0
    text = capsys.readouterr().out
    assert all(name in text for name in definitions())
    assert run(["validate", "--explain", "loopgap"]) == 2
    assert re.fullmatch(r"fes_mj: loopgap: .* loop_gap\?\n", capsys.readouterr().err)


@pytest.mark.parametrize("name", ["mean_power", "grashof", "all"])
def test_an_explanation_is_json_where_that_is_asked_for(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, content = answer(capsys, "validate", "--explain", name)
    assert code == 0
    if name == "all":
        assert [check["name"] for check in content["checks"]] == [*definitions()]
        content = content["checks"][0]
    assert set(content) >= ({"name", "words", "where"} if name == "grashof" else {"name", "limit", "guards", "breaks"})
    assert run(["validate", "--explain", name, "-q"]) == 0
    assert capsys.readouterr().out == ""


def test_published_measurements_are_a_report(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from fes_mj.validation import published

    few = [row for row in published.rows() if row.content["predicted_by"] in ("lost_force", "knee_of_largest_torque")]
    monkeypatch.setattr(published, "rows", lambda: few)
    code, content = answer(capsys, "validate", "--against", "published")
    assert code == 0
    assert content["verdicts"] == {"agrees": 1, "contradicts": 1, "cannot tell": 1}
    assert {"question", "drive", "timing", "predicted", "measured", "verdict", "assumed", "source"} <= set(
        content["rows"][0]
    )
    assert run(["validate", "--against", "published"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "1 contradicts" in printed
    assert "contradicts, unless muscles" in printed


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["d1", "--against", "published"], "DESIGN d1 and --against exclude each other"),
        (["--explain", "mean_power", "--against", "published"], "--against and --explain exclude each other"),
        (["d9", "--explain", "mean_power"], "DESIGN d9 and --explain exclude"),
        (["--explain", "mean_power", "--cadence", "50"], "--cadence 50.0 and --explain exclude"),
        (["--explain", "mean_power", "--drive", "muscles"], "--drive muscles and --explain exclude"),
        (["--against", "published", "--group", "p1p2"], "--group p1p2 and --against exclude"),
        *(
            (["--explain", "mean_power", *option], f"{' '.join(option)} and --explain exclude")
            for option in (["--report", "a.html"], ["--junit", "a.xml"], ["--quick"], ["--faults"], ["--verbose"])
        ),
        (["--against", "somebody"], "must be published, or the .toml file"),
        (["--against", "none.toml"], "cannot read the experiment"),
    ],
)
def test_against_what(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["validate", *arguments]) == 2
    assert said in " ".join(capsys.readouterr().err.split())
