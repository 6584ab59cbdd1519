"""Units of files and terminals; inside the package everything is SI and radians."""

from __future__ import annotations

import math

RPM = math.pi / 30  # rad/s per rpm
