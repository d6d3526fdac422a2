"""The compliance of all bodies of a step in the local jumps of its contacts, of which no more is made than is needed.

A = Σ E_b C_b E_bᵀ. As a matrix it takes most of the time of a small step. Where no contact has friction, Newton's
method needs its normal components only, a ninth of the matrix in 3D; tangential jumps are then products with forces.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.contact.newton.jump_compliance import ActiveCompliance, DenseCompliance
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class BodiesCompliance:
    """A `JumpCompliance` of n nodes with k components, from bodies with m functionals.

    maps: E of each body (n·k, m), from its functionals to jumps.
    parts: C of each (m, m) [mm/N].
    k: components a node.
    """

    maps: Sequence[sp.csr_matrix]
    parts: Sequence[Floats]
    k: int

    @cached_property
    def matrix(self) -> Floats:
        """Matrix A (n·k, n·k) [mm/N], computed when it is first needed."""
        return self._summed(1)

    @cached_property
    def _normal(self) -> DenseCompliance:
        return DenseCompliance(self._summed(self.k), 1)

    @property
    def nbytes(self) -> int:
        """Memory of the matrix [bytes]; the compliances of the bodies are shared."""
        return self.matrix.nbytes

    def times(self, force: Floats) -> Floats:
        """Jumps A f (n·k,) [mm] under forces f (n·k,) [N]."""
        return np.asarray(sum(E @ (C @ (E.T @ force)) for E, C in zip(self.maps, self.parts)))

    def active(self, unknowns: Ints) -> ActiveCompliance:
        """Compliance matrix between some unknowns (u,)."""
        return DenseCompliance(self.matrix, self.k).active(unknowns)

    def normal(self) -> DenseCompliance:
        """Compliance matrix (n, n) between normal components alone."""
        return self._normal

    def _summed(self, every: int) -> Floats:
        """Compliance matrix between every first, second, ... of the jumps."""
        total: Floats = np.zeros((self.maps[0].shape[0] // every,) * 2)
        for E, C in zip(self.maps, self.parts):
            rows = E[::every]
            total += rows @ (rows @ C.T).T
        return total
