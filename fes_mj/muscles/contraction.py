"""Force of a muscle with a rigid tendon: force-length, force-velocity and pennation (Thelen, Zajac: Hill's model).

Zajac, Crit. Rev. Biomed. Eng. 17 (1989) 359-411; Thelen, J. Biomech. Eng. 125 (2003) 70, doi:10.1115/1.1531112.
"""

from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray

WIDTH = 0.45  # of the force-length curve, optimal fibre lengths (Thelen 2003)
CURVATURE = 0.25  # Hill's a / F0 (Zajac 1989)
PLATEAU = 1.4  # largest force of a lengthening muscle per isometric force (Thelen 2003)
# Of the lengthening branch (7.56 in Thelen's units): at rest force rises 2.5 times as fast with lengthening as it falls
# with shortening; Katz, J. Physiol. 96 (1939) 45-64, found up to six times.
_LENGTHENING = 7.56 / CURVATURE


def force_length(fibre: Any) -> Any:
    """Force per largest isometric force at these fibre lengths, in optimal fibre lengths."""
    return np.exp(-(((fibre - 1) / WIDTH) ** 2))


def force_velocity(shortening: Any) -> Any:
    """Force per isometric force at these shortening speeds, in largest speeds; none from 1 on, PLATEAU below -1."""
    positive, negative = np.clip(shortening, 0.0, 1.0), np.clip(shortening, -1.0, 0.0)
    # each branch is as at rest where the other counts
    shorter = (1 - positive) / (1 + positive / CURVATURE)
    return shorter + (PLATEAU - 1) * (1 - (1 + negative) / (1 - _LENGTHENING * negative))


def tension(
    length: FloatArray, speed: FloatArray, optimal: Any, slack: Any, pennation: Any, max_speed: Any
) -> tuple[FloatArray, FloatArray]:
    """Force along the tendon per activation and largest isometric force, and the cosine of the pennation angle.

    length: m, from origin to insertion, and speed: m/s, at which it grows, any shape. optimal: m, and max_speed:
    optimal fibre lengths per s, of the fibres; slack: m, of the tendon; pennation: rad, at the optimal length, the
    muscle keeping its thickness. A muscle shorter than its tendon pulls with nothing.
    """
    along = np.maximum(length - slack, 0)
    fibre = np.sqrt(along * along + (optimal * np.sin(pennation)) ** 2)
    cosine = along / np.maximum(fibre, np.finfo(float).tiny)
    shortening = speed * cosine * (-1 / (max_speed * optimal))
    return force_length(fibre / optimal) * force_velocity(shortening) * cosine, cosine
