"""How much of each gain is real: at equal joint speed, how smooth the power is, what was held."""

from itertools import product

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.units import work_per_turn
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DIMENSIONS, SIX_BARS, load_design
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.linkage.variables import LENGTHS, lengths, with_lengths
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS, JointMoments
from fes_mj.moments.uncertainty import with_sd
from fes_mj.paper.captions import Rows, table
from fes_mj.paper.runs import Runs, joint_speed
from fes_mj.riding.ride import Ride, Road, steady_ripple
from fes_mj.statics.characteristics import energy_swing
from fes_mj.statics.cycles import cycles
from fes_mj.statics.turn import QuasiStatic, quasi_static, ratio_sd
from fes_mj.statics.work_table import uncertain_table

TRICYCLE_MASS = 15.0  # kg, assumption: a light recumbent tricycle
# Each design with the group that it was made for (Section 7; docs/errata.md, E14).
MADE_FOR = {"r1": "p1p2", "r2": "p1p3", "d1": "p1p2", "d2": "p1p3"}
HELD = ("gear ratio", "knee speed")
STEP = 1e-4  # m, either way; the identified R2 is 0.6 mm from where it cannot turn
_POINTS = 720
_CM = 100.0  # in a metre


@table("speed")
def knee_speed_table(runs: Runs) -> Rows:
    """Gain over the TRT as the paper has it, and at the TRT's mean knee speed."""
    for name, group in product(SIX_BARS, RIDER_GROUPS):
        result, trt = runs.static[name, group], runs.static["trt", group]
        knee_speed = joint_speed(trt, "knee")[0]
        geared = (result, at_knee_speed(result, knee_speed))
        gains = (with_sd(turn.power_mean / trt.power_mean, ratio_sd(turn, trt)) for turn in geared)
        speed = joint_speed(result, "knee")[0] / knee_speed
        yield name.upper(), group, speed, *gains


@table("smoothness", mass=f"{TRICYCLE_MASS:g}")
def smoothness_table(runs: Runs) -> Rows:
    """Swing of the crank power: muscles alone, segment masses alone, both; one leg and two."""
    for (name, group, legs), case in runs.dynamic.items():
        run = case.simulation
        muscle = case.reference_power(mass_scale=0.0)
        masses = case.reference_power() - muscle
        energy = [energy_swing(power, run.cadence) for power in (muscle, run.power)]
        work = work_per_turn(muscle.mean(), run.cadence)
        ride = Ride(
            run.design, runs.static[name, group].moments, Road(tricycle_mass=TRICYCLE_MASS, rolling_mass=0.0), "fixed"
        )
        ripple = 100 * steady_ripple(ride) if legs == len(TWO_LEGS) else None
        swings = [float(np.ptp(power)) for power in (muscle, masses, run.power)]
        yield name.upper(), group, str(legs), *swings, *(value / work for value in energy), ripple


def at_knee_speed(result: QuasiStatic, mean_speed: float) -> QuasiStatic:
    """The same design geared so that its knee moves at this mean absolute speed (rad/s)."""
    factor = mean_speed / joint_speed(result, "knee")[0]
    return quasi_static(result.design, result.moments, factor * result.cadence)


def slopes(design: Design, moments: JointMoments) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Change of mean power per length, W/cm, and its standard deviation, shape (9,) each, by what of HELD is held.

    Held knee speed: the gear ratio is such that the knee moves as fast on average as in the design itself. NaN where a
    linkage does not turn.
    """
    shifts = STEP * np.concatenate([np.zeros((9, 1)), np.eye(9), -np.eye(9)], axis=1)
    turn = cycles(
        with_lengths(design, (lengths(design)[:, None] + shifts)[..., None]), uncertain_table(moments), _POINTS
    )
    power = turn.power(design.linkage.cadence)
    slowed = power * (turn.joints.knee.travel[0] / turn.joints.knee.travel)[:, None]
    by_held = {}
    for held, values in zip(HELD, (power, slowed), strict=True):
        slope = (values[1:10] - values[10:]) / (2 * STEP * _CM)
        by_held[held] = (slope[:, 0], np.sqrt(np.einsum("ls,ls->l", slope[:, 1:], slope[:, 1:])))
    return by_held


@table("stationarity", length=LENGTHS)
def stationarity_table() -> Rows:
    """What the paper's search held: slopes of every six-bar with the group that it was made for."""
    for (name, group), dims in product(MADE_FOR.items(), DIMENSIONS):
        for held, (slope, deviation) in slopes(load_design(name, dims), load_moments(group)).items():
            pairs = zip(slope, deviation, strict=True)
            cells = [None if np.isnan(value) else with_sd(value, sd, 1) for value, sd in pairs]
            farthest = None if np.isnan(slope).any() else float(np.max(np.abs(slope) / deviation))
            yield name.upper(), group, dims, held, *cells, farthest
