"""Reading curves over a turn of the crank, a number at a time: what both solvers of a ride do in every step."""

import math
from typing import Any

from fes_mj.common.machine_code import machine_code
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import TWO_LEGS

DRIVEN = tuple((leg, joint) for leg in TWO_LEGS for joint in JOINTS)  # what muscles move
TURN = 2 * math.pi


@machine_code
def place(angle: float, count: int) -> tuple[int, float]:
    """Where a crank angle (rad) lies in a curve of so many cells over a turn: cell, and part of it."""
    position = (angle % TURN) * (count / TURN)
    row = min(int(position), count - 1)  # a turn less a rounding error
    return row, position - row


@machine_code
def between(curve: Any, row: int, part: float) -> float:
    """Value of a curve in a cell, between its two ends."""
    value: float = curve[row] + part * (curve[row + 1] - curve[row])
    return value
