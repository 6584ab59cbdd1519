"""Ctrl-C and kill: earlier results stay as they were, nothing is half-written."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="looks into /proc to see what runs"),
]
PATIENCE = 60  # s
# A shell shows 130 for both: Python ends by the signal itself if it came while a text was being executed.
INTERRUPTED = (130, -signal.SIGINT)
# argv: an error, a signal's number (0 for none), and a command line
WRAPS = """
import ctypes, signal, sys
from fes_mj import cli
from fes_mj.cli import app
from fes_mj.common.errors import InputError

kind, number = eval(sys.argv[1]), int(sys.argv[2])
del sys.argv[1:3]

def wraps(*_, **__):
    try:
        number and signal.raise_signal(number)
    except KeyboardInterrupt:
        pass
    raise kind("as others would say it")

app.app = wraps
cli.main()
"""


def _run(*arguments: str) -> None:
    subprocess.run([sys.executable, "-m", "fes_mj", *arguments], check=True, capture_output=True)


def _stop(how: signal.Signals, *arguments: str) -> tuple[int, str]:
    """Start a long run, stop it in the middle; exit code and standard error."""
    command = [sys.executable, "-m", "fes_mj", *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        begin, maps = time.monotonic(), Path(f"/proc/{process.pid}/maps")
        while "libmujoco" not in maps.read_text():  # it has begun to simulate
            assert process.poll() is None, process.communicate()
            assert time.monotonic() - begin < PATIENCE
            time.sleep(0.05)
        time.sleep(0.7)
        assert process.poll() is None, "the run was over before it could be stopped"
        process.send_signal(how)
        _, errors = process.communicate(timeout=PATIENCE)
        return process.returncode, errors


def _contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_an_interrupted_run_leaves_earlier_results(how: signal.Signals, tmp_path: Path) -> None:
    _run("simulate", "d1", "--out", str(tmp_path))
    before = _contents(tmp_path)
    assert len(before) == 4  # result, cycle, model, and the record of the three
    code, errors = _stop(how, "simulate", "d1", "--turns", "300", "--out", str(tmp_path))
    assert _contents(tmp_path) == before
    if how is signal.SIGKILL:
        assert code == -how
    else:
        assert code in ((143,) if how is signal.SIGTERM else INTERRUPTED)
        assert errors == "fes_mj: interrupted; nothing was left half-written\n"


def test_an_interrupted_validation_writes_nothing(tmp_path: Path) -> None:
    report, junit = tmp_path / "out.html", tmp_path / "out.xml"
    report.write_text("an earlier report")
    code, errors = _stop(signal.SIGINT, "validate", "--faults", "--report", str(report), "--junit", str(junit))
    assert code in INTERRUPTED
    assert "Traceback" not in errors
    assert _contents(tmp_path) == {"out.html": b"an earlier report"}


def test_a_kill_in_the_middle_of_writing_leaves_the_old_file(tmp_path: Path) -> None:
    """Nothing can be tidied up after SIGKILL; but what stands under the name is whole."""
    target = tmp_path / "result.json"
    target.write_text("old")
    script = (
        "import os, signal, sys, pathlib\n"
        "from fes_mj.common.writing import replacing\n"
        "with replacing(pathlib.Path(sys.argv[1])) as beside:\n"
        "    beside.write_text('half')\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    done = subprocess.run([sys.executable, "-c", script, str(target)], env=dict(os.environ), check=False)
    assert done.returncode == -signal.SIGKILL
    assert target.read_text() == "old"


@pytest.mark.parametrize(
    ("how", "error"),
    [
        *((signal.SIGINT, error) for error in ("ImportError", "ctypes.ArgumentError", "InputError", "OSError")),
        *((how, "ImportError") for how in (signal.SIGTERM, signal.SIGHUP)),
    ],
)
def test_an_error_that_somebody_made_of_an_interruption_is_one(how: signal.Signals, error: str) -> None:
    """A compiled module that is being loaded makes another error of it, and so does ctypes of its arguments."""
    done = subprocess.run(
        [sys.executable, "-c", WRAPS, error, str(int(how)), "simulate", "d1"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (128 + how, "fes_mj: interrupted; nothing was left half-written\n")


DROPS = """
import signal, sys, time, weakref
from fes_mj import cli
from fes_mj.cli import app

class Thing: pass

def waits(*_, **__):
    thing = Thing()
    watched = weakref.ref(thing, lambda _: signal.raise_signal(int(sys.argv[1])))
    del thing
    time.sleep(60)

