"""A design whose legs are driven by stimulated muscles with the best timing: expected power, who is stimulated when."""

from collections.abc import Iterator
from functools import lru_cache
from typing import Any

import numpy as np

from fes_mj.common.errors import InputError
from fes_mj.explore.turn import DIGITS, Number, shown
from fes_mj.linkage.design import Design
from fes_mj.linkage.legs import all_legs
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.moments.uncertainty import with_sd
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.rules import BEST
from fes_mj.statics.muscle_static import MuscleStatic


def by_muscles(design: Design, compared: Design, group: str, legs: int = 1) -> dict[str, Any]:
    """Expected power under a rider group's muscles and its standard deviation over riders; curves are of all legs.

    "compared_W" is another design's power, None where it has none. Without power, "why" says so.
    """
    try:
        require_muscles(group)
        turn = _solved(design, group)
    except InputError as error:
        return {"why": str(error)}
    return {
        "power_mean_W": turn.power_mean,
        "compared_W": _power(compared, group),
        "static": np.round(all_legs(turn.power, legs), DIGITS),
        "sd": np.round(all_legs(turn.stimulated.power, legs).std(axis=0), DIGITS),
        "numbers": shown(_numbers(turn)),
    }


def require_muscles(group: str) -> None:
    """Raise InputError for moments of whose riders no muscles are known."""
    if group not in GROUPS:
        raise InputError(f"no muscles of {group} are known, only of {' and '.join(GROUPS)}")


@lru_cache(maxsize=16)
def _solved(design: Design, group: str) -> MuscleStatic:
    return MuscleStatic.solve(design, load_riders(group), design.linkage.cadence, BEST)


def _power(design: Design, group: str) -> float | None:
    try:
        return _solved(design, group).power_mean
    except InputError:
        return None


def _numbers(turn: MuscleStatic) -> Iterator[Number]:
    yield "muscles", "mean power, one leg, muscles", with_sd(turn.power_mean, turn.power_sd), "W"
    for muscles, window in (turn.windows_deg or {}).items():
        text = f"{window[0]:.0f} to {window[1]:.0f}" if window else "never"
        yield muscles, f"{muscles} stimulated", text, "deg" if window else ""
