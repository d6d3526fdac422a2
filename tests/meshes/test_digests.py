"""Digests of a value's content."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from evolvent_meshes.digests import digest


@dataclass(frozen=True)
class Thing:
    """With a number, an array and a dictionary."""

    size: float
    points: Any
    groups: dict[str, Any]


THING = Thing(1.0, np.arange(6.0).reshape(2, 3), {"top": np.array([1, 2]), "bottom": (3, None)})


def test_equal_values_have_one_digest() -> None:
    """An equal object; a list for a tuple, a whole number for a float, another order of names, another layout in
    memory."""
    same = Thing(1, np.asfortranarray(THING.points), {"bottom": [3.0, None], "top": np.array([1, 2])})
    assert digest(THING) == digest(same)


@pytest.mark.parametrize(
    "changes",
    [
        {"size": np.nextafter(1.0, 2.0)},
        {"points": np.arange(6.0).reshape(3, 2)},
        {"points": np.arange(6)},
        {"groups": {"top": np.array([1, 2]), "bottom": (3,)}},
        {"groups": {"top": np.array([1, 2]), "under": (3, None)}},
    ],
)
def test_other_values_have_another(changes: dict[str, Any]) -> None:
    """The next number; another shape, another type, an entry less, another name."""
    assert digest(replace(THING, **changes)) != digest(THING)
