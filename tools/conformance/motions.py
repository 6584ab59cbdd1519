"""What the readers are asked: models and starts, written as jobs for their scripts."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from fes_mj.linkage.design import Design
from fes_mj.moments.files import load_moments
from fes_mj.simulation.export import mjcf_text
from fes_mj.simulation.variants import variant_model, variant_options

# Loops and accelerations at the start, the pedal of one leg after FIRST, energy and loops until HORIZON.
FIRST, HORIZON = 0.1, 2.0  # s
MOTIONS = {
    "one leg": ("passive", "compatible"),
    "two legs": ("passive", "compatible", "two-legs"),
    "ride": ("passive", "compatible", "ride", "fixed-gear"),
    "motors": ("free", "compatible"),
}
CONTROLS = {"hip": 10.0, "knee": -10.0}  # N m, of the motion `motors`
ANCHORS = ("sites", "bodies")

Key = tuple[str, str, str]  # design, anchors, motion
Job = dict[str, Any]


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
