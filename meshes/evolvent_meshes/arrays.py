"""Types of arrays, for both packages, and the different values of one."""

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


def different(values: Floats, apart: float) -> tuple[Floats, Ints]:
    """Different values, ascending, and the index of each of the values (n,) among them. apart: distance of two
    neighbours up to which they are one value."""
    order = np.argsort(values)
    new = np.concatenate([[False], np.diff(values[order]) > apart])
    which = np.empty(len(values), dtype=np.int64)
    which[order] = np.cumsum(new)
    return values[order][np.concatenate([[True], new[1:]])], which
