"""One rider's stimulated muscles at one instant, in plain numbers: what a simulation asks for in every step.

A second implementation of what activation, contraction and pull say of a whole turn: these functions know one state of
one leg, muscle after muscle. `step` has them in machine code, which is why none calls another.
"""

import math
import operator
from itertools import dropwhile
from typing import Any, NamedTuple, cast

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray, IntArray
from fes_mj.common.machine_code import in_lists
from fes_mj.linkage.design import Rider
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.contraction import CURVATURE, LENGTHENING, PLATEAU, WIDTH
from fes_mj.muscles.geometry import CENTRE, exponents
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import Windows


class LegMuscles(NamedTuple):
    """The muscles of one rider's leg; arrays by muscle, shape (muscles,).

    group: number in MUSCLE_GROUPS. lengths: m, coefficients by powers of hip, then knee flexion from `straight` where
    knee_inside, elsewhere of knee, then hip, highest first, shape (muscles, powers, powers). straight: knee and hip
    angle from which flexion counts there, rad. force: N, of the rider's muscles, times how much longer these are than
    the lengths say. optimal, slack: m. thickness: m, of the fibres. max_speed: m/s. rise, fall, delay: s.
    """

    group: IntArray
    knee_inside: BoolArray
    lengths: FloatArray
    straight: FloatArray
    force: FloatArray
    optimal: FloatArray
    slack: FloatArray
    thickness: FloatArray
    max_speed: FloatArray
    rise: float
    fall: float
    delay: float

    @classmethod
    def of(cls, member: Riders, rider: Rider) -> "LegMuscles":
        """Of one member of an ensemble with the segments of this rider."""
        muscles, value = anatomy(), {name: float(column[0]) for name, column in member.values.items()}
        powers = exponents(muscles.lengths.degree)
        lengths = np.zeros((len(muscles.names), *[muscles.lengths.degree + 1] * 2))
        for (hip, knee), column in zip(powers, muscles.lengths.coefficients.T, strict=True):
            lengths[:, knee, hip] = column
        # of muscles that do not pass the hip, so that all is in one row
        knee_inside = np.logical_not(lengths[:, :, 1:].any(axis=(1, 2)))
        lengths[knee_inside] = np.swapaxes(lengths[knee_inside], 1, 2)
        scale = muscles.length_scale(rider).ravel()
        offset = np.array([0.0, np.radians(value["hip_offset_deg"])])
        return cls(
            group=muscles.group,
            knee_inside=knee_inside,
            lengths=lengths[:, ::-1, ::-1].copy(),
            straight=np.pi + offset - CENTRE[::-1],
            force=muscles.force * member.strength(muscles).ravel() * scale,
            optimal=muscles.optimal,
            slack=member.slack(muscles).ravel(),
            thickness=muscles.optimal * np.sin(muscles.pennation),
            max_speed=value["max_speed"] * muscles.optimal,
            rise=value["rise_s"],
            fall=value["rise_s"] * value["fall_per_rise"],
            delay=value["delay_s"],
        )

    @property
    def in_lists(self) -> "LegMuscles":
        """The same for Python: lists, without the zeros that stand before a polynomial's highest powers."""
        rows = [[[*dropwhile(operator.not_, row)] for row in lengths] for lengths in self.lengths.tolist()]
        return in_lists(self._replace(lengths=cast("Any", [[*dropwhile(operator.not_, muscle)] for muscle in rows])))


class Stimulus(NamedTuple):
    """Windows of one rider by group, rad of crank angle, shape (groups,); ramp: rad, in which stimulation grows."""

    on: FloatArray
    width: FloatArray
    ramp: float

    @classmethod
    def of(cls, windows: Windows, cadence: float) -> "Stimulus":
        """Windows of one member on one design, with the ramp at this cadence, rad/s."""
        on, width = (np.radians(values[:, 0, 0]) for values in (windows.on, windows.width))
        return cls(on, width, cadence * ramp())


def stimulation(stimulus: Stimulus, group: int, angle: float) -> float:
    """Stimulation of a group in [0, 1] at a crank angle, rad, by any whole turns (activation.trapezium)."""
    width: float = stimulus.width[group]
    passed: float = (angle - stimulus.on[group]) % (2 * math.pi)
    if passed >= width:
        return 0.0
    return min(1.0, passed / stimulus.ramp, (width - passed) / stimulus.ramp)


def weights(step: float, constant: float) -> tuple[float, float, float]:
    """What activation and stimulation before a step, and stimulation after it, count for in activation after it.

    Exact for a stimulation that is linear over the step and one time constant; both in s.
    """
    kept = math.exp(-step / constant)
    follows = (1 - kept) * constant / step
    return kept, follows - kept, 1 - follows


def activated(
    activation: float,
    before: float,
    after: float,
    rising: tuple[float, float, float],
    falling: tuple[float, float, float],
) -> float:
    """Activation after a step; before, after: stimulation. rising, falling: `weights` of the two time constants.

    Always as the constant says that leaves it the higher (periodic_activation).
    """
    up = rising[0] * activation + rising[1] * before + rising[2] * after
    down = falling[0] * activation + falling[1] * before + falling[2] * after
    return up if up > down else down  # in half the time of max


def joint_moments(
    leg: LegMuscles, activation: Any, knee: float, hip: float, knee_rate: float, hip_rate: float
) -> tuple[float, float]:
    """Moments of knee and hip, N m, positive in extension, without passive ones (pull.Pull, contraction.tension).

    activation: by group. knee, hip: angles, rad, and rates, rad/s, that grow in extension.
    """
    bent_knee, bent_hip = leg.straight[0] - knee, leg.straight[1] - hip
    knee_moment = hip_moment = 0.0
    # names of their own for all of a muscle: Python looks them up faster than places in a tuple's lists
    columns = (leg.group, leg.knee_inside, leg.lengths, leg.force, leg.optimal, leg.slack, leg.thickness, leg.max_speed)
    for group, knee_inside, lengths, strongest, optimal, slack, thickness, max_speed in zip(*columns):  # noqa: B905
        active = activation[group]
        if active <= 0:
            continue
        # Horner's rule for the polynomial and its derivatives, the moment arms
        inner, outer = (bent_knee, bent_hip) if knee_inside else (bent_hip, bent_knee)
        length = by_outer = by_inner = 0.0
        for row in lengths:
            value = slope = 0.0
            for coefficient in row:
                slope = slope * inner + value
                value = value * inner + coefficient
            by_outer = by_outer * outer + length
            length = length * outer + value
            by_inner = by_inner * outer + slope
        by_knee, by_hip = (by_inner, by_outer) if knee_inside else (by_outer, by_inner)
        along = length - slack
        if along <= 0:
            continue
        fibre = math.sqrt(along * along + thickness * thickness)
        cosine = along / fibre
        shortening = (by_knee * knee_rate + by_hip * hip_rate) * cosine / max_speed
        if shortening >= 1:
            continue
        if shortening >= 0:
            factor = (1 - shortening) / (1 + shortening / CURVATURE)
        else:
            lengthening = max(shortening, -1.0)
            factor = 1 + lengthening * (PLATEAU - 1) * (LENGTHENING + 1) / (LENGTHENING * lengthening - 1)
        apart = (fibre / optimal - 1) / WIDTH
        force = strongest * active * math.exp(-apart * apart) * factor * cosine
        knee_moment += force * by_knee
        hip_moment += force * by_hip
    return knee_moment, hip_moment
