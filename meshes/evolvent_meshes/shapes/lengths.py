"""Checks of the lengths and counts from which shapes are made; each error names the function and its argument."""

from __future__ import annotations

from typing import Any

import numpy as np

from evolvent_meshes.input_checks import is_index, is_number, shown
from evolvent_meshes.mesh.mesh_data import MeshError


def check_lengths(
    function: str, *, fine: Any = 0.0, fine_depth: Any = 0.0, growth: Any = 1.0, **above_zero: Any
) -> None:
    """Raises MeshError unless all are finite numbers: above_zero, lengths [mm] or curvatures [1/mm] above 0; fine and
    fine_depth [mm] from 0 on; growth from 1 on."""
    for name, value in above_zero.items():
        _check(function, name, value, is_number(value) and value > 0.0, "a number above 0", "give it in mm")
    for name, value in (("fine", fine), ("fine_depth", 0.0 if fine_depth is None else fine_depth)):
        _check(function, name, value, is_number(value) and value >= 0.0, "a number from 0 on", "give it in mm")
    _check(function, "growth", growth, is_number(growth) and growth >= 1.0, "a number from 1 on", "1.3 is usual")


def check_counts(function: str, **counts: Any) -> None:
    """Raises MeshError unless all numbers of cells are whole and above 0."""
    for name, count in counts.items():
        _check(function, name, count, is_index(count) and count > 0, "a whole number above 0", "count the cells")


def check_tuples(function: str, length: int, **tuples: Any) -> None:
    """Raises MeshError unless all are tuples, lists or arrays of this length."""
    for name, value in tuples.items():
        fits = isinstance(value, tuple | list | np.ndarray) and len(value) == length
        _check(function, name, value, fits, f"a tuple of {length} numbers", "give one a direction")


def _check(function: str, name: str, value: object, fits: bool, wanted: str, remedy: str) -> None:
    if not fits:
        raise MeshError(f"{function}, {name}: wanted {wanted}, found {shown(value)}; {remedy}")
