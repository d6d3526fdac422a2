"""SNES on x³ = 8, whose only root is 2, from x = 3; and callbacks that fail."""

from __future__ import annotations

import signal
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from evolvent.contact.newton.snes import solve
from evolvent.run.stopping import Stopped, stoppable
from evolvent_meshes.arrays import Floats


def nothing() -> None:
    """What does not happen."""


@dataclass(frozen=True)
class Cube:
    """x³ − 8."""

    in_residual: Callable[[], None] = nothing
    in_solve: Callable[[], None] = nothing

    def residual(self, x: Floats) -> Floats:
        self.in_residual()
        return np.asarray(x**3 - 8.0)

    def solve(self, x: Floats, right: Floats) -> Floats:
        self.in_solve()
        return np.asarray(right / (3.0 * x**2))

    def scale(self, x: Floats) -> float:
        return 8.0

    def work(self, x: Floats, step: Floats) -> Callable[[float], float]:
        return lambda α: -float((x - α * step)[0] ** 3 - 8.0) * float(step[0])


def test_root() -> None:
    """2, to the tolerance."""
    found = solve(Cube(), np.array([3.0]), "cube", 20, 1e-12)
    assert found.converged and found.x[0] == pytest.approx(2.0, rel=1e-11)


@pytest.mark.parametrize("where", ["in_residual", "in_solve"])
def test_a_signal_within_a_callback_is_a_signal(where: str) -> None:
    """SIGTERM while PETSc calls back: its exception comes out, not an error of PETSc's own; and the next solve is as
    good as any."""
    with pytest.raises(Stopped, match="stopped by SIGTERM"), stoppable("", nothing):
        solve(Cube(**{where: lambda: signal.raise_signal(signal.SIGTERM)}), np.array([3.0]), "cube", 20, 1e-12)
    test_root()
