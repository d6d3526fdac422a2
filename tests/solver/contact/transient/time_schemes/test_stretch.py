"""The stretch at which an energy is kept, of functions with a known root."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from evolvent.contact.transient.time_schemes.stretch import FARTHEST, try_stretches


def tried(of_stretch: Callable[[float], float], slope: float) -> tuple[list[float], list[float]]:
    """The ln s that were evaluated, and the values there."""
    at, values = [], []

    def excess(x: float) -> float:
        at.append(x)
        values.append(of_stretch(float(np.exp(x))))
        return 0.0 if abs(values[-1]) < 1e-11 else values[-1]

    try_stretches(excess, of_stretch(1.0), slope)
    return at, values


@pytest.mark.parametrize("root", [0.01, 0.7, 0.999, 1.2, 30.0])
def test_the_root_is_found_on_either_side(root: float) -> None:
    """ε = s (s − s_0), as of a free flight: to 1e-11 at s_0, near 1 and far from it."""
    at, values = tried(lambda s: s * (s - root), 2.0)
    assert abs(values[-1]) < 1e-11
    assert np.exp(at[-1]) == pytest.approx(root, rel=0.0, abs=1.01e-11 / root)


def test_a_kink_is_no_hindrance() -> None:
    """ε grows a hundredfold faster beyond s = 0.9, as where contact closes: found within ten evaluations."""
    _, values = tried(lambda s: s - 0.8 + 100.0 * max(s - 0.9, 0.0), 1.0)
    assert abs(values[-1]) < 1e-11
    assert len(values) <= 10


def test_it_ends_where_there_is_no_root() -> None:
    """ε < 0 for all s: the largest stretch is the last one, and no error."""
    at, values = tried(lambda s: -1.0 / (1.0 + s), 1.0)
    assert at[-1] == FARTHEST
    assert all(value < 0.0 for value in values)
