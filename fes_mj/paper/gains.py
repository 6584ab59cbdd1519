"""How much of each gain is real: at equal joint speed, with a torque-velocity relation, and how smooth the power is."""

from dataclasses import replace
from typing import Any

import numpy as np

from fes_mj.common.markdown import Table
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.moments.torque_velocity import TorqueVelocity, load_torque_velocity
from fes_mj.moments.uncertainty import with_sd
from fes_mj.paper.captions import captioned
from fes_mj.paper.printed import SIX_BARS, table1
from fes_mj.paper.runs import Runs, joint_speed
from fes_mj.riding.ride import Ride, Road, steady_ripple
from fes_mj.statics.characteristics import energy_swing
from fes_mj.statics.turn import QuasiStatic, quasi_static, ratio_sd

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
            rows.append((name.upper(), group, speed, *gains, with_sd(hill.power_mean, hill.power_sd, 1)))
    return captioned("speed", rows)


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
    gains = [f"{name.upper()} {group}" for name in SIX_BARS for group in GROUPS]
    return captioned("hill", rows, gain=gains)


def smoothness_table(runs: Runs) -> Table:
    """Swing of the crank power: muscles alone, segment masses alone, both; one leg and two."""
    rows = []
    for (name, group, legs), case in runs.dynamic.items():
        run = case.simulation
        muscle = case.reference_power(mass_scale=0.0)
        masses = case.reference_power() - muscle
        energy = [energy_swing(power, run.cadence) for power in (muscle, run.power)]
        work = 2 * np.pi * muscle.mean() / run.cadence
        ride = Ride(run.design, run.moments, Road(tricycle_mass=TRICYCLE_MASS, rolling_mass=0.0), "fixed")
        ripple = 100 * steady_ripple(ride) if legs == len(TWO_LEGS) else None
        swings = [float(np.ptp(power)) for power in (muscle, masses, run.power)]
        rows.append((name.upper(), group, str(legs), *swings, *(value / work for value in energy), ripple))
    return captioned("smoothness", rows, mass=f"{TRICYCLE_MASS:g}")


def at_knee_speed(result: QuasiStatic, mean_speed: float) -> QuasiStatic:
    """The same design geared so that its knee moves at this mean absolute speed (rad/s)."""
    factor = mean_speed / joint_speed(result, "knee")[0]
    return quasi_static(result.design, result.moments, factor * result.cadence)


def _gain(result: QuasiStatic, base: QuasiStatic) -> str:
    return with_sd(result.power_mean / base.power_mean, ratio_sd(result, base))


def _hill_gains(runs: Runs, relation: TorqueVelocity) -> list[Any]:
    powers = {}
    for name in table1():
        for group in GROUPS:
            static = runs.static[name, group]
            moments = replace(static.moments, torque_velocity=relation)
            powers[name, group] = quasi_static(static.design, moments, static.cadence, points=720).power_mean
    return [powers[name, group] / powers["trt", group] for name in SIX_BARS for group in GROUPS]