app.app = waits
cli.main()
"""


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_python_drops_comes_again(how: signal.Signals) -> None:
    """Nothing can be raised where Python clears up an object; it would say so and go on."""
    done = subprocess.run(
        [sys.executable, "-c", DROPS, str(int(how))], capture_output=True, text=True, check=False, timeout=PATIENCE
    )
    assert (done.returncode, done.stderr) == (128 + how, "fes_mj: interrupted; nothing was left half-written\n")


def test_an_error_without_a_signal_stays_what_it_is() -> None:
    done = subprocess.run(
        [sys.executable, "-c", WRAPS, "ImportError", "0", "simulate", "d1"], capture_output=True, check=False
    )
    assert done.returncode == 70  # 1 says that two solvers do not agree
    assert done.stderr.endswith(b"ImportError: as others would say it\n")


def test_too_little_memory_is_no_disagreement() -> None:
    done = subprocess.run(
        [sys.executable, "-c", WRAPS, "MemoryError", "0", "simulate", "d1"], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "not enough memory" in done.stderr


STUDY = '[study]\nchunk = 200\n[grid]\ndesign = ["d1", "r1"]\n[sample]\nsize = 400\nR2 = [0.03, 0.16]\n'
# `fes_mj reproduce` of one page and one figure
REDUCED = """
from types import SimpleNamespace
from fes_mj import cli, load_design, load_moments, quasi_static
from fes_mj.paper import figures, identification, reproduce

runs = SimpleNamespace(known=SimpleNamespace(hyperparameters=SimpleNamespace()), dynamic={})
designs = map(load_design, ("trt", "r1", "r2", "d1", "d2"))
runs.static = {(design.name, "p1p2"): quasi_static(design, load_moments()) for design in designs}
reproduce.run_all = lambda silent: runs
reproduce._pages = lambda runs: {"identification": [identification.ranges_table()]}
figures.FIGURES = {name: figures.FIGURES[name] for name in ["figure-10-design-space"]}
cli.main()
"""
FES_MJ = ("-m", "fes_mj")
RUNS = {
    "sweep": (*FES_MJ, "sweep", "s.toml", "-o", "out", "--jobs", "2", "-q"),
    "optimize": (
        *(*FES_MJ, "optimize", "crt", "-o", "out/best.toml"),
        *("--budget", "2000", "--searches", "2", "--jobs", "2", "-q"),
    ),
    "reproduce": ("-c", REDUCED, "reproduce", "-q", "--out", "out"),
    "report": (*FES_MJ, "validate", "d1", "--quick", "-q", "--report", "out/report.html"),
    "video": (*FES_MJ, "simulate", "d1", "-q", "--render", "out/d1.mp4"),
}


@pytest.mark.parametrize("part", [0.4, 0.97])
@pytest.mark.parametrize("name", RUNS)
def test_a_signal_at_any_time_ends_in_its_code_and_leaves_nothing_half(name: str, part: float, tmp_path: Path) -> None:
    """At a part of the time that the whole run takes; what is there afterwards is whole, and no traceback is shown."""
    (tmp_path / "s.toml").write_text(STUDY)
    command = [sys.executable, *RUNS[name]]
    if name != "sweep":
        (tmp_path / "out").mkdir()
    begin = time.monotonic()
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    seconds = time.monotonic() - begin
    whole = {path.name for path in (tmp_path / "out").iterdir()}
    shutil.rmtree(tmp_path / "out")
    if name != "sweep":
        (tmp_path / "out").mkdir()
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        time.sleep(part * seconds)
        process.terminate()
        _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode in (0, 143, -signal.SIGTERM)  # the last before the handler stands
    assert "Traceback" not in errors
    assert not errors or re.fullmatch(
        "fes_mj: interrupted; (nothing was left half-written|the best so far, .*)\n", errors
    )
    left = {path.name for path in (tmp_path / "out").iterdir()} if (tmp_path / "out").exists() else set()
    assert left <= whole | {"best.search"}


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_video_that_was_being_made_leaves_no_file(how: signal.Signals, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "fes_mj", "simulate", "d1", "-q", "--render", str(tmp_path / "v.mp4")]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        begin = time.monotonic()
        while not [*tmp_path.iterdir()]:  # the temporary file
            assert process.poll() is None
            assert time.monotonic() - begin < PATIENCE
            time.sleep(0.02)
        process.send_signal(how)
        _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode in (128 + how, *(INTERRUPTED if how is signal.SIGINT else ()))
    assert errors == "fes_mj: interrupted; nothing was left half-written\n"
    assert not [*tmp_path.iterdir()]
