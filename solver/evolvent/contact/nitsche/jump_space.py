"""A space of its own for the jump between two surfaces, onto which both are projected."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from evolvent.contact.nitsche.mortar_projection import MortarProjection
from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats

BEYOND = 1e-6
"""Weight of the parts of cells beyond the surfaces in the projection onto a `JumpSpace`: small enough not to count, and
large enough to solve for nodes under which there is next to nothing."""


@dataclass(frozen=True)
class JumpSpace:
    """A space of its own for the jump, with n nodes between the surfaces.

    frames: (n, d, d) at its nodes.
    points: (n, d) positions of its nodes [mm].
    shape: (q, n) shape functions at the quadrature points; those of a cell are contiguous.
    mass: (n, n) ∫N_k N_l over whole cells, also where they lie beyond the surfaces [mm²; mm in 2D].
    """

    frames: Floats
    points: Floats
    shape: sp.csr_matrix
    mass: sp.csr_matrix

    def projections(self, weights: Floats, *sides: tuple[Surface, sp.csr_matrix]) -> list[MortarProjection]:
        """Mortar projections of surfaces. weights: (q,) of the points; sides: each surface with its shape functions
        (q, n_s) at them. Where cells reach beyond a surface, hardly any point may lie under a node: there it is
        continued by the values of its nearest node that any point reads, with the weight BEYOND."""
        tested, rest = self.shape.T @ sp.diags(weights), BEYOND * self.mass
        mass, result = SurfaceMass((tested @ self.shape + rest).tocsr()), []
        for surface, trace in sides:
            read = np.unique(trace.indices)
            nearest = read[cKDTree(surface.points[read]).query(self.points)[1]]
            place = np.arange(len(nearest)), nearest
            P = sp.csr_matrix((np.ones(len(nearest)), place), (len(nearest), trace.shape[1]))
            result.append(MortarProjection(mass, (tested @ trace + rest @ P).tocsr()))
        return result
