"""Which tools read the exported models, and how well: run every reader, compare with MuJoCo, write results/readers.*.

    python -m tools.conformance [--build] [READER ...]

A reader runs in its environment .readers/READER, which --build makes; without one it is left out, and the results are
only printed. Exit code 1 if a reader does not keep what it can be held to.
"""

from __future__ import annotations

import itertools
import json
import math
import shutil
import subprocess
import sys
import tempfile
import tomllib
import venv
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
from rich.console import Console
from rich.progress import Progress

from fes_mj.arrays import FloatArray
from fes_mj.design import Design
from fes_mj.design_file import DESIGNS, load_design
from fes_mj.files import json_text, write_text
from fes_mj.moments_file import load_moments
from fes_mj.provenance import provenance
from fes_mj.simulation.export import mjcf_text
from fes_mj.simulation.stepping import energy
from fes_mj.simulation.variants import variant_model, variant_options
from tools.known_readers import READERS, Answer, Reader

ROOT = Path(__file__).parents[1]
SCRIPTS, ENVIRONMENTS, RESULTS = ROOT / "tools" / "readers", ROOT / ".readers", ROOT / "results"
# What the readers are asked: loops and accelerations at the start, the pedal of one leg after FIRST, energy and loops
# until HORIZON.
FIRST, HORIZON = 0.1, 2.0  # s
MOTIONS = {
    "one leg": ("passive", "compatible"),
    "two legs": ("passive", "compatible", "two-legs"),
    "ride": ("passive", "compatible", "ride", "fixed-gear"),
    "motors": ("free", "compatible"),
}
CONTROLS = {"hip": 10.0, "knee": -10.0}  # N m, of the motion `motors`
ENERGY_LIMIT, GAP_LIMIT = 0.005, 1e-5  # of the start energy; m
ANCHORS = ("sites", "bodies")

Key = tuple[str, str, str]  # design, anchors, motion
Job = dict[str, Any]


class Motion(NamedTuple):
    """What a reader made of one motion; NaN where it has nothing to show.

    free: degrees of freedom. acceleration: largest error at the start, rad/s^2, and its limit. energy: largest error
    per start energy until HORIZON. gap: largest opening of a loop, m. moved: whether it was asked to move.
    """

    free: int
    acceleration: float
    acceleration_limit: float
    energy: float
    gap: float
    moved: bool

    @property
    def ok(self) -> bool:
        still = self.free == 1 and self.acceleration <= self.acceleration_limit
        return still and (not self.moved or (self.energy <= ENERGY_LIMIT and self.gap <= GAP_LIMIT))


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
    largest_acceleration: float
    pedal_error: float
    pedal_limit: float
    drops: tuple[str, ...]
    motions: dict[str, Motion]  # but those that the reader does without

    @property
    def ok(self) -> bool:
        kept = max(self.loops_at_sites, self.loops_on_bodies) == self.loops
        within = self.pedal_error <= self.pedal_limit and all(motion.ok for motion in self.motions.values())
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


def jobs(designs: Iterable[Design], folder: Path) -> dict[Key, Job]:
    """Write the models into a folder: of a design each motion with loops at sites and on bodies, and the default."""
    tasks: dict[Key, Job] = {}
    for design in designs:
        for anchors, (motion, variants) in itertools.product(ANCHORS, MOTIONS.items()):
            spec = _model(design, anchors, *variants)
            path = folder / f"{design.name}_{anchors}_{motion.replace(' ', '_')}.xml"
            path.write_text(mjcf_text(spec), encoding="utf-8")
            tasks[design.name, anchors, motion] = {"model": str(path)} | _start(spec.compile(), motion)
        path = folder / f"{design.name}.xml"
        path.write_text(mjcf_text(_model(design)), encoding="utf-8")
        tasks[design.name, "sites", "default"] = {"model": str(path)}
    return tasks


def _model(design: Design, *variants: str) -> Any:
    return variant_model(design, load_moments(), design.linkage.cadence, variant_options(variants))


def _start(model: mujoco.MjModel, motion: str) -> Job:
    """Start, controls and samples of a motion."""
    names = [model.joint(number).name for number in range(model.njnt)]
    start = zip(names, model.key_qpos[0].tolist(), model.key_qvel[0].tolist(), strict=True)
    step = float(model.opt.timestep)
    times = np.arange(FIRST, HORIZON + FIRST / 2, FIRST)
    return {
        "joints": {joint: state for joint, *state in start},
        "timestep": step,
        "controls": CONTROLS if motion == "motors" else {},
        "samples": [] if motion == "motors" else [round(time / step) for time in times],
    } | ({"pedal": model.site("shank_pedal").pos.tolist()} if motion == "one leg" else {})


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
            answer["crank"] = load_design(name).linkage.crank
    return answers


