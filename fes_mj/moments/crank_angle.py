"""The crank angle of a trial in which none was recorded: from the knee's angle, without an evenly turning crank."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.linkage.kinematics import solve
from fes_mj.moments.reference_tricycle import ReferenceTricycle

_KNOTS = 10  # of a turn
# Weight of the third difference of a knot's crank angles beside the samples of a knot: with it, a crank whose speed
# varies by 60 % within the turn is followed within 1.5 deg, and 1.5 deg of noise in the knee cost 0.3 % of the work.
_STIFFNESS = 3e-4
_STEPS = 10  # of Gauss and Newton
_LEAST_SWING = 0.5  # of the knee's whole range: smaller dips are noise
_EDGE = 0.05  # of a turn
_FINE = 20  # times a sample at which the dead centres are looked for


@dataclass(frozen=True, eq=False)
class TimedTurn:
    """A turn from one top dead centre to the next, s; angle: of the crank over the time of the trial, rad."""

    start: float
    end: float
    angle: Any  # a scipy BSpline
    number: int

    def holds(self, time: FloatArray) -> FloatArray:
        """Which times lie within."""
        return np.asarray((self.start <= time) & (time < self.end))

    def crank_angle(self, time: FloatArray) -> FloatArray:
        """From top dead centre, rad."""
        return np.asarray(self.angle(time) - 2 * np.pi * self.number)

    @property
    def speed(self) -> tuple[float, float]:
        """Smallest and largest crank speed within the turn per its mean."""
        steps = np.diff(self.angle(np.linspace(self.start, self.end, 361)))
        return float(steps.min() * 180 / np.pi), float(steps.max() * 180 / np.pi)


def timed_turns(time: FloatArray, knee: FloatArray, measured_on: ReferenceTricycle) -> list[TimedTurn]:
    """The whole turns of a trial by its knee angle (rad, growing in extension, shape (n,)); there may be none."""
    tops, bottoms = _peaks(-knee), _peaks(knee)
    if len(tops) > 1:  # at an end of the recording noise makes dead centres of a cut one
        edge = _EDGE * np.median(np.diff(time[tops]))
        tops, bottoms = (
            peaks[(time[peaks] - time[0] > edge) & (time[-1] - time[peaks] > edge)] for peaks in (tops, bottoms)
        )
    if len(tops) < 2:
        return []
    angle = _crank_angle(time, knee, tops, bottoms, measured_on)
    fine = np.linspace(time[0], time[-1], _FINE * len(time))
    turned = np.maximum.accumulate(angle(fine)) / (2 * np.pi)
    starts = np.interp(np.arange(len(tops)), turned, fine).tolist()  # angles are counted from the first top
    return [TimedTurn(start, end, angle, number) for number, (start, end) in enumerate(pairwise(starts))]


def _crank_angle(
    time: FloatArray, knee: FloatArray, tops: IntArray, bottoms: IntArray, measured_on: ReferenceTricycle
) -> Any:
    """The smooth crank angle over time whose knee angle is nearest to the measured: a spline, penalised (P-spline).

    The closed form of the tricycle gives a crank angle to every knee angle and direction: that is the first guess, in
    which a sample weighs as the knee tells the crank, nothing at a dead centre. Then least squares in the knee angle
    itself, whose zero and gain are found as well, so that neither they nor a tape measure a little wrong turn a dead
    centre round (Eilers and Marx 1996, doi:10.1214/ss/1038425655).
    """
    from scipy.interpolate import BSpline
    from scipy.sparse import csr_array, diags_array, hstack, vstack
    from scipy.sparse.linalg import spsolve

    low, high = measured_on.ranges.knee
    ends = float(np.median(knee[tops])), float(np.median(knee[bottoms]) if len(bottoms) else knee.max())
    gain = (ends[1] - ends[0]) / (high - low)
    zero = ends[0] - gain * low
    half_turns = np.searchsorted(np.sort(np.concatenate([tops, bottoms])), np.arange(len(time)), side="right")
    half_turns -= int((bottoms < tops[0]).sum()) + 1  # counted from the first top
    direction = np.where(half_turns % 2 == 0, 1.0, -1.0)
    guess = measured_on.source_angle("knee", (knee - zero) / gain, direction) % (2 * np.pi)
    guess += 2 * np.pi * (half_turns // 2)

    turns = (time[-1] - time[0]) / np.median(np.diff(time[tops]))
    inner = np.linspace(time[0], time[-1], int(_KNOTS * turns) + 2)
    knots = np.concatenate([np.repeat(inner[0], 3), inner, np.repeat(inner[-1], 3)])
    terms = csr_array(BSpline.design_matrix(time, knots, 3))
    count = terms.shape[1]
    rate = measured_on.joint_rates(guess).knee
    weight = np.sqrt(_STIFFNESS * np.mean(rate**2) * len(time) / count)
    # third differences; of zero and gain there are none
    thirds = weight * np.array([-1.0, 3.0, -3.0, 1.0])
    bent = diags_array(thirds, offsets=range(4), shape=(count - 3, count + 2)).tocsr()

    def solved(columns: Any, values: FloatArray) -> FloatArray:
        return np.asarray(spsolve((columns.T @ columns).tocsc(), columns.T @ values))

    even = np.zeros(count - 3)
    angles = solved(vstack([diags_array(rate) @ terms, bent[:, :count]]), np.concatenate([rate * guess, even]))
    for _ in range(_STEPS):
        motion = solve(measured_on.design, terms @ angles + measured_on.top_dead_centre)
        knee_angle = motion.joint_angle.knee
        line = csr_array(np.column_stack([np.ones(len(knee_angle)), knee_angle]))
        columns = vstack([hstack([diags_array(gain * motion.joint_rate.knee) @ terms, line]), bent])
        step = solved(columns, np.concatenate([knee - zero - gain * knee_angle, -(bent[:, :count] @ angles)]))
        angles, zero, gain = angles + step[:-2], zero + step[-2], gain + step[-1]
    return BSpline(knots, angles, 3)


def _peaks(value: FloatArray) -> IntArray:
    """Where the large maxima within a recording are."""
    from scipy.signal import find_peaks

    padded = np.pad(value, 1, constant_values=value.min())  # a swing that the recording cuts off is a whole one
    peaks = find_peaks(padded, prominence=max(_LEAST_SWING * np.ptp(value), np.finfo(float).tiny))[0] - 1
    return np.asarray(peaks[(peaks > 0) & (peaks < len(value) - 1)])
