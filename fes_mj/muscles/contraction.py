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
LENGTHENING = 7.56 / CURVATURE


def force_length(fibre: FloatArray) -> FloatArray:
    """Force per largest isometric force at these fibre lengths, in optimal fibre lengths."""
    apart = (fibre - 1) / WIDTH
    apart *= -apart
    return np.asarray(np.exp(apart, out=apart))


def force_velocity(shortening: FloatArray) -> FloatArray:
    """Force per isometric force at these shortening speeds, in largest speeds; none from 1 on, PLATEAU below -1."""
    speed = np.maximum(shortening, 0)
    force = (1 - np.minimum(speed, 1)) / (1 + speed / CURVATURE)
    np.clip(shortening, -1, 0, out=speed)  # of lengthening; the other branch is 1 there
    speed *= (PLATEAU - 1) * (LENGTHENING + 1) / (LENGTHENING * speed - 1)
    force += speed
    return force


def tension(
    length: FloatArray, speed: FloatArray, optimal: Any, slack: Any, pennation: Any, max_speed: Any
) -> tuple[FloatArray, FloatArray]:
    """Force along the tendon per activation and largest isometric force, and the cosine of the pennation angle.

    length: m, from origin to insertion, and speed: m/s, at which it grows, any shape. optimal: m, and max_speed:
    optimal fibre lengths per s, of the fibres; slack: m, of the tendon; pennation: rad, at the optimal length, the
    muscle keeping its thickness. A muscle shorter than its tendon pulls with nothing.
    """
    along = np.maximum(length - slack, 0)
    fibre = along * along
    fibre += (optimal * np.sin(pennation)) ** 2
    np.sqrt(fibre, out=fibre)
    along /= np.maximum(fibre, np.finfo(float).tiny)
    cosine = along
    fibre /= optimal
    force = force_length(fibre)
    np.multiply(speed, cosine, out=fibre)
    fibre *= -1 / (max_speed * optimal)
    force *= force_velocity(fibre)
    force *= cosine
    return force, cosine
