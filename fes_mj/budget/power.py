"""Mean crank power as a function of what is not known: one realisation of each unknown a row."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fes_mj.budget.unknowns import (
    DIMENSIONS,
    EXTRAPOLATION,
    LAG,
    MOMENTS,
    RIDER,
    SPEED,
    ZONES,
    Realisations,
    realisations,
)
from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.assembly import SCAN
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.turning import batch_turning, leg_reach
from fes_mj.linkage.variables import replaced
from fes_mj.moments.drive import commanded
from fes_mj.moments.fourier import fourier
from fes_mj.statics.extrapolation import zone_powers
from fes_mj.statics.turn import QuasiStatic

# Over the angles of SCAN; against twenty times as many a power changes by less than 0.02 W rms, and with a lag, which
# filters the jumps of the torque map, by less than 0.2 W.
TABLE = 360  # crank angles of the measurement, between which moments are interpolated linearly
BLOCK = 1000  # rows at once: their arrays take some ten megabytes
_TURN = np.arange(TABLE) * (2 * np.pi / TABLE)
_TERMS = fourier(_TURN).T

Rows = Mapping[str, IntArray]  # by unknown which realisation; one that is missing is as it is known best


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

    def at(self, rows: Rows, *without: Collection[str]) -> FloatArray:
        """Power of each row of realisations, W; NaN where the linkage does not turn.

        without: unknowns, none of the linkage's or the rider's, that are as they are known best in a case of their own.
        Shape (1 + cases, rows).
        """
        count = len(next(iter(rows.values())))
        blocks = [slice(start, start + BLOCK) for start in range(0, count, BLOCK)]
        cases = [{name: numbers[block] for name, numbers in rows.items()} for block in blocks]
        return np.concatenate([self._block(case, without) for case in cases], axis=1)

    def _block(self, rows: Rows, without: Sequence[Collection[str]]) -> FloatArray:
        motion = kinematics.solve(self._design(rows), SCAN)
        reach, swing = leg_reach(motion.design, motion.points["pedal"].value), np.ptp(motion.joint_angle.hip, axis=-1)
        turns = batch_turning(motion.design, reach, np.atleast_1d(swing)).turns  # as every command decides
        count = len(next(iter(rows.values())))
        cases = [{name: numbers for name, numbers in rows.items() if name not in omitted} for omitted in ((), *without)]
        return np.where(turns, [np.broadcast_to(self._mean(motion, case), count) for case in cases], np.nan)

    def _design(self, rows: Rows) -> Design:
        parts = ((DIMENSIONS, self.drawn.dimensions), (RIDER, self.drawn.legs))
        values = {name: drawn[rows[key], None] for key, part in parts if key in rows for name, drawn in part.items()}
        return replaced(self.result.design, values)

    def _mean(self, motion: Motion, rows: Rows) -> FloatArray:
        """Mean power along a motion, W, shape (rows,) or (1,)."""
        torque, cadence, drawn = self.result.torque, self.result.cadence, self.drawn
        best = np.concatenate([*self.result.moments.coefficients])[None]
        coefficients = drawn.coefficients[rows[MOMENTS]] if MOMENTS in rows else best
        relation = drawn.relations.taken(rows[SPEED]) if SPEED in rows else self.result.moments.torque_velocity
        lag = drawn.lags[rows[LAG]] if LAG in rows else np.zeros((1, 1))
        drifts = drawn.drifts[rows[EXTRAPOLATION]] if EXTRAPOLATION in rows else np.zeros(ZONES)
        power = cadence * np.einsum("...z,...z->...", np.atleast_2d(zone_powers(motion, torque)), drifts)
        speeds, angles, rates = torque.reference.joint_rates(_TURN), motion.joint_angle, motion.joint_rate
        for joint, terms in zip(JOINTS, np.split(coefficients, 2, axis=-1), strict=True):
            rate, measured = rates[joint], torque.reference.cadence
            command = commanded(terms @ _TERMS, relation, joint, measured * speeds[joint], lag * measured)
            moment = _answer(_read(command, torque.source_angle(joint, angles[joint], rate)), lag, cadence, measured)
            if relation:
                moment = moment * relation.factor(joint, np.sign(moment) * cadence * rate)
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


def _answer(command: FloatArray, lag: FloatArray, cadence: float, measured: float) -> FloatArray:
    """What a muscle with a lag, s, makes of a periodic command that is timed ahead for the crank speed, rad/s."""
    if not lag.any():
        return command
    order = np.arange(command.shape[-1] // 2 + 1)
    ahead = np.atan(cadence * lag) - np.atan(measured * lag)
    transfer = np.exp(1j * order * ahead) / (1 + 1j * order * cadence * lag)
    return np.fft.irfft(np.fft.rfft(command) * transfer, command.shape[-1])
