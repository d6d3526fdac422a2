"""Inertia of a body in its mean axes: rigid motions and deformation that have none in common.

The displacement of a body is u = R δ' + w, with w zero where the body is held or coupled (`fem.body`). In mean axes,

    u = R δ + ŵ ,   ŵ = w − R m⁻¹ RᵀM w ,   δ = δ' + m⁻¹ RᵀM w ,   m = RᵀMR ,

the mass matrix has two blocks, m for δ and M̂ = M − M R m⁻¹ RᵀM for w (Craig and Kurdila, Fundamentals of Structural
Dynamics, 2006, 17.2). Only rigid motions that are free belong to R.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from evolvent.fem.body import Assembled
from evolvent.fem.mass_matrix import mass_matrix
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class MeanAxes:
    """Inertia of a body with N nodes, n free degrees of freedom and r rigid motions, s of them free."""

    assembled: Assembled
    """Assembled body."""
    mass: sp.csr_matrix
    """Mass matrix M (N·d, N·d) [t]."""

    @staticmethod
    def of(assembled: Assembled) -> MeanAxes:
        """Inertia of an assembled body in its mean axes. Raises CompileError, CacheError."""
        return MeanAxes(assembled, mass_matrix(assembled.body))

    @cached_property
    def motions(self) -> Floats:
        """Shapes of all rigid motions (N·d, r)."""
        shapes = self.assembled.motions.shapes
        return shapes.reshape(self.mass.shape[0], shapes.shape[2])

    @cached_property
    def rigid_mass(self) -> Floats:
        """Inertia between all rigid motions, (r, r) [t, t·mm, t·mm²]."""
        return np.asarray(self.motions.T @ (self.mass @ self.motions))

    @cached_property
    def coupling(self) -> Floats:
        """Inertia forces M R (n, r) on the free degrees of freedom by unit accelerations of all rigid motions."""
        return np.asarray(self.mass @ self.motions)[self.assembled.free]

    @cached_property
    def carried(self) -> Floats:
        """Distribution M R m⁻¹ (n, s) of a resultant on the free rigid motions over the degrees of freedom."""
        free = self.assembled.motions.free
        return np.linalg.solve(self.rigid_mass[np.ix_(free, free)], self.coupling[:, free].T).T

    def times(self, w: Floats) -> Floats:
        """Mass M̂ w (n, ...) of deformations w (n, ...) in mean axes."""
        free = self.assembled.free
        whole = np.zeros((self.mass.shape[0], *w.shape[1:]))
        whole[free] = w
        rigid = self.coupling[:, self.assembled.motions.free]
        return np.asarray((self.mass @ whole)[free] - self.carried @ (rigid.T @ w))

    def shape(self, w: Floats) -> Floats:
        """Displacement ŵ (N·d, ...) of all degrees of freedom by deformations w (n, ...)."""
        whole = np.zeros((self.mass.shape[0], *w.shape[1:]))
        whole[self.assembled.free] = w
        return whole - self.motions[:, self.assembled.motions.free] @ (self.carried.T @ w)
