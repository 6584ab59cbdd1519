"""Beside MuJoCo: what a reader makes of a model, and whether that is what it can be held to."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.simulation.stepping import energy
from tools.conformance.motions import MOTIONS, Job, Key
from tools.conformance.readers import READERS, Answer, Reader

ENERGY_LIMIT, GAP_LIMIT = 0.005, 1e-5  # of the start energy; m


@dataclass(frozen=True)
class Motion:
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
    error = float(np.max([abs(got[joint] - right[joint]) for joint in right]))  # NaN is not left out
    drift, gap = math.nan, math.nan
    if answer.get("states"):
        model = mujoco.MjModel.from_xml_path(task["model"])
        start = [*zip(*task["joints"].values(), strict=True)]
        energies, gap = _measured(model, [start, *answer["states"]])
        expected_energies, _ = _measured(model, [start, *expected["states"]])
        # the road takes energy; otherwise there is as much as at the start
        due = expected_energies.sum(axis=1) if motion == "ride" else expected_energies[0].sum()
        drift = float(
            np.abs(energies.sum(axis=1) - due).max() / (expected_energies[0].sum() - expected_energies[:, 0].min())
        )
    return Motion(answer.get("free", -1), error, reader.acceleration(expected), drift, gap, bool(task["samples"]))


def _measured(model: mujoco.MjModel, states: Iterable[Any]) -> tuple[FloatArray, float]:
    """Potential and kinetic energy (J) of states, shape (states, 2), and the largest gap of a loop (m)."""
    data, energies, gaps = mujoco.MjData(model), [], list[float]()
    names = [name for name in (model.sensor(i).name for i in range(model.nsensor)) if name.endswith("_gap")]
    for data.qpos, data.qvel in states:
        energies.append(energy(model, data))
        mujoco.mj_forward(model, data)
        gaps += (float(np.linalg.norm(data.sensor(name).data)) for name in names)
    return np.array(energies), float(np.max(gaps))
