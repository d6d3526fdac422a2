"""How a body answers contact forces in one step, with s free rigid motions of r, and k functionals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from evolvent.contact.problem.condensed_body import CondensedBody
from evolvent_meshes.arrays import Floats


class BodyResponse(Protocol):
    """The part of a body in the contact system of a step: y = P R δ + displacement + C f, and what resists δ."""

    @property
    def compliance(self) -> Floats:
        """C (k, k) [mm/N]."""
        ...

    @property
    def displacement(self) -> Floats:
        """(k,) functionals without contact forces and rigid motions [mm]."""
        ...

    @property
    def resistance(self) -> Floats:
        """(s, s) force on the free rigid motions by unit amplitudes of them [N/mm, N, N·mm]."""
        ...

    @property
    def load(self) -> Floats:
        """(s,) force on the free rigid motions beside that of the step [N, N·mm]."""
        ...

    def field(self, forces: Floats, motion: Floats) -> Floats:
        """Displacement of the nodes (N, d) [mm] under forces on the functionals (k,) [N] at amplitudes of all rigid
        motions (r,)."""
        ...


@dataclass(frozen=True)
class StaticResponse:
    """Of a body without inertia."""

    condensed: CondensedBody
    """The body."""
    factor: float
    """Of its loads and prescribed displacements."""
    count: int
    """s, of its rigid motions that are free in this step."""

    @property
    def compliance(self) -> Floats:
        """See `BodyResponse.compliance`."""
        return self.condensed.compliance

    @property
    def displacement(self) -> Floats:
        """See `BodyResponse.displacement`."""
        return self.factor * self.condensed.load_response

    @property
    def resistance(self) -> Floats:
        """See `BodyResponse.resistance`."""
        return np.zeros((self.count, self.count))

    @property
    def load(self) -> Floats:
        """See `BodyResponse.load`."""
        return np.zeros(self.count)

    def field(self, forces: Floats, motion: Floats) -> Floats:
        """See `BodyResponse.field`."""
        return self.condensed.displacement(forces, self.factor, motion)