def rows(name: str, tasks: dict[Key, Job], references: dict[Key, Answer]) -> list[Row]:
    """Ask a reader and judge its answers."""
    python, reader = interpreter(name), READERS[name]
    if python is None:
        raise RuntimeError(f"{name}: not installed; `python -m tools.conformance --build {name}` does")
    if reader.most:
        tasks = {key: _shortened(task, reader.most) for key, task in tasks.items()}
        references = reference(tasks)
    asked = {}
    for (design, anchors, motion), task in tasks.items():
        if motion == "default" or anchors == reader.anchors:
            asked[design, anchors, motion] = task | ({"samples": []} if motion in reader.still else {})
        elif motion == "one leg":  # what it need not move it only loads
            asked[design, anchors, motion] = {"model": task["model"]}
    told = ask(name, python, [*asked.values()])
    answers = dict(zip(asked, told["answers"], strict=True))
    designs = dict.fromkeys(design for design, *_ in tasks)
    return [judge(name, told["version"], design, answers, asked, references) for design in designs]


def _shortened(task: Job, most: int) -> Job:
    """The task with its first sample only, after at most so many steps."""
    return task | {"samples": [min(count, most) for count in task["samples"][:1]]} if "samples" in task else task


def judge(
    name: str,
    version: str,
    design: str,
    answers: dict[Key, Answer],
    tasks: dict[Key, Job],
    references: dict[Key, Answer],
) -> Row:
    """Compare a reader's answers on a design with MuJoCo's."""
    reader = READERS[name]
    key, default_key = (design, reader.anchors, "one leg"), (design, "sites", "default")
    answer, expected, default = answers[key], references[key], answers[default_key]
    # a reader that refuses the default model is asked what it drops of the other
    keeps, whole = (default, references[default_key]) if "keeps" in default else (answer, expected)
    motions = {
        motion: _motion(reader, motion, tasks[at], answers[at], references[at])
        for motion, at in ((motion, (design, reader.anchors, motion)) for motion in MOTIONS)
        if motion not in reader.without
    }
    return Row(
        reader=name,
        version=version,
        design=design,
        default_model=default.get("error", "loads").rstrip("."),
        loops_at_sites=answers[design, "sites", "one leg"].get("loops", 0),
        loops_on_bodies=answers[design, "bodies", "one leg"].get("loops", 0),
        loops=expected["loops"],
        largest_acceleration=max(abs(value) for value in expected["acceleration"].values()),
        pedal_error=math.dist(answer.get("pedal", (math.nan, math.nan)), expected["pedal"]),
        pedal_limit=reader.pedal(expected),
        drops=tuple(part for part, count in whole["keeps"].items() if keeps.get("keeps", {}).get(part, 0) < count),
        motions=motions,
    )


def _motion(reader: Reader, motion: str, task: Job, answer: Answer, expected: Answer) -> Motion:
    """A motion's start beside MuJoCo's, and by MuJoCo what becomes of its energy and its loops."""
    right = expected[reader.beside]
    got = answer.get("acceleration", dict.fromkeys(right, math.nan))
    error, drift, gap = max(abs(got[joint] - right[joint]) for joint in right), math.nan, math.nan
    if answer.get("states"):
        model = mujoco.MjModel.from_xml_path(task["model"])
        start = [*zip(*task["joints"].values(), strict=True)]
        energies, gap = _measured(model, [start, *answer["states"]])
        known, _ = _measured(model, [start, *expected["states"]])
        # the road takes energy; otherwise there is as much as at the start
        due = known.sum(axis=1) if motion == "ride" else known[0].sum()
        drift = float(np.abs(energies.sum(axis=1) - due).max() / (known[0].sum() - known[:, 0].min()))
    return Motion(answer.get("free", -1), error, reader.acceleration(expected), drift, gap, bool(task["samples"]))


