"""Guess from which the solution of a position starts where it needs no position before it."""

from __future__ import annotations

from typing import Protocol

from evolvent_meshes.arrays import Bools, Floats, Ints


class PositionStart(Protocol):
    """Guess of the equilibrium of a position without friction. Results do not depend on it."""

    @property
    def beyond_nominal(self) -> tuple[float, float]:
        """Rotations of pinion and wheel beyond the nominal ones in equilibrium [rad]."""
        ...

    @property
    def reach(self) -> float:
        """Distance from the contact lines of flanks without modifications that the contact reaches at least [mm of
        profile arc]: windows of the search are as wide."""
        ...

    def pressed(self, tooth: Ints, z: Floats, across: Floats) -> Bools:
        """Points (q,) bool of the pinion's flanks that bear load.

        tooth: (q,) tooth pair.
        z: (q,) height [mm].
        across: (q,) distance from the contact line of flanks without modifications, towards the pinion's tip [mm of
            profile arc].
        """
        ...
