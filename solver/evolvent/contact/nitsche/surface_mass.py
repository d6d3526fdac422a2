"""Mass matrix of a surface, factored once for all that is projected with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from scipy.linalg import cho_factor, cho_solve

from evolvent.fem.lagrange import quadrature, tabulate
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints, Singles


@dataclass(frozen=True, eq=False)
class SurfaceMass:
    """Mass matrix M between n nodes.

    matrix: ∫N_k N_l (n, n) [mm²; mm in 2D].
    """

    matrix: sp.csr_matrix

    @staticmethod
    def of(surface: Surface, facets: Ints, nodes: Ints) -> SurfaceMass:
        """Mass matrix of some facets of a surface, between the sorted nodes (n,) of these."""
        xi, w = quadrature(surface.shape, 2 * surface.order + 2)
        N, dN = tabulate(surface.shape, surface.order, xi)
        tangents = np.einsum("fka,qtk->fqta", surface.points[surface.facets[facets]], dN)
        area = np.sqrt(np.linalg.det(np.einsum("fqsa,fqta->fqst", tangents, tangents)))
        values = np.einsum("fq,qi,qj->fij", w * area, N, N, optimize=True)
        local = np.searchsorted(nodes, surface.facets[facets])
        i, j = np.broadcast_arrays(local[:, :, None], local[:, None, :])
        return SurfaceMass(sp.csr_matrix((values.ravel(), (i.ravel(), j.ravel())), (len(nodes), len(nodes))))

    @staticmethod
    def stacked(parts: Sequence[SurfaceMass]) -> SurfaceMass:
        """Mass matrix of several surfaces, their nodes in one list."""
        return SurfaceMass(sp.block_diag([part.matrix for part in parts], format="csr"))

    def solved(self, values: Floats) -> Floats:
        """Solution M⁻¹ values, (n, ...)."""
        flat = np.asarray(values, dtype=float).reshape(len(values), -1)
        return np.asarray(self._factor.solve(flat)).reshape(values.shape)

    def sandwiched(self, tested: Singles) -> Singles:
        """M⁻¹ tested M⁻¹ of a symmetric matrix (n, n), in single precision."""
        factor = cho_factor(self.matrix.toarray().astype(np.float32), overwrite_a=True, check_finite=False)
        half = cho_solve(factor, tested, check_finite=False)
        return np.asarray(cho_solve(factor, half.T, check_finite=False))

    @cached_property
    def _factor(self) -> spla.SuperLU:
        return spla.splu(self.matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})

    def __getstate__(self) -> dict[str, Any]:
        """State without the factor, which cannot be sent between ranks."""
        return {"matrix": self.matrix}
