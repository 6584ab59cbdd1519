"""Predictions, as in cranking.py, of moments that belong to joint angles, as the paper has them: curves that may be."""

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.units import RPM
from fes_mj.linkage import kinematics
from fes_mj.moments.files import sampled_coefficients, sampled_moments
from fes_mj.moments.fourier import fourier
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import TURN_ANGLES
from fes_mj.statics.turn import quasi_static
from fes_mj.validation.cranking import TRICYCLE, CrankingSetup

_CURVES = 20


def knee_of_largest_moment(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Knee flexion at which the extending knee has the largest recovered moment, deg."""
    motion = kinematics.solve(TRICYCLE, TURN_ANGLES)
    extends = motion.joint_rate.knee > 0
    features = fourier(TURN_ANGLES[extends] - PAPER_TRICYCLE.top_dead_centre)
    moment = np.split(sampled_coefficients(riders.name), 2, axis=1)[0] @ features.T
    return np.asarray(180 - np.degrees(motion.joint_angle.knee[extends])[moment.argmax(axis=1)])


def torque_ratio_by_angle(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Mean crank torque at the first cadence per that at the second."""
    curves = sampled_moments(riders.name, _CURVES)

    def torque(rpm: float) -> FloatArray:
        return np.array([quasi_static(TRICYCLE, curve, rpm * RPM).work_per_turn for curve in curves])

    first, second = (torque(rpm) for rpm in setup["cadence_rpm"])
    return first / second
