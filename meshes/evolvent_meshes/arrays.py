"""Types of arrays, for both packages."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
Complexes = NDArray[np.complex128]
Singles = NDArray[np.float32]
Reals = NDArray[Any]
"""Array of single or double precision."""
