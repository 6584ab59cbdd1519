"""Array types. A shape stands in each docstring; "batch" is one row per design, shape (designs, crank angles)."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

FloatArray: TypeAlias = NDArray[np.floating[Any]]
ComplexArray: TypeAlias = NDArray[np.complexfloating[Any, Any]]  # planar vectors x + iy
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]
Picture: TypeAlias = NDArray[np.uint8]  # (height, width, RGB)
