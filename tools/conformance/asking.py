"""Running the readers: each in an environment of its own, its answers judged beside MuJoCo's."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from tools.conformance.judging import Row, judge
from tools.conformance.motions import Job, Key
from tools.conformance.readers import READERS, Answer, Reader

ROOT = Path(__file__).parents[2]
SCRIPTS, ENVIRONMENTS = ROOT / "tools" / "readers", ROOT / ".readers"
HERE = {"mujoco": "mujoco", "mjx": "jax"}  # readers in the environment of the project itself, and what tells


def interpreter(name: str) -> Path | None:
    """The interpreter that has a reader: this one, or that of the environment which was made for it, if it was."""
    if name in HERE:
        return Path(sys.executable) if find_spec(HERE[name]) else None
    python = ENVIRONMENTS / name / "bin" / "python"
    return python if python.exists() else None


def ask(script: str, python: Path | str, tasks: list[dict[str, Any]]) -> dict[str, Any]:
    """Run one reader script over the jobs. Raises RuntimeError with the end of its output if it breaks down."""
    with tempfile.TemporaryDirectory() as folder:
        question, answer = Path(folder) / "jobs.json", Path(folder) / "answers.json"
        question.write_text(json.dumps(tasks))
        process = subprocess.run(
            [python, SCRIPTS / f"{script}_reader.py", question, answer], capture_output=True, text=True
        )
        if not answer.exists():
            raise RuntimeError(f"{script}: the reader broke down:\n{process.stderr[-1000:]}")
        return dict(json.loads(answer.read_text()))


def reference(tasks: dict[Key, Job]) -> dict[Key, Answer]:
    """MuJoCo's answers, with what the limits are made of."""
    answers = dict(zip(tasks, ask("mujoco", sys.executable, [*tasks.values()])["answers"], strict=True))
    for (name, _, motion), answer in answers.items():
        if motion != "default":
            step = tasks[name, "sites", motion]["timestep"]
            answer["stiffness"] = 1 / (2 * step) ** 2  # 1/s^2: MuJoCo's loops settle in two steps
    return answers


def rows(name: str, tasks: dict[Key, Job], references: dict[Key, Answer]) -> list[Row]:
    """Ask a reader and judge its answers."""
    python, reader = interpreter(name), READERS[name]
    if python is None:
        raise RuntimeError(f"{name}: not installed; `python -m tools.conformance.build {name}` does")
    if reader.most:
        tasks = {key: _shortened(task, reader.most) for key, task in tasks.items()}
        references = reference(tasks)
    asked = {}
    for (design, anchors, motion), task in tasks.items():
        if motion == "default" or anchors == reader.anchors:
            asked[design, anchors, motion] = _finer(task | ({"samples": []} if motion in reader.still else {}), reader)
        elif motion == "one leg":  # what it need not move it only loads
            asked[design, anchors, motion] = {"model": task["model"]}
    reply = ask(name, python, [*asked.values()])
    answers = dict(zip(asked, reply["answers"], strict=True))
    designs = dict.fromkeys(design for design, *_ in tasks)
    return [judge(name, reply["version"], design, answers, asked, references) for design in designs]


def _shortened(task: Job, most: int) -> Job:
    """The task with its first sample only, after at most so many steps."""
    return task | {"samples": [min(count, most) for count in task["samples"][:1]]} if "samples" in task else task


def _finer(task: Job, reader: Reader) -> Job:
    """The task with its time steps cut into the reader's parts."""
    if "samples" not in task:
        return task
    return task | {
        "timestep": task["timestep"] / reader.parts,
        "samples": [reader.parts * count for count in task["samples"]],
    }
