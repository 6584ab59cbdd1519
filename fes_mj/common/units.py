"""Units of files and terminals; inside the package everything is SI and radians."""

import math
from typing import Any

RPM = math.pi / 30  # rad/s per rpm
KMH = 1 / 3.6  # m/s per km/h


def turns_per_second(cadence: Any) -> Any:
    """Of crank speeds in rad/s: work of a turn, J, times this is mean power, W; travel of a turn, mean speed."""
    return cadence / (2 * math.pi)
