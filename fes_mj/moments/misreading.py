"""What looks misread in a file of joint moments: wrong units, signs, zeros, and parts of the turn without data."""

import math
from collections.abc import Sequence

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.moments.fourier import WIDEST_GAP, gaps
from fes_mj.moments.joint_moments import JointMoments, Misreading
from fes_mj.moments.trial import Turn

LEAST_MOMENT = 2.0  # N m: a smaller largest one looks like N m/kg


def odd_angles(angle: FloatArray, unit: str) -> list[Misreading]:
    """Whether the unit of crank angles looks wrong."""
    largest = float(np.abs(angle).max(initial=0.0))
    if unit == "deg" and largest < 2 * math.pi:
        return [Misreading("radians", f"all crank angles are below {largest:.3g} deg; are they in radians?")]
    if unit == "rad" and largest > 60 * math.pi and np.abs(np.diff(angle)).max() > math.pi:
        return [Misreading("degrees", f"crank angles go up to {largest:.4g} rad; are they in degrees?")]
    return []


def odd_moments(turns: Sequence[Turn], moments: JointMoments) -> list[Misreading]:
    """What looks wrong in the moments themselves."""
    misreadings = []
    largest = max(float(np.abs([turn.knee, turn.hip]).max()) for turn in turns)
    if largest < LEAST_MOMENT:
        text = f"the largest moment is {largest:.3g} N m; is the unit N m/kg?"
        misreadings.append(Misreading("per_kg", text))
    gap = max(float(gaps(turn.crank_angle)[1].max()) for turn in turns)
    if gap > WIDEST_GAP:
        text = f"there is no sample in {np.degrees(gap):.0f} deg of the turn; a straight line is drawn across"
        misreadings.append(Misreading("gap", text))
    power = moments.power_mean
    if sum(power) < 0:
        text = (
            f"the mean power in the tricycle of the measurement is {sum(power):.2f} W: these moments brake; "
            "are signs, zero or sense of the crank angle as declared?"
        )
        misreadings.append(Misreading("negative_power", text))
    if power.knee < 0 < power.hip - power.knee:
        text = (
            f"the knee takes {-power.knee:.2f} W from the crank; "
            "are extension and flexion exchanged? Extension is positive"
        )
        misreadings.append(Misreading("exchanged", text))
    return misreadings
