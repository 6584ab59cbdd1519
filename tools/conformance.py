"""Which tools read the exported models, and how well: run every reader, compare with MuJoCo, write results/readers.*.

    python tools/conformance.py [--build] [READER ...]

A reader runs in its environment .readers/READER, which --build makes; without one it is left out, and the results are
only printed. Exit code 1 if a reader does not keep what it can be held to.
"""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import sys
import tempfile
import tomllib
import venv
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import Progress

from fes_mj.design import Design
from fes_mj.design_file import DESIGNS, load_design
from fes_mj.files import json_text, write_text
from fes_mj.provenance import provenance
from fes_mj.simulation.export import mjcf_text
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.simulation.variants import variant_options

ROOT = Path(__file__).parents[1]
SCRIPTS, ENVIRONMENTS, RESULTS = ROOT / "tools" / "readers", ROOT / ".readers", ROOT / "results"
# The motion compared: from the keyframe without drives, for so long; the models are those of these variants.
DURATION = 0.1  # s
MOTION = ("passive", "compatible")

Answer = dict[str, Any]


@dataclass(frozen=True)
class Reader:
    """A tool that reads MJCF, and what it can be held to.

    velocity_term: its loops know dJ/dt v; otherwise its accelerations are compared with MuJoCo's without that term.
    acceleration: limit in rad/s^2 from the reference answer. pedal: limit in m.
    """

    title: str
    anchors: str
    velocity_term: bool
    acceleration: Callable[[Answer], float]
    pedal: Callable[[Answer], float]
    reason: str
    requirements: tuple[str, ...] = ()  # where they are not an extra of this project


def _rounding(dtype: type[np.floating[Any]]) -> Callable[[Answer], float]:
    """The four rounded coordinates of a loop, near 1 m, times its stiffness over the length of the crank."""
    return lambda reference: 4 * float(np.finfo(dtype).eps) * reference["stiffness"] / reference["crank"]


def _softness(factor: float) -> Callable[[Answer], float]:
    return lambda reference: factor * float(reference["softness_change"])


def _steps(reference: Answer) -> float:
    """Two integrators of first order: each errs by about twice the change from half the step."""
    return 4 * float(reference["step_change"])


READERS = {
    "mujoco": Reader(
        "MuJoCo", "sites", True, lambda _: 0.0, lambda _: 0.0, "the reference: another process must find the very same"
    ),
    "mjx": Reader(
        "MJX",
        "sites",
        False,
        _rounding(np.float64),
        _steps,
        "loops without dJ/dt v, otherwise MuJoCo's equations in double precision; no `discrete` integrator",
    ),
    "warp": Reader(
        "MuJoCo Warp",
        "sites",
        False,
        _rounding(np.float32),
        _steps,
        "loops without dJ/dt v; single precision, whose rounding the stiff loops turn into accelerations",
    ),
    "pinocchio": Reader(
        "Pinocchio",
        "sites",
        True,
        _softness(2),
        _steps,
        "rigid loops, where MuJoCo's give way a little; it has no simulator",
    ),
    "drake": Reader(
        "Drake",
        "bodies",
        False,
        _softness(10),
        _steps,
        "loops that hold the velocity of the next step, softer than MuJoCo's; it drops loops anchored at sites",
    ),
    "dm_control": Reader(
        "dm_control",
        "sites",
        True,
        _rounding(np.float64),
        lambda _: 1e-9,
        "the same engine, but it needs MuJoCo below 4",
        ("dm-control==1.0.50", "mujoco==3.17.0"),
    ),
}


@dataclass(frozen=True)
class Row:
    """What one reader made of one design; errors and limits in rad/s^2 and m."""

    reader: str
    version: str
    design: str
    default_model: str  # "loads", or why not
    loops_at_sites: int
    loops_on_bodies: int
    loops: int  # in the model
    free: int  # degrees of freedom left by the loops
    acceleration_error: float
    acceleration_limit: float
    largest_acceleration: float
    pedal_error: float
    pedal_limit: float
    drops: tuple[str, ...]

    @property
    def ok(self) -> bool:
        kept = max(self.loops_at_sites, self.loops_on_bodies) == self.loops and self.free == 1
        within = self.acceleration_error <= self.acceleration_limit and self.pedal_error <= self.pedal_limit
        return kept and within  # NaN is not


