"""Units of files and terminals; inside the package everything is SI and radians."""

import math

RPM = math.pi / 30  # rad/s per rpm
KMH = 1 / 3.6  # m/s per km/h
