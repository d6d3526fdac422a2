"""Response of a body to contact forces in one step, with s free rigid motions of r, and k functionals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from evolvent.contact.problem.condensed_body import CondensedBody
from evolvent_meshes.arrays import Floats


class BodyResponse(Protocol):
    """The part of a body in the contact system of a step: y = P R δ + displacement + C f, and the forces that resist
    δ."""

    @property
    def compliance(self) -> Floats:
        """Compliance C (k, k) of the functionals [mm/N]."""
        ...

    @property
    def displacement(self) -> Floats:
        """Values (k,) of the functionals without contact forces and rigid motions [mm]."""
        ...

    @property
    def resistance(self) -> Floats:
        """Force (s, s) on the free rigid motions by unit amplitudes of them [N/mm, N, N·mm]."""
        ...

    @property
    def load(self) -> Floats:
        """Force (s,) on the free rigid motions beside that of the step [N, N·mm]."""
        ...

    def field(self, forces: Floats, motion: Floats) -> Floats:
        """Displacement of the nodes (N, d) [mm] under forces on the functionals (k,) [N] at amplitudes of all rigid
        motions (r,)."""
        ...


@dataclass(frozen=True)
class StaticResponse:
    """Response of a body without inertia to contact forces."""

    condensed: CondensedBody
    """Condensed body."""
    factor: float
    """Factor on the loads and prescribed displacements of the body."""
    count: int
    """Number s of rigid motions that are free in this step."""

    @property
    def compliance(self) -> Floats:
        """Compliance C (k, k) of the functionals [mm/N]."""
        return self.condensed.compliance

    @property
    def displacement(self) -> Floats:
        """Values (k,) of the functionals without contact forces and rigid motions [mm]."""
        return self.factor * self.condensed.load_response

    @property
    def resistance(self) -> Floats:
        """Zero matrix (s, s): without inertia only contact resists the free rigid motions."""
        return np.zeros((self.count, self.count))

    @property
    def load(self) -> Floats:
        """Zero forces (s,) on the free rigid motions beside those of the step [N, N·mm]."""
        return np.zeros(self.count)

    def field(self, forces: Floats, motion: Floats) -> Floats:
        """Displacement of the nodes (N, d) [mm] under forces on the functionals (k,) [N] at amplitudes of all rigid
        motions (r,)."""
        return self.condensed.displacement(forces, self.factor, motion)
