"""What is found stays: kills, resuming, states of other searches, several processes at once."""

import os
import random
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.common.provenance import digest
from fes_mj.optimization.findings import Findings
from fes_mj.optimization.moment_drive import MomentDrive
from fes_mj.optimization.optimize import run_searches
from fes_mj.optimization.search import SearchResult
from tests.optimization.conftest import problem_of

MARK = "FES_MJ_TEST_RUN"


def findings_at(out: Path, **recipe: str) -> Findings:
    return Findings(out, "how", {"command": "fes_mj optimize", **recipe})


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_the_design_file_follows_the_best_and_the_folder_goes_in_the_end(tmp_path: Path) -> None:
    findings, problem = findings_at(tmp_path / "best.toml"), problem_of("d1")
    x = problem.variables(problem.template)
    with findings.searching(problem_of("d1")):
        assert not findings.out.exists()
        findings.improve(0, x, 5.0)
        first = findings.out.read_bytes()
        np.testing.assert_array_equal(problem.variables(fes_mj.load_design(findings.out)), x)
        findings.improve(1, 0.999 * x, 4.0)
        assert findings.out.read_bytes() == first
        findings.improve(1, 0.999 * x, 6.0)
        np.testing.assert_array_equal(problem.variables(fes_mj.load_design(findings.out)), 0.999 * x)
    assert findings.best == (6.0, [*(0.999 * x)])
    findings.remove()
    assert [*contents(tmp_path)] == ["best.toml"]


def test_a_search_that_finds_nothing_leaves_nothing(tmp_path: Path) -> None:
    findings = findings_at(tmp_path / "best.toml")
    with pytest.raises(KeyboardInterrupt), findings.searching(problem_of("d1")):
        raise KeyboardInterrupt
    assert contents(tmp_path) == {}


def test_a_design_that_was_there_is_not_replaced_by_a_search_that_is_not_finished(tmp_path: Path) -> None:
    findings = findings_at(tmp_path / "best.toml")
    findings.out.write_text("an earlier design")
    for _ in range(2):  # also when it goes on
        with findings.searching(problem_of("d1")):
            findings.improve(0, problem_of("d1").variables(fes_mj.load_design("d1")), 5.0)
        assert findings.out.read_text() == "an earlier design"
        assert fes_mj.load_design(findings.so_far).linkage.kind == "cdt"


def test_another_process_with_a_better_design_is_not_overruled(tmp_path: Path) -> None:
    one, other, problem = findings_at(tmp_path / "best.toml"), findings_at(tmp_path / "best.toml"), problem_of("d1")
    x = problem.variables(problem.template)
    with one.searching(problem), other.searching(problem):
        other.improve(1, 0.999 * x, 6.0)
        one.improve(0, x, 5.0)  # it does not know of the other's
    np.testing.assert_array_equal(problem.variables(fes_mj.load_design(one.out)), 0.999 * x)


def test_finished_searches_are_not_done_again(tmp_path: Path) -> None:
    problem, findings = problem_of("d1"), findings_at(tmp_path / "best.toml")
    with findings.searching(problem_of("d1")):
        whole = run_searches(problem, "random-pursuit", searches=3, budget=3000, seed=1, findings=findings)
        (findings.folder / "search-1.json").unlink()
        stored = findings.finished()
        assert sorted(stored) == [0, 2]
        findings.finish(0, replace(stored[0], merit=1e3))  # to be recognised
        again = run_searches(problem, "random-pursuit", searches=3, budget=3000, seed=1, findings=findings)
    assert again[0].merit == 1e3
    assert sorted(result.merit for result in again)[:2] == sorted(
        result.merit for result in whole if result.merit != stored[0].merit
    )
    for one, other in zip(again[1:], [result for result in whole if result.merit != stored[0].merit], strict=True):
        np.testing.assert_array_equal(one.x, other.x)
        np.testing.assert_array_equal(one.history, other.history)


def test_what_another_search_has_found_is_refused_by_name(tmp_path: Path) -> None:
    findings, problem = findings_at(tmp_path / "best.toml"), problem_of("d1")
    with findings.searching(problem_of("d1")):
        findings.finish(0, SearchResult(problem.variables(problem.template), 5.0, 10, np.array([[1, 5.0]])))
    before = contents(findings.folder)
    with pytest.raises(fes_mj.InputError, match=r"best\.search: .*different: command\).* fes_mj optimize\. "):
        findings_at(tmp_path / "best.toml", command="another").searching(problem).__enter__()
    with pytest.raises(fes_mj.InputError, match=r"different: problem\)"):
        findings_at(tmp_path / "best.toml").searching(problem_of("d2")).__enter__()
    assert contents(findings.folder) == before


@pytest.mark.parametrize("text", ["{}", "not JSON"])
def test_a_damaged_record_is_named(text: str, tmp_path: Path) -> None:
    findings = findings_at(tmp_path / "best.toml")
    findings.folder.mkdir()
    (findings.folder / "recipe.json").write_text("{}")
    (findings.folder / "best-0.json").write_text(text)
    with pytest.raises(fes_mj.InputError, match=r"best-0\.json"):
        findings.searching(problem_of("d1")).__enter__()


