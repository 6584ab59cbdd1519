"""Passive moments of hip and knee: what published curves say, as derivatives of one potential.

Riener and Edrich, J. Biomech. 32 (1999) 539-544. As printed the two curves are not derivatives of one function: over a
turn they would give or take energy. The potential is fitted to both (tools/make_muscles.py); closed turns cost nothing.
"""

from functools import cache
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.reading import DATA, read_toml
from fes_mj.linkage.joints import PerJoint
from fes_mj.muscles.geometry import Flexion, Surfaces

PASSIVE_FILE = DATA / "muscles" / "passive.toml"


def published(hip: Any, knee: Any) -> PerJoint[FloatArray]:
    """Passive moments as printed, with the ankle at a right angle, N m, positive in flexion; angles: deg of flexion."""
    return PerJoint(
        np.exp(1.800 - 0.0352 * knee + 0.0217 * hip)
        - np.exp(-3.971 + 0.0495 * knee - 0.0128 * hip)
        - 4.820
        + np.exp(2.220 - 0.150 * knee),
        np.exp(1.4655 - 0.0034 * knee - 0.0750 * hip) - np.exp(1.3403 - 0.0226 * knee + 0.0305 * hip) + 8.072,
    )


@cache
def _potential() -> Surfaces:
    section = read_toml(PASSIVE_FILE, "potential of the passive moments")
    return Surfaces(np.array([section.content["coefficients_J"]]), int(section.content["degree"]))


def passive_moments(flexion: Flexion) -> PerJoint[FloatArray]:
    """Passive moments of knee and hip, N m, positive in extension, of the flexion's shape."""
    _, by_hip, by_knee = _potential().at(flexion)
    return PerJoint(by_knee[0], by_hip[0])
