"""Change of a surface's compliance by Nitsche's functionals, from the compliance without them.

The extended trace is P − F, with displacements P u and flux F u, and the stiffness K − FᵀWF. By the
Sherman-Morrison-Woodbury formula (Hager 1989, doi 10.1137/1031049) its compliance is

    (P − F) (K − FᵀWF)⁻¹ (P − F)ᵀ = (P − F) K⁻¹ (P − F)ᵀ + B (W⁻¹ − F K⁻¹ Fᵀ)⁻¹ Bᵀ,    B = (P − F) K⁻¹ Fᵀ,

so that K alone is eliminated, whose graph is that of the mesh; K − FᵀWF couples nodes two cells apart.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.linalg import LinAlgError, cho_solve, cholesky, solve_triangular

from evolvent.fem.condensation.mumps import not_positive_definite
from evolvent_meshes.arrays import Floats, Ints


def flux_change(both: Floats, weight: sp.csr_matrix, columns: Ints) -> Floats:
    """Columns (m, c) of (P − F) (K − FᵀWF)⁻¹ (P − F)ᵀ − P K⁻¹ Pᵀ [mm/N].

    both: (2m, 2m) compliance [P; F] K⁻¹ [P; F]ᵀ [mm/N].
    weight: W (m, m), symmetric positive definite [N/mm].
    columns: (c,) which.
    Raises NotPositiveDefinite where K − FᵀWF is not: γ is too small.
    """
    m = weight.shape[0]
    cross, flux = both[:m, m:], both[m:, m:]
    inner = weight.toarray() - weight @ (weight @ flux).T  # W − W C_FF W, as W⁻¹ is full
    coupling = weight @ (cross - flux).T
    try:
        L = cholesky(inner, lower=True, overwrite_a=True, check_finite=False)
    except LinAlgError:
        raise not_positive_definite(m, 1) from None
    if 2 * len(columns) < m:  # 4m²c operations instead of 2m³
        added = coupling.T @ cho_solve((L, True), coupling[:, columns], overwrite_b=True, check_finite=False)
    else:
        half = solve_triangular(L, coupling, lower=True, overwrite_b=True, check_finite=False)
        added = (half.T @ half)[:, columns]
    return np.asarray(added + flux[:, columns] - cross[:, columns] - cross[columns].T)
