"""Units of files and terminals; inside the package everything is SI and radians."""

import math
from typing import Any

RPM = math.pi / 30  # rad/s per rpm
KMH = 1 / 3.6  # m/s per km/h


def work_per_turn(power: Any, cadence: Any) -> Any:
    """Work of a turn of the crank, J, at a mean power, W, and a crank speed, rad/s."""
    return 2 * math.pi * power / cadence


def turns_per_second(cadence: Any) -> Any:
    """Of crank speeds in rad/s: work of a turn, J, times this is mean power, W; travel of a turn, mean speed."""
    return cadence / (2 * math.pi)