def interpreter(name: str) -> Path | None:
    """The interpreter of a reader's environment, if that was made; MuJoCo is in this one."""
    if name == "mujoco":
        return Path(sys.executable)
    python = ENVIRONMENTS / name / "bin" / "python"
    return python if python.exists() else None


def build(name: str) -> None:
    """Make a reader's environment and install the reader in it; on any failure there is no environment."""
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    reader = READERS[name]
    requirements = [*reader.requirements] or [*extras[name], "-c", str(ROOT / "constraints.txt")]
    try:
        venv.create(ENVIRONMENTS / name, with_pip=True, clear=True)
        subprocess.run([ENVIRONMENTS / name / "bin" / "pip", "install", "--quiet", *requirements], check=True)
    except BaseException:
        shutil.rmtree(ENVIRONMENTS / name, ignore_errors=True)
        raise


def jobs(designs: Iterable[Design], folder: Path) -> list[dict[str, Any]]:
    """Write the models into a folder; three jobs a design: loops at sites, loops on bodies, the default model."""
    tasks: list[dict[str, Any]] = []
    for design in designs:
        for anchors in ("sites", "bodies"):
            path, options = folder / f"{design.name}_{anchors}.xml", variant_options([anchors, *MOTION])
            path.write_text(mjcf_text(build_mjcf(design, **options)), encoding="utf-8")
            model = build_mjcf(design, **options).compile()
            names = [model.joint(number).name for number in range(model.njnt)]
            start = zip(names, model.key_qpos[0].tolist(), model.key_qvel[0].tolist(), strict=True)
            tasks.append(
                {
                    "anchors": anchors,
                    "model": str(path),
                    "joints": {joint: state for joint, *state in start},
                    "timestep": model.opt.timestep,
                    "steps": round(DURATION / model.opt.timestep),
                    "pedal": model.site("shank_pedal").pos.tolist(),
                }
            )
        path = folder / f"{design.name}.xml"
        path.write_text(mjcf_text(build_mjcf(design)), encoding="utf-8")
        tasks.append({"model": str(path)})
    return tasks


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


