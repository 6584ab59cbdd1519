"""What the paper's search held: is the recovered power stationary at its designs, and under which limit?"""

from itertools import product

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.markdown import Table
from fes_mj.common.units import turns_per_second
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DIMENSIONS, load_design
from fes_mj.linkage.variables import LENGTHS, lengths, with_lengths
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.uncertainty import with_sd
from fes_mj.paper.captions import captioned
from fes_mj.statics.cycles import cycles
from fes_mj.statics.work_table import uncertain_table

# Each design with the group that it was made for (Section 7; docs/errata.md, E14).
MADE_FOR = {"r1": "p1p2", "r2": "p1p3", "d1": "p1p2", "d2": "p1p3"}
HELD = ("gear ratio", "knee speed")
STEP = 1e-4  # m, either way; the identified R2 is 0.6 mm from where it cannot turn
_POINTS = 720
_CM = 100.0  # in a metre


def slopes(design: Design, moments: JointMoments) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Change of mean power per length, W/cm, and its standard deviation, shape (9,) each, by what of HELD is held.

    Held knee speed: the gear ratio is such that the knee moves as fast on average as in the design itself. NaN where a
    linkage does not turn.
    """
    shifts = STEP * np.concatenate([np.zeros((9, 1)), np.eye(9), -np.eye(9)], axis=1)
    turn = cycles(
        with_lengths(design, (lengths(design)[:, None] + shifts)[..., None]), uncertain_table(moments), _POINTS
    )
    power = turn.work * turns_per_second(design.linkage.cadence)
    slowed = power * (turn.travel.knee[0] / turn.travel.knee)[:, None]
    by_held = {}
    for held, values in zip(HELD, (power, slowed), strict=True):
        slope = (values[1:10] - values[10:]) / (2 * STEP * _CM)
        by_held[held] = (slope[:, 0], np.sqrt(np.einsum("ls,ls->l", slope[:, 1:], slope[:, 1:])))
    return by_held


def stationarity_table() -> Table:
    """Slopes of every six-bar with the group that it was made for."""
    rows = []
    for (name, group), dims in product(MADE_FOR.items(), DIMENSIONS):
        for held, (slope, deviation) in slopes(load_design(name, dims), load_moments(group)).items():
            cells = [
                None if np.isnan(value) else with_sd(value, sd, 1) for value, sd in zip(slope, deviation, strict=True)
            ]
            farthest = None if np.isnan(slope).any() else float(np.max(np.abs(slope) / deviation))
            rows.append((name.upper(), group, dims, held, *cells, farthest))
    return captioned("stationarity", rows, length=LENGTHS)
