"""Studies on several processes, on a real Dask cluster with a worker killed, and after a real kill -9."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from fes_mj.common.errors import InputError
from fes_mj.common.parallel import HERE, Workers, run_tasks
from fes_mj.sweep.study import load_study
from fes_mj.sweep.sweep import Sweep

pytest.importorskip("pyarrow")
pytest.importorskip("joblib")

STUDY = """
[study]
chunk = {chunk}
[grid]
design = ["d1", "r2"]
moments = ["p1p2", "p1p3"]
cadence_rpm = [60, 90]
[sample]
size = {size}
R2 = [0.03, 0.17]
shank = [0.49, 0.55]
"""


def study_file(folder: Path, chunk: int = 500, size: int = 1000) -> Path:
    path = folder / "study.toml"
    path.write_text(STUDY.format(chunk=chunk, size=size))
    return path


def run(study: Path, folder: Path, workers: Workers = HERE) -> Sweep:
    sweep = Sweep(load_study(study), folder)
    sweep.run(workers)
    return sweep


def slow(seconds: float) -> tuple[int, float]:
    """A task that takes a while and says which process did it."""
    time.sleep(seconds)
    return os.getpid(), seconds


@pytest.mark.process
def test_processes_give_the_serial_result(tmp_path: Path) -> None:
    study = study_file(tmp_path)
    serial, parallel = run(study, tmp_path / "serial"), run(study, tmp_path / "parallel", Workers(jobs=2))
    assert serial.read().equals(parallel.read())
    assert serial.read().num_rows == 8000


def test_tasks_are_spread_over_processes() -> None:
    processes = {pid for _, (pid, _) in run_tasks(slow, [0.3, 0.3, 0.3, 0.3], Workers(jobs=2))}
    assert len(processes) == 2
    assert os.getpid() not in processes


def test_fewer_than_one_job_is_refused() -> None:
    with pytest.raises(InputError, match="jobs is 0"):
        list(run_tasks(slow, [0.0], Workers(jobs=0)))


@pytest.mark.process
def test_a_sweep_survives_kill_9(tmp_path: Path) -> None:
    """Killed with chunks done and chunks to do; then finished chunks are kept as they are, none is counted twice."""
    study, folder = study_file(tmp_path, chunk=400, size=5000), tmp_path / "out"
    command = [sys.executable, "-m", "fes_mj", "sweep", str(study), "-o", str(folder), "--jobs", "1", "-q"]
    process = subprocess.Popen(command)
    deadline = time.monotonic() + 60
    while len([*folder.glob("chunk-*")]) < 5 and time.monotonic() < deadline:
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    before = {path.name: path.stat().st_mtime_ns for path in folder.glob("chunk-*")}
    assert 5 <= len(before) < 100
    result = subprocess.run([*command[:-1], "--json"], capture_output=True, text=True, check=True)
    assert f'"found_finished": {400 * len(before)},' in result.stdout
    after = {path.name: path.stat().st_mtime_ns for path in folder.glob("chunk-*")}
    assert {name: after[name] for name in before} == before
    points = Sweep(load_study(study), folder).read()["point"].to_pylist()
    assert points == list(range(40_000))


LONG = """
from fes_mj.cli.process import prepare
from fes_mj.common.parallel import Workers, run_tasks
from tests.common.test_parallel import slow
prepare()
for _, (pid, _) in run_tasks(slow, [0.2, 0.2, *[300.0] * 4], Workers(jobs=2)):
    print(pid, flush=True)
"""


def lives(pid: int) -> bool:
    """Whether a process runs; one that ended and was not asked about yet does not."""
    try:
        return "State:\tZ" not in Path(f"/proc/{pid}/status").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.mark.process
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="looks into /proc to see what runs")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_worker_outlives_its_parent(how: signal.Signals) -> None:
    """The tasks would take minutes; the workers hold the pipe to whoever reads the results."""
    root = Path(__file__).parents[2]
    with subprocess.Popen(
        [sys.executable, "-c", LONG], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, cwd=root, text=True
    ) as process:
        assert process.stdout
        workers = {int(process.stdout.readline()) for _ in range(2)}
        assert all(map(lives, workers))
        process.send_signal(how)
        process.stdout.read()  # until nobody holds it
        process.wait()
    deadline = time.monotonic() + 30
    while any(map(lives, workers)) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert not any(map(lives, workers))


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, list[subprocess.Popen[str]]]]:
    """Address of a Dask scheduler in its own process, and two worker processes without nannies."""
    pytest.importorskip("distributed")

    def start(*arguments: str) -> subprocess.Popen[str]:
        log = (tmp_path / f"{arguments[0]}.log").open("a")
        command = [sys.executable, "-m", "dask", *arguments, "--no-dashboard"]
        return subprocess.Popen(command, stderr=log, stdout=log, cwd=tmp_path, text=True)

    processes: list[subprocess.Popen[str]] = []
    processes.append(start("scheduler", "--host", "127.0.0.1", "--port", "0"))
    address, deadline = None, time.monotonic() + 30
    while not address and time.monotonic() < deadline:
        time.sleep(0.1)
        address = re.search(r"Scheduler at:\s+(tcp://\S+)", (tmp_path / "scheduler.log").read_text())
    assert address
    worker = ("worker", address[1], "--no-nanny", "--nthreads", "1", "--host", "127.0.0.1")
    processes += [start(*worker), start(*worker)]
    yield address[1], processes[1:]
    for process in reversed(processes):
        process.kill()
        process.wait()


@pytest.mark.process
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
def test_a_cluster_that_loses_a_worker_gives_the_serial_result(
    tmp_path: Path, cluster: tuple[str, list[subprocess.Popen[str]]]
) -> None:
    address, workers = cluster
    study = study_file(tmp_path, chunk=2000, size=20_000)
    serial = run(study, tmp_path / "serial")
    sweep, killed = Sweep(load_study(study), tmp_path / "cluster"), []

    def kill_one(_: int) -> None:
        if len(sweep.finished()) == 20:
            workers[0].kill()
            killed.append(len(sweep.finished()))

    sweep.run(Workers(cluster=address), kill_one)
    assert killed
    assert killed[0] < sweep.study.chunks
    assert workers[0].wait(timeout=10) == -signal.SIGKILL
    assert workers[1].poll() is None
    assert sweep.read().equals(serial.read())
