"""Let exported models whose crank nothing holds move freely; write what becomes of their energy: results/energy.*.

    python -m studies.energy

Undriven, without friction, drag and brake, from their keyframes.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np

from fes_mj.common.console import track
from fes_mj.common.markdown import Table
from fes_mj.common.provenance import provenance
from fes_mj.common.units import RPM
from fes_mj.common.writing import json_text, write_text
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.simulation.mjcf import INTEGRATORS
from fes_mj.simulation.stepping import energy
from fes_mj.simulation.time_step import steps_per_turn
from fes_mj.simulation.variants import variant_model, variant_options

RESULTS = Path(__file__).parents[1] / "results"
DURATION = 5.0  # s
ENERGY_LIMIT, GAP_LIMIT = 0.005, 1e-5  # of the start energy; m
# What differs in motion. `free` is `passive` with motors, which are idle; `compatible` changes nothing here.
LOOSE = (
    ("passive",),
    ("passive", "two-legs"),
    ("passive", "brake"),
    ("passive", "brake", "two-legs"),
    ("passive", "ride"),
    ("passive", "ride", "fixed-gear"),
)


class Freely(NamedTuple):
    """A free motion. start: kinetic energy and potential energy above the lowest pose seen, J. change: largest, J."""

    start: float
    change: float
    gap: float  # largest opening of a loop, m
    timestep: float  # s
    turns: float
    fastest: float  # crank speed, rad/s

    @property
    def drift(self) -> float:
        """Change per start energy."""
        return self.change / self.start

    @property
    def ok(self) -> bool:
        return self.drift <= ENERGY_LIMIT and self.gap <= GAP_LIMIT  # NaN is not


def lossless(name: str, variants: tuple[str, ...]) -> mujoco.MjModel:
    """The exported model of a design without friction, drag and brake."""
    design = load_design(name)
    spec = variant_model(design, load_moments(), design.linkage.cadence, variant_options(variants))
    for joint in spec.joints:
        joint.damping, joint.frictionloss = (0.0, 0.0, 0.0), 0.0
    return spec.compile()


def move_freely(model: mujoco.MjModel, duration: float = DURATION) -> Freely:
    """Step a model from its keyframe with idle motors."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    crank, steps = data.joint("crank"), round(duration / model.opt.timestep)
    sensors = [model.sensor(i) for i in range(model.nsensor)]
    gaps = np.array([sensor.adr[0] + np.arange(3) for sensor in sensors if sensor.name.endswith("_gap")])
    energies, largest, fastest = [energy(model, data)], 0.0, abs(float(crank.qvel[0]))
    for step in range(1, steps + 1):
        mujoco.mj_step(model, data)
        largest = max(largest, float(np.linalg.norm(data.sensordata[gaps], axis=1).max()))
        if not step % 20:
            energies.append(energy(model, data))
            fastest = max(fastest, abs(float(crank.qvel[0])))
    potential, kinetic = np.array(energies).T
    total = potential + kinetic
    return Freely(
        start=float(kinetic[0] + potential[0] - potential.min()),
        change=float(np.abs(total - total[0]).max()),
        gap=largest,
        timestep=float(model.opt.timestep),
        turns=float(crank.qpos[0]) / (2 * np.pi),
        fastest=fastest,
    )


def row(name: str, variants: tuple[str, ...]) -> tuple[Any, ...]:
    """Of the table: the model as exported, and with each integrator at the step of a crank that is held."""
    model, design = lossless(name, variants), load_design(name)
    free = move_freely(model)
    if "ride" not in variants:
        model.opt.timestep = 2 * math.pi / design.linkage.cadence / steps_per_turn(design, design.linkage.cadence)
    others = []
    for integrator in INTEGRATORS.values():
        model.opt.integrator = integrator
        motion = move_freely(model)
        others.append(100 * motion.drift if motion.drift < 1 else None)  # nor where it is not a number
    described = (free.start, free.turns, free.fastest / RPM, 1e3 * free.timestep, 100 * free.drift, 1e6 * free.gap)
    return (name.upper(), " ".join(variants), *described, *others, "ok" if free.ok else "FAILED")


def main() -> int:
    cases = [(name, variants) for name in DESIGNS for variants in LOOSE]
    rows = [row(*case) for case in track(cases, "free motions")]
    table = Table("", COLUMNS, rows, NOTE)
    write_text(RESULTS / "energy.json", json_text({"provenance": provenance(), "rows": table.records()}))
    write_text(RESULTS / "energy.md", HEADING + table.markdown())
    return 0 if all(row[-1] == "ok" for row in rows) else 1


COLUMNS = {
    "design": "",
    "variants": "",
    "start energy, J": ".2f",
    "turns": ".1f",
    "fastest, rpm": ".0f",
    "time step, ms": ".3f",
    "drift, %": ".4f",
    "loop gap, um": ".2f",
    **{f"{name}, %": ".4f" for name in INTEGRATORS},
    "verdict": "",
}
HEADING = f"""# Energy of the exported models that move freely

Written by `python -m studies.energy`. Each model moves for {DURATION:g} s from its keyframe with idle motors, its
friction, drag and brake taken away. *Drift* is the largest change of its energy per start energy, which is counted
from the lowest pose; limits: {100 * ENERGY_LIMIT:g} % and {1e6 * GAP_LIMIT:g} um.

"""
NOTE = """The last columns show the drift with each of MuJoCo's integrators at the time step of a crank that is held (on
the road: at the model's own); `-` is more than the start energy, or not a number. With the freewheel (`ride`
without `fixed-gear`) drift holds what the crank really loses when it catches up with the wheel.
"""


if __name__ == "__main__":
    sys.exit(main())
