"""What a design still does when it is not built, or not ridden, as designed: sampled within tolerances."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.variables import lengths, with_lengths
from fes_mj.statics.cycles import WorkTable, cycles

MANUFACTURING = 0.001  # m, each length and each coordinate of R1 and R7
LEG = 0.05  # m, thigh and shank independently
SAMPLES = 4000  # the 5th percentile of power is then known to about 1 % of the spread
PERCENTILE = 5.0


class Tolerance(NamedTuple):
    """Outcome of a sample: share of designs that can still turn, 5th percentile and median of their power, W.

    Those that cannot turn count as no power.
    """

    turning: float
    power_low: float
    power_median: float


def to_manufacturing(design: Design, table: WorkTable, random: np.random.Generator) -> Tolerance:
    """All lengths of the linkage off by up to MANUFACTURING, uniformly and independently."""
    drawn = lengths(design)
    # R7, R8, R9 and R10 do not exist in a TRT, and are zero in it
    real = drawn != 0 if design.linkage.kind == "trt" else np.ones(len(drawn), bool)
    shift = random.uniform(-MANUFACTURING, MANUFACTURING, (SAMPLES, len(drawn))) * real
    return _tolerance(with_lengths(design, (drawn + shift).T[..., None]), table)


def to_rider(design: Design, table: WorkTable, random: np.random.Generator) -> Tolerance:
    """Thigh and shank longer or shorter by up to LEG, uniformly and independently."""
    shift = random.uniform(-LEG, LEG, (2, SAMPLES, 1))
    rider = replace(design.rider, thigh=design.rider.thigh + shift[0], shank=design.rider.shank + shift[1])
    return _tolerance(replace(design, rider=rider), table)


def _tolerance(designs: Design, table: WorkTable) -> Tolerance:
    power: FloatArray = cycles(designs, table).work[:, 0] * designs.linkage.cadence / (2 * np.pi)
    turning = np.isfinite(power)
    powers = np.where(turning, power, 0.0)
    return Tolerance(float(turning.mean()), float(np.percentile(powers, PERCENTILE)), float(np.median(powers)))
