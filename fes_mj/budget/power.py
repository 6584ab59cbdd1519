"""Mean crank power as a function of what is not known: one realisation of each unknown a row."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fes_mj.budget.unknowns import DIMENSIONS, EXTRAPOLATION, MOMENTS, RIDER, ZONES, Realisations, realisations
from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.assembly import SCAN
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.turning import batch_turning, leg_reach
from fes_mj.linkage.variables import replaced
from fes_mj.moments.fourier import fourier
from fes_mj.statics.extrapolation import zone_powers
from fes_mj.statics.turn import QuasiStatic

# Over the angles of SCAN; against twenty times as many a power changes by less than 0.02 W rms.
TABLE = 360  # crank angles of the measurement, between which moments are interpolated linearly
ROW_BLOCK = 1000  # rows at once: their arrays take some ten megabytes
_TURN = np.arange(TABLE) * (2 * np.pi / TABLE)
_TERMS = fourier(_TURN).T

RealisationRows = Mapping[str, IntArray]  # by unknown which realisation; one that is missing is as it is known best


@dataclass(frozen=True, eq=False)
class UncertainPower:
    """Mean power of one leg with what is not known of it: `count` realisations of every unknown.

    result: with all as it is known best.
    """

    result: QuasiStatic
    count: int

    @cached_property
    def drawn(self) -> Realisations:
        """Realisations of every unknown."""
        return realisations(self.result.design, self.result.moments, self.count)

    def at(self, rows: RealisationRows) -> FloatArray:
        """Power of each row of realisations, W, shape (rows,); NaN where the linkage does not turn."""
        count = len(next(iter(rows.values())))
        blocks = [slice(start, start + ROW_BLOCK) for start in range(0, count, ROW_BLOCK)]
        cases = [{name: numbers[block] for name, numbers in rows.items()} for block in blocks]
        return np.concatenate([self._block(case) for case in cases])

    def _block(self, rows: RealisationRows) -> FloatArray:
        motion = kinematics.solve(self._design(rows), SCAN)
        reach, swing = leg_reach(motion.design, motion.points["pedal"].value), np.ptp(motion.joint_angle.hip, axis=-1)
        turns = batch_turning(motion.design, reach, np.atleast_1d(swing)).turns  # as every command decides
        count = len(next(iter(rows.values())))
        return np.where(turns, np.broadcast_to(self._mean(motion, rows), count), np.nan)

    def _design(self, rows: RealisationRows) -> Design:
        parts = ((DIMENSIONS, self.drawn.dimensions), (RIDER, self.drawn.legs))
        values = {name: drawn[rows[key], None] for key, part in parts if key in rows for name, drawn in part.items()}
        return replaced(self.result.design, values)

    def _mean(self, motion: Motion, rows: RealisationRows) -> FloatArray:
        """Mean power along a motion, W, shape (rows,) or (1,)."""
        torque, cadence, drawn = self.result.torque, self.result.cadence, self.drawn
        best = np.concatenate([*self.result.moments.coefficients])[None]
        coefficients = drawn.coefficients[rows[MOMENTS]] if MOMENTS in rows else best
        drifts = drawn.drifts[rows[EXTRAPOLATION]] if EXTRAPOLATION in rows else np.zeros(ZONES)
        power = cadence * np.einsum("...z,...z->...", np.atleast_2d(zone_powers(motion, torque)), drifts)
        angles, rates = motion.joint_angle, motion.joint_rate
        for joint, terms in zip(JOINTS, np.split(coefficients, 2, axis=-1), strict=True):
            rate = rates[joint]
            moment = _read(terms @ _TERMS, torque.source_angle(joint, angles[joint], rate))
            power = power + cadence * np.einsum("...a,...a->...", moment, rate) / rate.shape[-1]
        return np.asarray(power)


def _read(table: FloatArray, source: FloatArray) -> FloatArray:
    """Tables over a turn, shape (rows or 1, TABLE), at crank angles, rad, shape (rows, angles) or (angles,)."""
    position = np.mod(np.nan_to_num(source), 2 * np.pi) * (TABLE / (2 * np.pi))
    index = position.astype(np.int64)
    part = position - index
    row = np.arange(len(table))[:, None]
    here, there = table[row, index % TABLE], table[row, (index + 1) % TABLE]
    return here + part * (there - here)
