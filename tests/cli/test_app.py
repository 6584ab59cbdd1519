"""The command line as its users see it: what it prints, writes, refuses, and its exit codes."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.cli.app import run
from tests.test_design_file import written


def result(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Exit code, standard output, standard error."""
    code = run(arguments)
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_static_json_has_the_promised_keys(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = result(capsys, "static", "d1", "--json", "--curves")
    content = json.loads(out)
    assert (code, err) == (0, "")
    assert (content["design"], content["group"]) == ("d1", "p1p2")
    assert content["cadence_rpm"] == pytest.approx(96.4, abs=0.05)
    assert content["work_per_turn_J"] == pytest.approx(content["power_mean_W"] * 60 / content["cadence_rpm"])
    assert content["crank_angle_deg"] == list(range(360))
    moment = np.array(content["crank_moment_Nm"])
    assert moment.mean() * 2 * np.pi == pytest.approx(content["work_per_turn_J"], rel=1e-3)
    for joint in ("knee", "hip"):
        low, high = content[f"{joint}_range_deg"]
        assert low <= min(content[f"{joint}_deg"]) <= max(content[f"{joint}_deg"]) <= high


def test_power_of_recovered_moments_has_a_standard_deviation(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    content = json.loads(result(capsys, "static", "d1", "--json")[1])
    assert 0.2 < content["power_sd_W"] < 0.6
    assert f"31.11 +- {content['power_sd_W']:.2f}" in result(capsys, "static", "d1")[1]
    own = tmp_path / "own.csv"
    own.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,10,0\n90,20,0\n180,0,5\n270,-10,0\n")
    assert json.loads(result(capsys, "static", "d1", "--moments", str(own), "--json")[1])["power_sd_W"] is None
    assert "+-" not in result(capsys, "static", "d1", "--moments", str(own))[1]


def test_torque_velocity_is_off_until_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    plain, hill = (
        json.loads(result(capsys, "static", "d1", "--json", *extra)[1]) for extra in ([], ["--torque-velocity", "hill"])
    )
    assert (plain["torque_velocity"], hill["torque_velocity"]) == (None, "hill")
    assert hill["power_mean_W"] < 0.85 * plain["power_mean_W"]
    assert "relation of Hill" in result(capsys, "static", "d1", "--torque-velocity", "hill")[1]
    code, out, _ = result(capsys, "simulate", "d1", "--torque-velocity", "hill", "--json")
    assert (code, json.loads(out)["agrees"]) == (0, True)


def test_simulate_json_has_the_promised_keys(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = result(capsys, "simulate", "r1", "--group", "p1p3", "--json")
    content = json.loads(out)
    assert (code, err) == (0, "")
    assert content["agrees"] is True
    assert content["relative_difference"] == pytest.approx(
        content["power_mean_W"] / content["static_power_mean_W"] - 1, abs=1e-12
    )
    assert 0 < content["loop_gap_max_m"] <= 1e-5
    assert 0 < content["cadence_ripple"] <= 1e-4
    assert {"name", "value", "limit", "ok"} <= set(content["checks"][0])
    assert all(check["ok"] for check in content["checks"])


def test_tables_carry_units_and_the_verdict(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = result(capsys, "simulate", "trt", "-v", "--legs", "2", "--cadence", "55")
    assert code == 0
    for words in ("mean crank power, W", "knee angle, deg", "55.0 rpm", "Dynamic and static agree", "Energy over", "N"):
        assert words in out
    code, out, _ = result(capsys, "static", "r1", "-v")
    assert (code, "Joint reactions" in out) == (0, True)
    assert result(capsys, "simulate", "trt", "-q") == (0, "", "")


def test_a_run_that_does_not_agree_exits_with_1(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = result(capsys, "simulate", "d1", "--timestep", "0.004")
    assert code == 1
    assert "do not agree" in out
    assert "FAILED" in out


def test_out_writes_result_cycle_and_model(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert result(capsys, "simulate", "d2", "-q", "--out", str(tmp_path))[0] == 0
    assert {path.name for path in tmp_path.iterdir()} == {"d2-p1p2.json", "d2-p1p2.csv", "d2-p1p2.xml"}
    power = json.loads((tmp_path / "d2-p1p2.json").read_text())["power_mean_W"]
    cycle = np.genfromtxt(tmp_path / "d2-p1p2.csv", delimiter=",", names=True)
    assert cycle["crank_power_W"].mean() == pytest.approx(power, rel=1e-6)
    assert cycle["quasi_static_power_W"].mean() == pytest.approx(power, rel=1e-3)


def test_own_design_and_own_moments_work_where_catalogue_names_do(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    design, moments = written(tmp_path), tmp_path / "own.csv"
    moments.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,10,0\n90,20,0\n180,0,5\n270,-10,0\n")
    code, out, _ = result(capsys, "simulate", str(design), "--moments", str(moments), "--json")
    content = json.loads(out)
    assert (code, content["design"], content["group"]) == (0, "mine", "own")
    target = tmp_path / "mine.xml"
    assert result(capsys, "export", str(design), "-o", str(target))[0] == 0
    assert "<mujoco" in target.read_text()


def test_joint_angles_without_data_are_mentioned(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = written(tmp_path, seat_angle="50.0")
    code, out, _ = result(capsys, "static", str(path))
    assert code == 0
    assert "note: the hip moves 10.0 deg beyond the range of the moments (85.3 to 119.8 deg)" in out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["static", "x9"], "x9: no such design"),
        (["static", "r2", "--dims", "printed"], "r2: rocker and coupler cannot close at crank angle 179.0 deg"),
        (["simulate", "r2", "--dims", "printed"], "cannot close"),
        (["static", "d1", "--group", "p9"], 'Invalid value "p9" for --group'),
        (["static", "d1", "--group", "p1p2", "--moments", "x.csv"], "--group and --moments exclude each other"),
        (["static", "d1", "--moments", "none.csv"], "none.csv: cannot read the joint moments"),
        (["static", "d1", "--cadence", "0"], "--cadence is 0; it must be a cadence in rpm from 1 to 200"),
        (["static", "d1", "--cadence", "nan"], "--cadence is nan"),
        (["static", "d1", "--cadence", "fast"], 'Invalid value for --cadence: unable to convert "fast"'),
        (["simulate", "d1", "--timestep", "1"], "--timestep is 1; it must be above 0 and at most 0.02 s"),
        (["simulate", "d1", "--turns", "0"], "--turns is 0; it must be from 1 to 1000"),
        (["simulate", "d1", "--legs", "3"], 'Invalid value "3" for --legs'),
        (["simulate", "d1", "--out", "nowhere"], "nowhere: cannot write the results: the folder does not exist"),
        (["simulate", "d1", "--render", "nowhere/a.mp4"], "nowhere: cannot write the video: the folder does not exist"),
        (["simulate", "d1", "--render", "a.avi"], "a.avi: cannot write the video: the name must end in .mp4"),
        (["export", "d1", "-o", "a.txt"], "a.txt: cannot write the model: the name must end in .xml"),
        (["export", "d1", "-o", "."], ".: cannot write the model: this is a folder"),
        (["simulate", "d1", "--out", "/proc"], "/proc/d1-p1p2.json: cannot be written"),
        (["export", "d1"], "requires an argument"),
        (["simulate"], "requires an argument"),
        (["dance"], 'Unknown command "dance"'),
        (["static", "d1", "--louder"], "Unknown option"),
        (["static", "d1", "--torque-velocity", "katz"], 'Invalid value "katz" for --torque-velocity'),
    ],
)
def test_bad_input_gets_one_message_and_exit_code_2(
    arguments: list[str],
    words: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, err = result(capsys, *arguments)
    assert (code, out) == (2, "")
    assert words in err
    assert err.startswith("fes_mj: ")
    assert err.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    assert "no permission" in result(capsys, "simulate", "d1", "--out", str(tmp_path))[2]


def test_a_failed_write_leaves_the_old_file(tmp_path: Path) -> None:
    from fes_mj.files import replacing

    target = tmp_path / "result.json"
    target.write_text("old")

    def interrupted() -> None:
        with replacing(target) as beside:
            beside.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [path.read_text() for path in tmp_path.iterdir()] == ["old"]


def test_help_and_statics_do_not_import_mujoco() -> None:
    for arguments in (["--help"], ["static", "d1"], ["simulate", "--help"]):
        script = (
            f"import sys; from fes_mj.cli.app import run; run({arguments!r}); "
            "heavy = {'mujoco', 'matplotlib', 'mediapy', 'scipy'} & set(sys.modules); sys.exit(str(heavy or ''))"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        assert done.stderr.strip() == "", arguments


def test_the_command_and_the_module_are_the_same_thing() -> None:
    done = subprocess.run([sys.executable, "-m", "fes_mj", "--version"], capture_output=True, text=True)
    assert (done.returncode, done.stdout.strip()) == (0, "0.1.0")


def test_public_names() -> None:
    for name in ("load_design", "load_moments", "quasi_static", "build_mjcf", "simulate", "Case"):
        assert callable(getattr(fes_mj, name))
    with pytest.raises(AttributeError, match="no attribute 'dance'"):
        _ = fes_mj.dance
