"""The command line as a whole: bad input, what it imports, its names."""

import subprocess
import sys
from pathlib import Path

import pytest

import fes_mj
from tests.cli.conftest import result


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["static", "x9"], "x9: no such design"),
        (["static", "r2", "--dims", "printed"], "r2: rocker and coupler cannot close at crank angle 178.8 deg"),
        (["simulate", "r2", "--dims", "printed"], "cannot close"),
        (["static", "d1", "--group", "p9"], 'Invalid value "p9" for --group'),
        (
            ["static", "d1", "--group", "p1p2", "--moments", "x.csv"],
            "Mutually exclusive arguments: {--group, --moments}",
        ),
        (["static", "d1", "--moments", "none.csv"], "none.csv: cannot read the joint moments"),
        (["static", "d1", "--cadence", "0"], 'Invalid value "0.0" for --cadence. It must be a cadence in rpm'),
        (["static", "d1", "--cadence", "nan"], 'Invalid value "nan" for --cadence'),
        (["static", "d1", "--cadence", "fast"], 'Invalid value for --cadence: unable to convert "fast"'),
        (["simulate", "d1", "--timestep", "1"], 'Invalid value "1.0" for --timestep. Must be <= 0.02.'),
        (["simulate", "d1", "--turns", "0"], 'Invalid value "0" for --turns. Must be >= 1.'),
        (["simulate", "d1", "--legs", "3"], 'Invalid value "3" for --legs'),
        (["simulate", "d1", "--out", "nowhere/out"], "nowhere: cannot write the results: the folder does not exist"),
        (["simulate", "d1", "--render", "nowhere/a.mp4"], "nowhere: cannot write the video: the folder does not exist"),
        (["simulate", "d1", "--render", "a.avi"], "a.avi: cannot write the video: the name must end in .mp4"),
        (["export", "d1", "-o", "a.txt"], "a.txt: cannot write the model: the name must end in .xml"),
        (["export", "d1", "-o", "."], ".: cannot write the model: this is a folder"),
        (["simulate", "d1", "--out", "/proc"], "cannot be written"),
        (["export", "d1"], "requires an argument"),
        (["simulate"], "requires an argument"),
        (["dance"], 'Unknown command "dance"'),
        (["static", "d1", "--louder"], "Unknown option"),
        (["simulate", "d1", "--speed", "2"], "--speed 2.0 needs --render"),
        (["explain", "loop_gap"], "explain is now `fes_mj validate --explain CHECK`"),
        (["view", "d1"], "view is now `fes_mj simulate DESIGN --view`"),
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


@pytest.mark.process
def test_help_and_statics_do_not_import_mujoco() -> None:
    for arguments in (["--help"], ["static", "d1"], ["simulate", "--help"]):
        script = (
            f"import sys; from fes_mj.cli.app import run; run({arguments!r}); "
            "heavy = {'mujoco', 'matplotlib', 'mediapy', 'scipy'}; "
            "sys.exit(str(heavy & set(sys.modules) or ''))"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        assert done.stderr.strip() == "", arguments


@pytest.mark.process
def test_the_command_and_the_module_are_the_same_thing() -> None:
    done = subprocess.run([sys.executable, "-m", "fes_mj", "--version"], capture_output=True, text=True)
    assert (done.returncode, done.stdout.strip()) == (0, "0.1.0")


def test_public_names() -> None:
    for name in ("load_design", "load_moments", "quasi_static", "build_mjcf", "simulate", "Case"):
        assert callable(getattr(fes_mj, name))
    with pytest.raises(AttributeError, match="no attribute 'dance'"):
        _ = fes_mj.dance


def imported(*arguments: str) -> tuple[int, set[str]]:
    """Exit code of a command line in a process of its own, and the packages that it imported."""
    script = (
        "import sys; from fes_mj.cli import main\ntry: main()\n"
        "finally: print(*{name.partition('.')[0] for name in sys.modules}, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script, *arguments], capture_output=True, text=True)
    return done.returncode, set(done.stderr.split())


def test_help_needs_nothing_beside_python() -> None:
    code, packages = imported("--help")
    assert (code, "fes_mj" in packages) == (0, True)
    assert not {"cyclopts", "numpy", "mujoco", "rich"} & packages


@pytest.mark.process
def test_a_simulation_needs_no_plots_and_no_scipy() -> None:
    code, packages = imported("simulate", "d1")
    assert (code, "mujoco" in packages) == (0, True)
    assert not {"matplotlib", "scipy"} & packages


@pytest.mark.parametrize(
    ("command", "usage"), [("static", "DESIGN..."), ("validate", "[DESIGN...]"), ("explore", "[DESIGN]")]
)
def test_what_a_command_takes_has_a_name(command: str, usage: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, text, _ = result(capsys, command, "--help")
    assert code == 0
    assert text.startswith(f"Usage: fes_mj {command} [OPTIONS] {usage}\n\n")
    assert " ".join(text.replace("│", "").split()).count("Of the paper trt,") == 1
    assert "[ARGS" not in text
