"""The two numbers of a design, beside another's, with their intervals; under muscles also the curve and the windows.

They take longer than a curve may, and are asked for when the design has rested.
"""

from collections.abc import Iterator
from functools import lru_cache
from typing import Any

import numpy as np

from fes_mj.budget.answer import Answer, Estimate, answer, riders_of
from fes_mj.common.errors import InputError
from fes_mj.explore.turn import DIGITS, Number, shown
from fes_mj.linkage.design import Design
from fes_mj.linkage.legs import all_legs
from fes_mj.moments.joint_moments import RIDER_GROUPS, JointMoments
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.rules import BEST
from fes_mj.statics.muscle_static import MuscleStatic
from fes_mj.statics.turn import quasi_static


def numbers(design: Design, compared: Design, moments: JointMoments) -> dict[str, Any]:
    """Both numbers under moments and their riders' muscles, and each per another design's.

    "rider_power_mean_W" is a rider's. What is not known is left out, and "why" says so.
    """
    answered, other = _answered(design, moments), _answered(compared, moments)
    power = answered.rider_power
    return {
        "rider_power_mean_W": power and power.value,
        "rider": power and power.text(1),
        "both": _both(answered, *answered.per(other)),
        "why": answered.missing or None,
    }


def by_muscles(design: Design, moments: JointMoments, legs: int = 1) -> dict[str, Any]:
    """Expected power over the turn by the muscles of moments' riders, its standard deviation, and the windows.

    Curves are of all legs, in W. Without power, "why" says so.
    """
    try:
        require_muscles(moments.name)
        turn = MuscleStatic.solve(design, load_riders(moments.name), design.linkage.cadence, BEST)
    except InputError as error:
        return {"why": str(error)}
    return {
        "static": np.round(all_legs(turn.power, legs), DIGITS),
        "sd": np.round(all_legs(turn.stimulated.power, legs).std(axis=0), DIGITS),
        "windows": shown(_windows(turn)),
    }


def require_muscles(group: str) -> None:
    """Raise InputError for moments of whose riders no muscles are known."""
    if group not in RIDER_GROUPS:
        raise InputError(f"no muscles of {group} are known, only of {' and '.join(RIDER_GROUPS)}")


@lru_cache(maxsize=16)
def _answered(design: Design, moments: JointMoments) -> Answer:
    try:
        legs = [quasi_static(design, moments)]
    except InputError as error:
        return Answer(design, missing=str(error))
    return answer(design, legs, riders_of(moments))


def _both(answered: Answer, paper: Estimate | None, rider: Estimate | None) -> dict[str, list[list[str] | None]]:
    """By number: W, per compared, per the equally timed TRT, each as text with its interval; None if not known."""
    rows = {
        "assumed": ((answered.paper_power, 2), (paper, 2), (None, 2)),
        "rider": ((answered.rider_power, 1), (rider, 2), (answered.rider_ratio, 2)),
    }
    return {
        name: [[f"{cell.value:.{digits}f}", cell.interval(digits)] if cell else None for cell, digits in cells]
        for name, cells in rows.items()
    }


def _windows(turn: MuscleStatic) -> Iterator[Number]:
    for muscles, window in (turn.windows_deg or {}).items():
        text = f"{window[0]:.0f} to {window[1]:.0f}" if window else "never"
        yield muscles, f"{muscles} stimulated", text, "deg" if window else ""