@pytest.mark.parametrize("survives", [0, 1, 2])
def test_a_kill_while_the_folder_is_removed_stops_nobody(
    survives: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever is left by then, the same command goes on, and no other takes it for its own."""
    findings, problem = findings_at(tmp_path / "best.toml"), problem_of("d1")
    x = problem.variables(problem.template)
    with findings.searching(problem):
        findings.finish(0, SearchResult(x, 5.0, 10, np.array([5.0])))
    unlink, removed = Path.unlink, []

    def killed(path: Path, missing_ok: bool = False) -> None:
        if len(removed) == survives:
            raise KeyboardInterrupt
        removed.append(path)
        unlink(path)

    monkeypatch.setattr(Path, "unlink", killed)
    with pytest.raises(KeyboardInterrupt):
        findings.remove()
    monkeypatch.undo()
    again = findings_at(tmp_path / "best.toml")
    with again.searching(problem):
        assert len(again.finished()) == (survives == 0)
        again.improve(0, x, 5.0)
    again.remove()
    assert [*contents(tmp_path)] == ["best.toml"]


def test_a_folder_of_somebody_else_is_left_alone(tmp_path: Path) -> None:
    findings = findings_at(tmp_path / "best.toml")
    findings.folder.mkdir()
    (findings.folder / "thesis.tex").write_text("mine")
    with pytest.raises(fes_mj.InputError, match=r"best\.search: .* -o"):
        findings.searching(problem_of("d1")).__enter__()
    assert contents(findings.folder) == {"thesis.tex": b"mine"}


def test_of_a_folder_only_what_a_search_wrote_is_removed(tmp_path: Path) -> None:
    findings, theirs = findings_at(tmp_path / "best.toml"), {"best-of-all.txt": b"mine", ".notes": b"mine too"}
    findings.folder.mkdir()
    (findings.folder / ".notes").write_bytes(theirs[".notes"])
    with findings.searching(problem_of("d1")):
        (findings.folder / "best-of-all.txt").write_bytes(theirs["best-of-all.txt"])
    findings.remove()
    assert contents(findings.folder) == theirs


def test_every_number_of_a_problem_counts() -> None:
    problem = problem_of("d1")
    others = [
        problem_of("d2"),
        replace(problem, drive=MomentDrive(caution=1.0)),
        replace(problem, limits=replace(problem.limits, foot_max=problem.limits.foot_max * (1 + 1e-15))),
        replace(problem, limits=replace(problem.limits, polygon=problem.limits.polygon + 1e-15)),
        replace(problem, joint_speed=problem.joint_speed.map(lambda speed: speed * (1 + 1e-15))),
        replace(problem, table=type(problem.table).of(fes_mj.load_moments("p1p3"))),
    ]
    assert digest(problem_of("d1")) == digest(problem)
    assert len({digest(problem), *map(digest, others)}) == len(others) + 1


def of_run(mark: str) -> list[str]:
    """Processes that a marked command started and that are still there."""
    commands = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if f"{MARK}={mark}".encode() in (process / "environ").read_bytes():
                commands.append((process / "cmdline").read_text())
        except OSError:
            continue
    return commands


@pytest.mark.process
@pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="looks into /proc to see what is left")
def test_kills_at_random_change_nothing(tmp_path: Path) -> None:
    """The end is the same to the last bit, every file in between is whole, and no process is left."""
    pytest.importorskip("joblib")
    command = [sys.executable, "-m", "fes_mj", "optimize", "cdt", "--start", "d2", "--speeds-of", "d2", "--json"]
    command += ["--budget", "3000", "--searches", "4", "--seed", "3", "-o", "best.toml", "--jobs"]
    quiet, killed, at = tmp_path / "undisturbed", tmp_path / "killed", random.Random(0)
    quiet.mkdir()
    killed.mkdir()
    begin = time.monotonic()
    undisturbed = subprocess.run([*command, "2"], cwd=quiet, check=True, capture_output=True)
    duration = time.monotonic() - begin
    kills, seen = 0, 0
    while kills < 4 or not seen:
        mark, again = f"{tmp_path}-{kills}", [*command, at.choice("12")]
        with subprocess.Popen(
            again, cwd=killed, env=os.environ | {MARK: mark}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        ) as process:
            try:
                process.wait(at.uniform(0, duration))
            except subprocess.TimeoutExpired:
                process.send_signal(at.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT]))
                kills += 1
        begin = time.monotonic()
        while left := of_run(mark):
            assert time.monotonic() - begin < 10, left
            time.sleep(0.05)
        if (best := killed / "best.toml").exists():
            seen += 1
            assert fes_mj.quasi_static(fes_mj.load_design(best), fes_mj.load_moments("p1p2")).power_mean > 0
    resumed = subprocess.run([*command, "1"], cwd=killed, check=True, capture_output=True)
    assert resumed.stdout == undisturbed.stdout
    assert contents(killed) == contents(quiet)
