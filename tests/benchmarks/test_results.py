"""What the benchmarks left: every module's result, with its command and commit, and rows that still name a command."""

import json
import re
import runpy
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from fes_mj.cli.app import app

ROOT = Path(__file__).parents[2]
MODULES = {path.stem for path in (ROOT / "benchmarks").glob("*.py")} - {"__init__"}
RESULTS = {path.stem: json.loads(path.read_text()) for path in (ROOT / "results" / "benchmarks").glob("*.json")}


def test_every_benchmark_is_run_and_has_a_result() -> None:
    assert RESULTS.keys() == MODULES
    recipe = (ROOT / "Makefile").read_text().partition("\nbenchmark:")[2].partition("\n\n")[0]
    assert set(re.search(r"for name in ([\w ]+);", recipe)[1].split()) == MODULES


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_names_its_command_and_the_commit_it_was_measured_at(name: str) -> None:
    provenance: dict[str, Any] = RESULTS[name]["provenance"]
    assert provenance["command"] == f"python -m benchmarks.{name}"
    assert re.fullmatch("[0-9a-f]{12}", provenance["commit"])


def git(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False)


@pytest.mark.process
@pytest.mark.skipif(shutil.which("git") is None, reason="git is not here")
@pytest.mark.parametrize("name", RESULTS)
def test_a_result_was_measured_at_a_commit_of_this_history(name: str) -> None:
    root, _, shallow = git("rev-parse", "--show-toplevel", "--is-shallow-repository").stdout.strip().rpartition("\n")
    if root != str(ROOT) or shallow != "false":
        pytest.skip("not a checkout with its whole history")
    commit = RESULTS[name]["provenance"]["commit"]
    assert git("merge-base", "--is-ancestor", commit, "HEAD").returncode == 0, f"{commit} is no ancestor of HEAD"


@pytest.mark.parametrize("name", RESULTS)
def test_rows_of_commands_name_commands_that_exist(name: str) -> None:
    text = (ROOT / "results" / "benchmarks" / f"{name}.json").read_text()
    for command in re.findall(r'"fes_mj ([^"]+)":', text):
        app.parse_args(command.split(), exit_on_error=False, print_error=False)


def test_rows_of_start_are_what_is_measured() -> None:
    candidates = runpy.run_path(str(ROOT / "benchmarks" / "start.py"))["CANDIDATES"]
    assert {*RESULTS["start"]["starts_of_a_bare_interpreter"]} - {"the cross-check alone"} == {*candidates}
