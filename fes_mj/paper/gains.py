"""How much of each gain is real: at equal joint speed, with a torque-velocity relation, and how smooth the power is."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from fes_mj.arrays import FloatArray
from fes_mj.design import TRICYCLE_SPEED
from fes_mj.moments import GROUPS
from fes_mj.paper.printed import SIX_BARS, table1
from fes_mj.paper.runs import Runs, joint_speed
from fes_mj.statics import QuasiStatic, quasi_static, ratio_sd
from fes_mj.table import Table
from fes_mj.torque_velocity import TorqueVelocity, load_torque_velocity

TRICYCLE_MASS = 15.0  # kg, assumption: a light recumbent tricycle


def speed_table(runs: Runs) -> Table:
    """Gain over the TRT as the paper has it, at the TRT's mean knee speed, and with Hill's relation."""
    rows = []
    for name in SIX_BARS:
        for group in GROUPS:
            result, trt = runs.static[name, group], runs.static["trt", group]
            slowed = at_knee_speed(result, joint_speed(trt, "knee")[0])
            hill = runs.hill[name, group]
            speed = joint_speed(result, "knee")[0] / joint_speed(trt, "knee")[0]
            gains = [
                _gain(other, base) for other, base in ((result, trt), (slowed, trt), (hill, runs.hill["trt", group]))
            ]
            rows.append((name.upper(), group, speed, *gains, f"{hill.power_mean:.1f} +- {hill.power_sd:.1f}"))
    columns = {
        "design": "",
        "group": "",
        "knee speed per TRT's": ".2f",
        "gain, speed-free (paper)": "",
        "gain at equal mean knee speed": "",
        "gain with Hill": "",
        "power with Hill, W": "",
    }
    note = (
        "Gain is mean power per the TRT's under the same assumption. At equal mean knee speed the six-bar is geared "
        "down until its knee moves as fast as the TRT's on average. Hill: data/torque_velocity.toml; the relation is 1 "
        "at the speed the joint had in the TRT, so the TRT keeps its power. The standard deviations are those of the "
        "recovered moments only, not of Hill's parameters; for these see below."
    )
    return Table("Gains and joint speed", columns, rows, note)


def hill_table(runs: Runs) -> Table:
    """Gain with Hill's relation under other parameters."""
    hill = load_torque_velocity("hill")
    faster = {joint: 2 * speed for joint, speed in hill.max_speed.items()}
    slower = {joint: speed / 2 for joint, speed in hill.max_speed.items()}
    cases = {
        "as shipped": hill,
        "muscles twice as fast": replace(hill, max_speed=faster),
        "muscles half as fast": replace(hill, max_speed=slower),
        "curvature 0.5 (flatter)": replace(hill, curvature=0.5),
        "curvature 0.15": replace(hill, curvature=0.15),
        "eccentric plateau 1.1": replace(hill, eccentric_plateau=1.1),
        "eccentric plateau 1.8": replace(hill, eccentric_plateau=1.8),
    }
    rows = [(title, *_hill_gains(runs, relation)) for title, relation in cases.items()]
    columns = {"Hill's parameters": "", **{f"{name.upper()} {g}": ".2f" for name in SIX_BARS for g in GROUPS}}
    return Table("Gain over the TRT with other parameters of Hill's relation", columns, rows)


def smoothness_table(runs: Runs) -> Table:
    """Swing of the crank power: muscles alone, segment masses alone, both; one leg and two."""
    rows = []
    for (name, group, legs), case in runs.dynamic.items():
        run = case.simulation
        muscle = case.reference_power(mass_scale=0.0)
        masses = case.reference_power() - muscle
        energy = [energy_swing(power, run.cadence) for power in (muscle, run.power)]
        work = 2 * np.pi * muscle.mean() / run.cadence
        inertia = (run.design.rider.mass + TRICYCLE_MASS) * TRICYCLE_SPEED**2
        swings = [float(np.ptp(power)) for power in (muscle, masses, run.power)]
        rows.append(
            (name.upper(), group, str(legs), *swings, *(value / work for value in energy), 100 * energy[1] / inertia)
        )
    columns = {
        "design": "",
        "group": "",
        "legs": "",
        "muscles, W p-p": ".0f",
        "masses and weight, W p-p": ".0f",
        "both, W p-p": ".0f",
        "energy fluctuation: muscles": ".2f",
        "both": ".2f",
        "speed fluctuation, %": ".1f",
    }
    note = (
        "Crank power of all legs at constant cadence, peak to peak: of the joint moments alone, of segment masses and "
        "weight alone, and MuJoCo's of both. Energy fluctuation: coefficient of fluctuation of energy, the swing of "
        "the crank's energy against a constant load per work of a turn. Speed fluctuation: the same swing, of both, "
        f"per twice the kinetic energy of rider and tricycle ({TRICYCLE_MASS:g} kg) at 5.71 km/h, the coefficient of "
        "fluctuation of speed of a fixed drive."
    )
    return Table("How smooth the power is", columns, rows, note)


def at_knee_speed(result: QuasiStatic, mean_speed: float) -> QuasiStatic:
    """The same design geared so that its knee moves at this mean absolute speed (rad/s)."""
    factor = mean_speed / joint_speed(result, "knee")[0]
    return quasi_static(result.design, result.moments, factor * result.cadence)


def energy_swing(power: FloatArray, cadence: float) -> float:
    """Largest less smallest energy stored over the turn, J, when the load takes the mean of `power` (whole turns)."""
    seconds = 2 * np.pi / cadence / len(power)
    return float(np.ptp(np.cumsum(power - power.mean()))) * seconds


def _gain(result: QuasiStatic, base: QuasiStatic) -> str:
    return f"{result.power_mean / base.power_mean:.2f} +- {ratio_sd(result, base):.2f}"


def _hill_gains(runs: Runs, relation: TorqueVelocity) -> list[Any]:
    powers = {}
    for name in table1():
        for group in GROUPS:
            static = runs.static[name, group]
            moments = replace(static.moments, torque_velocity=relation)
            powers[name, group] = quasi_static(static.design, moments, static.cadence, points=720).power_mean
    return [powers[name, group] / powers["trt", group] for name in SIX_BARS for group in GROUPS]
