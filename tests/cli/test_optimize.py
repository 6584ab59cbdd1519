"""`fes_mj optimize`: the promised JSON, files that other commands take, one message for bad input."""

import json
import math
import os
import subprocess
from pathlib import Path

import pytest

import fes_mj
from fes_mj.cli.app import run
from fes_mj.common.errors import UnstableError
from fes_mj.linkage.design_file import design_toml
from fes_mj.optimization.findings import Findings
from fes_mj.optimization.limits import DEFAULT
from fes_mj.optimization.search import SearchResult

PAPER = ["--limits", "paper"]  # without forces and clearances, which take long
FEW = ["--budget", "2000", "--seed", "2", *PAPER]
QUICK = [*FEW, "--searches", "1"]
LIKE_D2 = ["--group", "p1p3", "--speeds-of", "d2", "--start", "d2", "--caution", "1", "--knee-speed-limit", "170"]
# from a feasible start: where the file and not the search is looked at
FROM_D1 = ["--start", "d1", "--speeds-of", "d1", "--budget", "1000", "--seed", "2", *PAPER]


def test_the_winner_is_what_the_other_commands_see(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("jinja2")
    best, page = tmp_path / "best.toml", tmp_path / "best.html"
    command = ["optimize", "cdt", "--group", "p1p3", "--speeds-of", "d2", "--start", "d2", *QUICK, "-o", str(best)]
    assert run([*command, "--report", str(page), "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["feasible"]
    assert content["violations"] == []
    assert content["evaluations"] == 2000
    assert content["design_file"] == str(best)
    assert content["gain_W"] > 0
    assert content["gain_deviation_W"] > 0
    assert content["mean_knee_speed_deg_s"] <= 162.93
    assert run(["static", str(best), "--group", "p1p3", "--json"]) == 0
    static = json.loads(capsys.readouterr().out)
    assert static["power_mean_W"] == pytest.approx(content["power_mean_W"], rel=1e-12)
    assert static["cadence_rpm"] == pytest.approx(content["cadence_rpm"], rel=1e-12)
    assert content["agrees"]
    assert run(["simulate", str(best), "--group", "p1p3", "--timestep", str(content["timestep_s"]), "--json"]) == 0
    simulated = json.loads(capsys.readouterr().out)
    assert simulated["power_mean_W"] == pytest.approx(content["simulated_power_mean_W"], rel=1e-9)
    swing = simulated["simulated_power_peak_to_peak_W"]
    assert content["simulated_power_highest_W"] - content["simulated_power_lowest_W"] == pytest.approx(swing, rel=1e-9)
    assert content["simulated_power_peak_to_peak_W"] == pytest.approx(swing, rel=1e-9)
    text = page.read_text(encoding="utf-8")
    assert f"{content['power_mean_W']:.3f}" in text
    assert "<svg" in text
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(tmp_path / "best.xml"))
    assert model.neq == 2


def test_the_default_speed_limit_is_that_of_the_trt(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["optimize", "crt", *QUICK, "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["mean_knee_speed_deg_s"] <= 107.14
    assert content["mean_knee_speed_deg_s"] > 95
    assert run(["optimize", "crt", *QUICK, "--knee-speed-limit", "80", "--json"]) == 0
    slower = json.loads(capsys.readouterr().out)
    assert slower["mean_knee_speed_deg_s"] <= 80.0
    assert slower["power_mean_W"] < content["power_mean_W"]


@pytest.mark.long
def test_riders_of_a_population_are_listed_with_their_seats(capsys: pytest.CaptureFixture[str]) -> None:
    people = ["--riders", "population", "--samples", "50", "--sample-seed", "1"]
    search = ["optimize", "crt", "--budget", "12000", "--searches", "1", *people, *PAPER]
    assert run([*search, "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["feasible"]
    own, *others = content["riders"]
    assert own["power_mean_W"] == pytest.approx(content["power_mean_W"], rel=1e-4)
    assert (own["forward_m"], own["up_m"]) == (0.0, 0.0)
    assert len({rider["thigh"] for rider in others}) == len(others) > 1
    assert min(r["power_mean_W"] for r in content["riders"]) < content["power_people_W"]
    assert "--samples=50 --sample-seed=1" in content["command"]
    assert run(search) == 0
    assert "by these riders" in capsys.readouterr().out


def test_a_front_beside_the_design(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pymoo")
    out = tmp_path / "front.toml"
    assert (
        run(
            ["optimize", "cdt", "--method", "nsga-ii", "--smooth", "--budget", "2000", *PAPER, "-o", str(out), "--json"]
        )
        == 0
    )
    content = json.loads(capsys.readouterr().out)
    lines = (tmp_path / "front-front.csv").read_text().splitlines()
    assert len(lines) == len(content["front"]) + 1
    assert lines[0].endswith(",fluctuation")
    written = [float(line.split(",")[-1]) for line in lines[1:]]
    assert written == pytest.approx([point["fluctuation"] for point in content["front"]], rel=1e-8)  # nine digits
    design = fes_mj.load_design(out)
    for group in ("p1p2", "p1p3"):
        power = fes_mj.quasi_static(design, fes_mj.load_moments(group)).power_mean
        assert any(math.isclose(power, point["power_mean_W"][group], rel_tol=1e-4) for point in content["front"])
    averages = [sum(point["power_mean_W"].values()) for point in content["front"]]
    own = sum(fes_mj.quasi_static(design, fes_mj.load_moments(group)).power_mean for group in ("p1p2", "p1p3"))
    assert own == pytest.approx(max(averages), rel=1e-4)


def test_own_moments_have_no_error_bar(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    moments = tmp_path / "mine.csv"
    moments.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,5,1\n60,25,2\n180,5,-1\n270,-5,0\n")
    assert run(["optimize", "cdt", "--moments", str(moments), *FROM_D1, "--searches", "1", "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["gain_W"] is None
    assert content["group"] == "mine"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["cdt", "--like", "d1", "--start", "d2"], "exclusive arguments: {--like, --start}"),
        (["cdt", "--limits", "paper", "--hip-swing-min", "3"], "--hip-swing-min 3.0 needs --limits buildable"),
        (["cdt", "--pin-force-max", "0"], '"0.0" for --pin-force-max. Must be > 0.'),
        (["crt", "--start", "d1"], "start is d1, a cdt, not a crt"),
        (["cdt", "--knee-speed-limit", "-3"], '"-3.0" for --knee-speed-limit. Must be > 0.'),
        (["cdt", "--hip-speed-limit", "nan"], '"nan" for --hip-speed-limit'),
        (["cdt", "--seed", "-1"], '"-1" for --seed. Must be >= 0.'),
        (["cdt", "--budget", "5"], '"5" for --budget. Must be >= 1000.'),
        (["cdt", "--caution", "1", "--method", "nsga-ii"], "--caution 1.0 and --method nsga-ii exclude each other"),
        (["cdt", "--smooth"], "--smooth needs --method nsga-ii"),
        (["cdt", "--group", "p1p2", "--moments", "x.csv"], "Mutually exclusive arguments: {--group, --moments}"),
        (["cdt", "--out", "best.txt"], "best.txt: cannot write the design: the name must end in .toml"),
        (["cdt", "--report", "nowhere/best.html"], "the folder does not exist"),
        (["cdt", "--problem", "missing.toml"], "missing.toml: cannot read the problem"),
        (["cdt", "--ripple-limit", "0"], '"0.0" for --ripple-limit. Must be > 0.'),
        (["cdt", "--ripple-limit", "nan"], '"nan" for --ripple-limit'),
        (["cdt", "--method", "nsga-ii", "--searches", "2"], "--searches 2 needs --method differential-evolution or"),
        (["cdt", "--cluster", "nonsense"], '"nonsense" for --cluster. No Dask scheduler has such an address'),
        (["cdt", "--cluster", "tcp://a:1", "--jobs", "2"], "exclusive arguments: {--jobs, --cluster}"),
        (["cdt", "--print-problem", "--json"], "--json and --print-problem exclude each other"),
        (["cdt", "--print-problem", "-o", "b.toml"], "--out b.toml and --print-problem exclude each other"),
        (["cdt", "--samples", "100"], "--samples 100 needs --riders"),
        (["cdt", "--riders", "one", "--samples", "100"], "--samples 100 needs --riders population or population-p10"),
        (["cdt", "--riders", "population", "--samples", "1"], '"1" for --samples. Must be >= 10.'),
        (["cdt", "--riders", "population", "--sample-seed", "-1"], '"-1" for --sample-seed. Must be >= 0.'),
        (
            ["cdt", "--riders", "population-p10", "--caution", "1"],
            "--riders population-p10 and --caution 1 exclude each other",
        ),
        (["cdt", "--jobs", "0"], '"0" for --jobs. Must be >= 1.'),
    ],
)
def test_bad_input_is_one_message(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["optimize", *arguments]) == 2
    captured = capsys.readouterr()
    assert said in captured.err.replace("\n", " ")
    assert "Traceback" not in captured.err
    assert captured.out == ""


def found_with(path: Path) -> list[str]:
    """The arguments after `fes_mj` of the command in a design file, as a shell reads them."""
    line = path.read_text().splitlines()[1]
    shown = subprocess.run(["bash", "-c", f"printf '%s\\0' {line[2:]}"], check=True, capture_output=True).stdout
    program, *arguments = os.fsdecode(shown).split("\0")[:-1]
    assert program == "fes_mj"
    return arguments


@pytest.mark.parametrize(
    "given",
    [
        QUICK,
        pytest.param(
            [*LIKE_D2, *QUICK],
            marks=pytest.mark.long,
        ),
        ["--problem", "it's a *problem*\x07.toml", "--moments", "-m.csv", *QUICK],
        pytest.param(["--method", "nsga-ii", "--smooth", *FEW], marks=pytest.mark.long),  # one search makes the front
        pytest.param(["--riders", "population-p10", *QUICK], marks=pytest.mark.long),
    ],
)
def test_the_command_in_the_file_gives_the_same_bytes_again(
    given: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Design file, model, front, page and JSON; also when it is run over its own files."""
    pytest.importorskip("jinja2")
    pytest.importorskip("pymoo")
    monkeypatch.chdir(tmp_path)
    Path("it's a *problem*\x07.toml").write_text(DEFAULT.read_text().replace("hip_deg = [85.0", "hip_deg = [86.0"))
    Path("-m.csv").write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,5,1\n60,25,2\n180,5,-1\n270,-5,0\n")
    given = [f"--moments={word}" if word == "-m.csv" else word for word in given if word != "--moments"]
    out, more = "the best.toml", ["--report", "page.html", "--json"]
    assert run(["optimize", "cdt", *given, "-o", out, *more]) == 0
    shown, files = capsys.readouterr().out, {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    again = found_with(Path(out))
    assert run([*again, *more]) == 0
    assert capsys.readouterr().out == shown
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == files
    assert json.loads(shown)["command"].startswith("fes_mj optimize cdt")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--start", "b.toml", "-o", "b.toml"], "b.toml: cannot write the design: it would replace b.toml"),
        (["--speeds-of", "b.toml", "-o", "./b.toml"], "b.toml: cannot write the design: it would replace b.toml"),
        (["--problem", "p.toml", "-o", "p.toml"], "p.toml: cannot write the design: it would replace p.toml"),
        (["--problem", "p.toml", "-o", "link.toml"], "link.toml: cannot write the design: it would replace p.toml"),
        (["--start", "page.html", "--report", "page.html"], "page.html: cannot write the page: it would replace"),
        (["--moments", "m-front.csv", "-o", "m.toml", "--method", "nsga-ii"], "m-front.csv: cannot write the front"),
        (["-o", "theirs.toml"], "theirs.xml: cannot write the model: a file has this name that fes_mj did not write"),
    ],
)
def test_no_output_replaces_an_input_or_a_file_of_somebody_else(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("pymoo")
    monkeypatch.chdir(tmp_path)
    Path("b.toml").write_text(design_toml(fes_mj.load_design("d2")))
    Path("p.toml").write_text(DEFAULT.read_text())
    Path("link.toml").symlink_to("p.toml")
    Path("page.html").write_text("mine")
    Path("theirs.xml").write_text("<mujoco/>")
    Path("m-front.csv").write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,5,1\n60,25,2\n")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert run(["optimize", "cdt", *arguments, "--budget", "2000", *PAPER]) == 2
    assert said in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.parametrize(
    ("step", "error", "code"),
    [
        ("fes_mj.optimization.winner.assess", UnstableError("it broke down"), 1),
        ("fes_mj.optimization.winner.to_rider", fes_mj.InputError("no sample"), 2),
        ("fes_mj.optimization.page.page_html", OSError(28, "No space left on device"), 2),
        ("fes_mj.simulation.export.mjcf_text", fes_mj.InputError("MuJoCo cannot build the model"), 2),
    ],
)
def test_what_was_found_stays_when_a_later_step_fails(
    step: str,
    error: Exception,
    code: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    pytest.importorskip("jinja2")

    def fail(*_: object, **__: object) -> None:
        raise error

    out = tmp_path / "best.toml"
    command = ["optimize", "cdt", *FROM_D1, "--searches", "1", "-o", str(out)]
    with monkeypatch.context() as broken:
        broken.setattr(step, fail)
        assert run([*command, "--report", str(tmp_path / "page.html")]) == code
    assert str(error.args[-1]) in capsys.readouterr().err
    best = out.read_bytes()
    assert run(command) == 0
    assert out.read_bytes() == best


def test_ctrl_c_says_what_was_found_and_the_same_command_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out, finish = tmp_path / "best.toml", Findings.finish
    command = ["optimize", "cdt", *FROM_D1, "--searches", "3", "-o", str(out), "--json"]
    assert run(command) == 0
    undisturbed, best = capsys.readouterr().out, out.read_bytes()
    out.unlink()

    def interrupted(findings: Findings, search: int, result: SearchResult) -> None:
        finish(findings, search, result)
        if search == 1:
            raise KeyboardInterrupt

    with monkeypatch.context() as broken:
        broken.setattr(Findings, "finish", interrupted)
        assert run(command) == 130
    captured = capsys.readouterr()
    power = fes_mj.quasi_static(fes_mj.load_design(out), fes_mj.load_moments("p1p2")).power_mean
    assert f"interrupted; the best so far, {power:.2f} W, is saved in {out}; the same command" in captured.err
    assert captured.out == ""
    assert sorted(path.name for path in (tmp_path / "best.search").glob("search-*")) == [
        "search-0.json",
        "search-1.json",
    ]
    assert run([*command, "--group", "p1p3"]) == 2
    assert "(different: command, problem)" in capsys.readouterr().err
    assert run(command) == 0
    assert capsys.readouterr().out == undisturbed
    assert out.read_bytes() == best
    assert not (tmp_path / "best.search").exists()


def test_a_problem_that_nothing_solves(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(DEFAULT.read_text().replace("hip_deg = [85.0, 120.0]", "hip_deg = [5.0, 6.0]"))
    assert run(["optimize", "crt", "--problem", str(path), *QUICK]) == 2
    message = capsys.readouterr().err.replace("\n", " ")
    assert "no feasible crt found in 2000 evaluations; the closest violates: " in message
    assert "hip_max" in message


def test_a_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "cma", None)
    assert run(["optimize", "crt", "--method", "cma-es", *QUICK]) == 3
    assert "pip install 'fes-mj[optimize]'" in capsys.readouterr().err.replace("\n", " ")


OWN = """
[linkage]
kind = "cdt"
R1 = [-0.55, 0.18]
R2 = 0.14
R6 = 0.09
R7 = [-0.20, 0.10]
R8 = 0.10
R9 = 0.27
R10 = 0.24
gamma = 75
gear_ratio = 1.8
seat_angle = 38.0
[rider]
thigh = 0.44
shank = 0.50
mass = 82
"""


@pytest.mark.long
@pytest.mark.parametrize(
    "flags", [["--like", "FILE"], ["--start", "FILE", "--speeds-of", "FILE"], ["--speeds-of", "FILE"]]
)
def test_a_search_begins_where_the_designer_stands(
    flags: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Rider, seat and place are one's own; a start that does not keep the limits is repaired, and that is said."""
    own, out = tmp_path / "own.toml", tmp_path / "found.toml"
    own.write_text(OWN)
    command = ["optimize", "cdt", *(word.replace("FILE", str(own)) for word in flags), "--budget", "1000"]
    assert run([*command, "--searches", "1", "-o", str(out), "--json"]) == 0
    content, drawn, found = json.loads(capsys.readouterr().out), fes_mj.load_design(own), fes_mj.load_design(out)
    assert content["feasible"]
    assert found.rider == drawn.rider
    assert found.linkage.seat_angle == drawn.linkage.seat_angle
    assert content["transmission_angle_min_deg"] >= 30
    assert content["hip_swing_deg"] >= 5
    assert content["extrapolated_share"] == 0
    assert content["pin_force_max_N"] <= 1500
    assert content["clearance_min_m"] >= 0.004  # between the angles of the search 0.3 mm less
    if flags != ["--speeds-of", "FILE"]:
        assert abs(found.linkage.ground - drawn.linkage.ground) < 0.15 * math.sqrt(2) + 0.2
        assert "R9" in content["repair"]
    if "--like" in flags:
        assert found.linkage.gear_ratio <= 1.8


def test_the_problem_that_is_solved_is_printed_and_read_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = tmp_path / "own.toml"
    own.write_text(OWN)
    assert run(["optimize", "cdt", "--like", str(own), "--clearance-min", "0.008", "--print-problem"]) == 0
    printed = capsys.readouterr().out
    assert "clearance_min = 0.008" in printed
    assert "thigh 0.44 m, shank 0.5 m" in printed
    (tmp_path / "mine.toml").write_text(printed)
    assert (
        run(["optimize", "cdt", "--like", str(own), "--problem", str(tmp_path / "mine.toml"), "--print-problem"]) == 0
    )
    assert capsys.readouterr().out == printed
