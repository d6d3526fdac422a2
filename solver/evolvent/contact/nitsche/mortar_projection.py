"""Mortar projection of the trace of surface 2 onto the nodal space of surface 1.

M Π = B with M = ∫N_1 N_1 and B = ∫N_1 N_2∘π. M⁻¹ is dense, M and B are sparse: Π is applied to a few columns by
solving with the factored M, and written out to be applied to many.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp

from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent_meshes.arrays import Floats, Ints

MANY = 0.25
"""Number of columns, over those of Π itself, from which on Π is computed as a matrix. With 360 nodes and as many
columns as a compliance has, this takes a fifth of the time, and Π is no larger than the columns."""
ROUNDING = 1e-15
"""Entry of the projection, over the largest one, below which it is a rounding error."""


@dataclass(frozen=True)
class MortarProjection:
    """Mortar projection Π (n, n2).

    mass: M, shared by what is projected onto the same space.
    mixed: B (n, n2) [mm²; mm in 2D].
    """

    mass: SurfaceMass
    mixed: sp.csr_matrix

    @property
    def shape(self) -> tuple[int, int]:
        """Shape (n, n2) of Π."""
        n, n2 = self.mixed.shape
        return n, n2

    @cached_property
    def columns(self) -> Ints:
        """The nodes of surface 2 that Π reads, sorted."""
        return np.unique(self.mixed.indices)

    def __matmul__(self, values: Floats) -> Floats:
        """Projected values Π values, (n, ...) from (n2, ...)."""
        columns = np.asarray(values, dtype=float).reshape(len(values), -1)
        if columns.shape[1] < MANY * self.mixed.shape[1]:
            return self.mass.solved(_times(self.mixed, values))
        return np.asarray(self._dense @ columns).reshape(-1, *values.shape[1:])

    def transposed(self, values: Floats) -> Floats:
        """Transposed projection Πᵀ values, (n2, ...) from (n, ...)."""
        return _times(self._mixed_transposed, self.mass.solved(values))

    def at(self, columns: Ints) -> Floats:
        """Some columns of Π, (n, c)."""
        return self.mass.solved(self.mixed[:, columns].toarray())

    def matrix(self) -> sp.csr_matrix:
        """Sparse matrix Π (n, n2), without entries that are rounding errors."""
        dense = self.at(self.columns)
        dense[np.abs(dense) < ROUNDING * np.abs(dense).max(initial=0.0)] = 0.0
        block = sp.csr_matrix(dense)
        return sp.csr_matrix((block.data, self.columns[block.indices], block.indptr), self.shape)

    def of_columns(self) -> MortarProjection:
        """Projection Π from only the nodes of surface 2 that it reads, (n, columns)."""
        return MortarProjection(self.mass, self.mixed[:, self.columns].tocsr())

    @staticmethod
    def stacked(projections: Sequence[MortarProjection]) -> MortarProjection:
        """Several projections side by side, block-diagonal."""
        mixed = sp.block_diag([each.mixed for each in projections], format="csr")
        return MortarProjection(SurfaceMass.stacked([each.mass for each in projections]), mixed)

    @cached_property
    def _dense(self) -> Floats:
        """Dense matrix Π (n, n2)."""
        return self.mass.solved(self.mixed.toarray())

    @cached_property
    def _mixed_transposed(self) -> sp.csr_matrix:
        return self.mixed.T.tocsr()

    def __getstate__(self) -> dict[str, Any]:
        """State without what is computed from it."""
        return {"mass": self.mass, "mixed": self.mixed}


def _times(matrix: sp.csr_matrix, values: Floats) -> Floats:
    """A sparse matrix applied along the first axis of values (n, ...)."""
    flat = matrix @ values.reshape(len(values), -1)
    return np.asarray(flat).reshape(-1, *values.shape[1:])