def reference(designs: list[Design], tasks: list[dict[str, Any]]) -> list[Answer]:
    """MuJoCo's answers, with what the limits are made of."""
    answers = ask("mujoco", sys.executable, tasks)["answers"]
    for number, (task, answer) in enumerate(zip(tasks, answers, strict=True)):
        if "steps" in task:
            answer["stiffness"] = 1 / (2 * task["timestep"]) ** 2  # 1/s^2: MuJoCo's loops settle in two steps
            answer["crank"] = designs[number // 3].linkage.crank
    return list(answers)


def rows(name: str, designs: list[Design], tasks: list[dict[str, Any]], references: list[Answer]) -> list[Row]:
    """Ask a reader and judge its answers."""
    python = interpreter(name)
    if python is None:
        raise RuntimeError(f"{name}: not installed; `python tools/conformance.py --build {name}` does")
    # what it need not move it only loads
    anchors = READERS[name].anchors
    told = ask(name, python, [task if task.get("anchors") == anchors else {"model": task["model"]} for task in tasks])
    groups = [slice(3 * number, 3 * number + 3) for number in range(len(designs))]
    return [
        judge(name, told["version"], design.name, told["answers"][group], references[group])
        for design, group in zip(designs, groups, strict=True)
    ]


def judge(name: str, version: str, design: str, answers: list[Answer], references: list[Answer]) -> Row:
    """Compare a reader's answers on a design (at sites, on bodies, default model) with MuJoCo's."""
    reader = READERS[name]
    number = ("sites", "bodies").index(reader.anchors)
    answer, expected, default = answers[number], references[number], answers[2]
    right = expected["acceleration" if reader.velocity_term else "without_velocity_term"]
    got = answer.get("acceleration", dict.fromkeys(right, math.nan))
    # a reader that refuses the default model is asked what it drops of the other
    keeps, whole = (default, references[2]) if "keeps" in default else (answer, expected)
    return Row(
        reader=name,
        version=version,
        design=design,
        default_model=default.get("error", "loads").rstrip("."),
        loops_at_sites=answers[0].get("loops", 0),
        loops_on_bodies=answers[1].get("loops", 0),
        loops=expected["loops"],
        free=answer.get("free", -1),
        acceleration_error=max(abs(got[joint] - right[joint]) for joint in right),
        acceleration_limit=reader.acceleration(expected),
        largest_acceleration=max(abs(value) for value in right.values()),
        pedal_error=math.dist(answer.get("pedal", (math.nan, math.nan)), expected["pedal"]),
        pedal_limit=reader.pedal(expected),
        drops=tuple(part for part, count in whole["keeps"].items() if keeps.get("keeps", {}).get(part, 0) < count),
    )


def table(found: list[Row]) -> str:
    """The rows in Markdown, one table of results and one of what the limits mean."""
    lines = [
        "| reader | design | default model | loops kept at sites / on bodies | free | acceleration error, rad/s² "
        "(limit; largest) | pedal error, mm (limit) | verdict |",
        "|---|---|---|---|---:|---:|---:|---|",
    ]
    for row in found:
        at_sites, on_bodies = f"{row.loops_at_sites} of {row.loops}", f"{row.loops_on_bodies} of {row.loops}"
        lines.append(
            f"| {READERS[row.reader].title} {row.version} | {row.design.upper()} | {row.default_model} "
            f"| {at_sites} / {on_bodies} | {row.free} "
            f"| {row.acceleration_error:.1e} ({row.acceleration_limit:.1e}; {row.largest_acceleration:.0f}) "
            f"| {1e3 * row.pedal_error:.1e} ({1e3 * row.pedal_limit:.1e}) | {'ok' if row.ok else '**FAILED**'} |"
        )
    lines += ["", "| reader | variant to use | what its limits allow for | drops |", "|---|---|---|---|"]
    for name in dict.fromkeys(row.reader for row in found):
        dropped = dict.fromkeys(part for row in found if row.reader == name for part in row.drops)
        reader = READERS[name]
        lines.append(f"| {reader.title} | {reader.anchors} | {reader.reason} | {', '.join(dropped) or 'nothing'} |")
    return "\n".join(lines) + "\n"


def main() -> int:
    arguments = [argument for argument in sys.argv[1:] if argument != "--build"]
    unknown = [argument for argument in arguments if argument not in READERS]
    if unknown:
        print(f"unknown reader {unknown[0]!r}; it must be one of {', '.join(READERS)}", file=sys.stderr)
        return 2
    chosen = arguments or [*READERS]
    designs, found = [load_design(name) for name in DESIGNS], list[Row]()
    console = Console(stderr=True)
    with tempfile.TemporaryDirectory() as folder, Progress(console=console, transient=True) as progress:
        tasks = jobs(designs, Path(folder))
        references = reference(designs, tasks)
        for name in progress.track(chosen, description="readers"):
            if "--build" in sys.argv and interpreter(name) is None:
                with suppress(subprocess.CalledProcessError):  # pip has said why
                    build(name)
            if interpreter(name) is None:
                console.print(f"{name}: not installed, left out; --build installs it where it can be had")
            else:
                found += rows(name, designs, tasks, references)
    print(table(found))
    if {row.reader for row in found} == {*READERS}:
        record = {"provenance": provenance(), "rows": [asdict(row) | {"ok": row.ok} for row in found]}
        write_text(RESULTS / "readers.json", json_text(record))
        write_text(RESULTS / "readers.md", _HEADING + table(found))
    return 0 if all(row.ok for row in found) else 1


_HEADING = f"""# Readers of the exported models

Written by `python tools/conformance.py` (`make readers`). Each reader loads the model that `fes_mj export` writes by
default, and the variants {" and ".join(MOTION)} with loops at sites and on bodies; the latter move for {DURATION} s
from the keyframe, undriven, under their weight. Compared with MuJoCo: joint accelerations at the start, the pedal at
the end. `free` counts the degrees of freedom that the loops leave; one is right.

"""


if __name__ == "__main__":
    sys.exit(main())