def _measured(model: mujoco.MjModel, states: Iterable[Any]) -> tuple[FloatArray, float]:
    """Potential and kinetic energy (J) of states, shape (states, 2), and the largest gap of a loop (m)."""
    data, energies, gap = mujoco.MjData(model), [], 0.0
    names = [name for name in (model.sensor(i).name for i in range(model.nsensor)) if name.endswith("_gap")]
    for data.qpos, data.qvel in states:
        energies.append(energy(model, data))
        mujoco.mj_forward(model, data)
        gap = max(gap, *(float(np.linalg.norm(data.sensor(name).data)) for name in names))
    return np.array(energies), gap


def table(found: list[Row]) -> str:
    """The rows in Markdown: what is kept and how it moves, and what the limits mean."""
    lines = [
        "| reader | design | default model | loops kept at sites / on bodies | pedal error, mm (limit) "
        "| acceleration error (limit), rad/s²: " + " | ".join(MOTIONS) + " | verdict |",
        "|---|---|---|---|---:|" + "---:|" * len(MOTIONS) + "---|",
    ]
    for row in found:
        at_sites, on_bodies = f"{row.loops_at_sites} of {row.loops}", f"{row.loops_on_bodies} of {row.loops}"
        errors = (
            f"{motion.acceleration:.1e} ({motion.acceleration_limit:.1e})" if motion else "-"
            for motion in map(row.motions.get, MOTIONS)
        )
        lines.append(
            f"| {READERS[row.reader].title} {row.version} | {row.design.upper()} | {row.default_model} "
            f"| {at_sites} / {on_bodies} | {1e3 * row.pedal_error:.1e} ({1e3 * row.pedal_limit:.1e}) "
            f"| {' | '.join(errors)} | {'ok' if row.ok else '**FAILED**'} |"
        )
    moving = [motion for motion in MOTIONS if motion != "motors"]
    lines += [
        "",
        "| reader | design | energy error, % / loop gap, um: " + " | ".join(moving) + " |",
        "|---|---|" + "---:|" * len(moving),
    ]
    for row in found:
        cells = (
            f"{100 * motion.energy:.2g} / {1e6 * motion.gap:.2g}" if motion and motion.moved else "-"
            for motion in map(row.motions.get, moving)
        )
        lines.append(f"| {READERS[row.reader].title} | {row.design.upper()} | {' | '.join(cells)} |")
    lines += ["", "| reader | anchors | what its limits allow for | drops | does without |", "|---|---|---|---|---|"]
    for name in dict.fromkeys(row.reader for row in found):
        dropped = dict.fromkeys(part for row in found if row.reader == name for part in row.drops)
        reader = READERS[name]
        without = [
            *(f"{motion}: {why}" for motion, why in reader.without.items()),
            *(f"{motion}: only begun" for motion in reader.still),
            *([f"the horizon: {reader.most} steps a motion"] if reader.most else []),
        ]
        lines.append(
            f"| {reader.title} | {reader.anchors} | {reader.reason} | {', '.join(dropped) or 'nothing'} "
            f"| {'; '.join(without) or '-'} |"
        )
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
        references = reference(tasks)
        for name in progress.track(chosen, description="readers"):
            if "--build" in sys.argv and interpreter(name) is None:
                with suppress(subprocess.CalledProcessError):  # pip has said why
                    build(name)
            if interpreter(name) is None:
                console.print(f"{name}: not installed, left out; --build installs it where it can be had")
            else:
                found += rows(name, tasks, references)
    print(table(found))
    if {row.reader for row in found} == {*READERS}:
        record = {"provenance": provenance(), "rows": [asdict(row) | {"ok": row.ok} for row in found]}
        write_text(RESULTS / "readers.json", json_text(record))
        write_text(RESULTS / "readers.md", _HEADING + table(found))
    return 0 if all(row.ok for row in found) else 1


_HEADING = f"""# Readers of the exported models

Written by `python -m tools.conformance` (`make readers`). Each reader loads the model that `fes_mj export` writes by
default and, for readers without `discrete` (`compatible`), with loops at sites or on bodies: one leg and two that
nothing drives (`passive`), motors (`free`, with {CONTROLS["hip"]:g} N m at the hip and {CONTROLS["knee"]:g} at the
knee) and the road (`passive ride fixed-gear`). Compared with MuJoCo: joint accelerations at the start of each, the
pedal of one leg after {FIRST:g} s, and until {HORIZON:g} s energy (limit: {100 * ENERGY_LIMIT:g} % of the start energy)
and loops (limit: {1e6 * GAP_LIMIT:g} um). Every reader must be left with one degree of freedom.

"""


if __name__ == "__main__":
    sys.exit(main())
