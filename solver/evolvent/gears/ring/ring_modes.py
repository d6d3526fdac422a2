"""The coupling of a gear's teeth through the cut faces of their sectors, between a few modes.

With T the transfer from the cut faces of a sector to its flank and A the stiffness of the joined faces
(`sector_interfaces`), tooth i moves by K_ij f_j under forces on tooth j, K_ij = T (A⁻¹)_ij Tᵀ. The displacements and
forces of the faces are far smoother than the range of either T or A, and half of the digits are enough for the factors
of K_ij, since their errors enter multiplied with one another:

- T ≈ U B: T A⁻¹ Tᵀ = T A⁻¹ (UB)ᵀ + UB A⁻¹ Tᵀ − UB A⁻¹ (UB)ᵀ + (T − UB) A⁻¹ (T − UB)ᵀ, of which the last is left out.
- The faces move as V x only (Galerkin): the error of T A⁻¹ Tᵀ is the squared distance, in energy, of A⁻¹Tᵀ from V.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import block_diag, cholesky, eigh, solve_triangular, svd

from evolvent.fem.condensation.schur_complement import SectorCondensation
from evolvent.gears.ring.sector_interfaces import ClosedRing
from evolvent_meshes.arrays import Floats, Ints

# A ring gives way up to 6,000 times more than a face between held ones (60 teeth of 2.1 mm, bore 20 mm). Smooth faces
# alone then gave an error of 1.6e-10 at a tolerance of 1e-10; this much closer they give 7e-12.
SOFTNESS = 3.0


@dataclass(frozen=True)
class Coupling:
    """K_ij ≈ modes · blocks[which[i, j]] · modesᵀ.

    modes: (m, r), orthonormal columns.
    blocks: (n, r, r), the different ones [mm/N].
    which: (count, count), the block of each pair of sectors.
    """

    modes: Floats
    blocks: Floats
    which: Ints

    def between(self, sector: int, other: int) -> Floats:
        """Amplitudes (r × r) [mm/N] of the displacements of `sector` under those of forces on `other`."""
        return self.blocks[self.which[sector, other]]


def coupling(
    sector: SectorCondensation, frames: sp.csr_array, joined: Callable[[Floats], ClosedRing], tolerance: float
) -> Coupling:
    """Coupling of sectors through their faces.

    frames: (2c × 2c), to the sector's own frame from frames in which the faces of neighbours agree.
    joined: makes the joined sectors from the stiffness (2q × 2q) of a sector's faces.
    tolerance: error of a K_ij relative to the largest of them (Frobenius), about.
    """
    transfer, half = sector.transfer, np.sqrt(tolerance)
    stiffness = frames.T @ sector.stiffness @ frames
    basis, reduced = compressed(transfer, half)
    faces = smooth_faces(stiffness, reduced @ frames, half / SOFTNESS)
    pair = frames @ block_diag(faces, faces)
    responses, which = joined(_between(faces, stiffness)).responses((reduced @ pair).T)
    modes = _range_of_responses(transfer, pair, responses, tolerance)
    blocks = _blocks(modes.T @ basis, modes.T @ transfer @ pair, reduced @ pair, responses, which)
    kept = _leading(blocks, tolerance)
    return Coupling(modes @ kept, kept.T @ blocks @ kept, which)


def compressed(matrix: Floats, tolerance: float, step: int = 64) -> tuple[Floats, Floats]:
    """U (m × r, orthonormal columns), B = Uᵀ matrix with ‖matrix − U B‖ ≤ tolerance ‖matrix‖; see `range_of`."""
    random = np.random.default_rng(0)  # so that a run can be repeated
    step = min(step, *matrix.shape)
    basis = range_of(lambda width: matrix @ random.standard_normal((matrix.shape[1], width)), tolerance, step)
    return basis, basis.T @ matrix


def range_of(sample: Callable[[int], Floats], tolerance: float, step: int) -> Floats:
    """Orthonormal columns U with ‖M − U Uᵀ M‖ ≤ tolerance ‖M‖ (Frobenius) for a matrix M known by samples M Ω.

    `sample(k)`: M times k new random columns, independent and normal. A block of them that U reproduces within
    the tolerance ends the search: E ‖M Ω‖² = k ‖M‖². Source: Halko, Martinsson and Tropp 2011, doi 10.1137/090771806,
    sections 4.3 and 4.4, by blocks as in Martinsson and Voronin 2016, doi 10.1137/15M1026080.
    """
    block = sample(step)
    basis, wanted = np.empty((len(block), 0)), tolerance * np.linalg.norm(block)
    while basis.shape[1] < len(block):
        block -= basis @ (basis.T @ block)
        if np.linalg.norm(block) <= wanted:
            break
        added, _ = np.linalg.qr(block[:, : len(block) - basis.shape[1]])
        # again: the remainder's columns are tiny and lose orthogonality against what is there already
        added, _ = np.linalg.qr(added - basis @ (basis.T @ added))
        basis, block = np.hstack([basis, added]), sample(step)
    return basis


def smooth_faces(stiffness: Floats, reduced: Floats, tolerance: float) -> Floats:
    """V (c × p): displacements of a cut face under the forces Bᵀ (2c × r) of sectors and by its neighbours.

    With D = S_ll + S_hh = L Lᵀ, the stiffness of a face between two held ones, A⁻¹ f = D⁻¹ f − D⁻¹ E A⁻¹ f where E
    holds S_lh and its transpose: V spans L⁻ᵀ times the range of L⁻¹ [B_lᵀ, B_hᵀ] and of L⁻¹ S_lh L⁻ᵀ and its transpose,
    each up to `tolerance` of its norm. Vᵀ D V = 1.
    """
    c = len(stiffness) // 2
    factor = cholesky(stiffness[:c, :c] + stiffness[c:, c:], lower=True)
    across = solve_triangular(factor, stiffness[:c, c:], lower=True)
    across = solve_triangular(factor, across.T, lower=True)
    loads = solve_triangular(factor, np.hstack([reduced[:, :c].T, reduced[:, c:].T]), lower=True)
    squares = across @ across.T + across.T @ across
    # squaring costs half the digits, which are not asked for
    gram = squares / np.trace(squares) + loads @ loads.T / np.linalg.norm(loads) ** 2
    values, vectors = eigh(gram)
    missed = np.cumsum(np.maximum(values, 0.0))
    return solve_triangular(factor, vectors[:, missed > tolerance**2 * missed[-1]], lower=True, trans="T")


def _range_of_responses(transfer: Floats, pair: Floats, responses: list[Floats], tolerance: float) -> Floats:
    """Orthonormal columns (m × r) of the displacements of a tooth under loads on all of them."""
    random, everything = np.random.default_rng(1), np.hstack(responses)

    def sample(width: int) -> Floats:
        return transfer @ (pair @ (everything @ random.standard_normal((everything.shape[1], width))))

    return range_of(sample, tolerance / 2, step=32)


def _blocks(turn: Floats, exact: Floats, rough: Floats, responses: list[Floats], which: Ints) -> Floats:
    """QᵀKQ (r × r) of all pairs that differ, to second order in T − U B.

    Q: modes. turn: QᵀU. exact, rough: QᵀT and B on the smooth faces. responses: (2p × columns of U) under Bᵀ.
    """
    sides = [(exact - turn @ rough / 2) @ response @ turn.T for response in responses]
    mirrored = dict(zip(which.ravel(), which.T.ravel()))  # K_ijᵀ = K_ji
    return np.array([side + sides[mirrored[i]].T for i, side in enumerate(sides)])


def _leading(blocks: Floats, tolerance: float) -> Floats:
    """Orthonormal columns (r × k) of the range of all blocks up to the tolerance."""
    vectors, values, _ = svd(np.hstack(list(blocks)), full_matrices=False)
    missed = np.sqrt(np.cumsum(values[::-1] ** 2)[::-1])
    return vectors[:, missed > tolerance / 2 * np.linalg.norm(blocks, axis=(1, 2)).max()]


def _between(faces: Floats, stiffness: Floats) -> Floats:
    """Product diag(V, V)ᵀ S diag(V, V)."""
    return np.block([[faces.T @ (part @ faces) for part in np.hsplit(rows, 2)] for rows in np.vsplit(stiffness, 2)])
