"""The compliance of fine flanks roughly, as a matrix, for the preconditioner of Newton steps.

Of each tooth by itself the normal components only, which are few numbers; how it bends under smooth loads, and what
couples teeth, are modes of all components. Good to a few per cent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.linalg import block_diag, cholesky, solve_triangular

from evolvent.contact.newton.block_inverse import NearlyNormal
from evolvent.fem.surface import Surface
from evolvent.gears.two_level.flank_window import FlankWindow, ToothWindow
from evolvent.gears.two_level.strips import StripCorrection
from evolvent_meshes.arrays import Floats, Ints, Singles

SMOOTH = ((0, 0), (0, 1), (1, 0), (1, 1), (0, 2), (2, 0))
"""Powers of radius and height in the loads under which a tooth's bending is told from the rest. GMRES iterations of a
frictional Newton step of Yang's pair at standard with none, the first three, all six: 12, 8, 7."""
COUPLED = 3e-3
"""Of the largest coupling between teeth: what is smaller is left out."""


@dataclass(frozen=True)
class RefinedLevel:
    """A flank finer than the one before.

    transfer: (n, c) shape functions of the level before at the nodes.
    correction: what its cells change, in the frame of tooth 0.
    normals: (n, 3) at the nodes of the flank.
    """

    transfer: sp.csr_matrix
    correction: StripCorrection
    normals: Floats


@dataclass(frozen=True)
class RoughFlanks:
    """The flanks of a gear.

    flank: of the coarse sector.
    levels: from the coarsest to the finest.
    """

    flank: Surface
    levels: Sequence[RefinedLevel]

    def nearly(self, window: FlankWindow) -> NearlyNormal:
        """The compliance of a window, roughly."""
        coupling, size = window.ring.leading(COUPLED)
        bending = [self._bending(t.nodes[0], C) for t, C in zip(window.teeth, window.ring.own)]
        modes = np.hstack([coupling, block_diag(*bending)])
        sizes = np.append(size, np.ones(modes.shape[1] - len(size)))
        blocks = [self._block(*each) for each in zip(window.teeth, window.ring.own, bending)]
        return NearlyNormal(tuple(blocks), window.smooth(modes), sizes)

    def _bending(self, nodes: Ints, C: Floats) -> Floats:
        """U (c·3, b): how a tooth with compliance C (c·3, c·3) between some coarse nodes moves under loads of each
        direction that are polynomials of radius and height, C ≈ U Uᵀ for such loads (Nyström)."""
        x = self.flank.points[nodes]
        r, z = (np.interp(v, [v.min(), v.max()], [-1.0, 1.0]) for v in (np.hypot(x[:, 0], x[:, 1]), x[:, 2]))
        P = np.kron(np.stack([r**i * z**j for i, j in SMOOTH], axis=1), np.eye(3))
        moved = C @ P
        return np.asarray(solve_triangular(cholesky(P.T @ moved, lower=True), moved.T, lower=True).T)

    def _block(self, tooth: ToothWindow, C: Floats, bending: Floats) -> Singles:
        """(n, n) normal compliance of a tooth's part of the contact without its bending [mm/N]."""
        lattice = self.levels[-1].correction.lattice
        N = lattice.interpolation(tooth.map.opposite(lattice.at(tooth.nodes[-1])))
        result: Singles = np.zeros((N.shape[0],) * 2, dtype=np.float32)
        for level, own in zip(reversed(self.levels), reversed(self._normal)):
            used = np.unique(N.indices)
            result += _between(N[:, used], own[used][:, used].toarray())
            N = (N @ level.transfer).tocsr()
        place = np.full(N.shape[1], -1)
        place[tooth.nodes[0]] = np.arange(len(tooth.nodes[0]))
        used = np.unique(N.indices)
        k, n = place[used], self.flank.normals[used]
        among = C.reshape(len(tooth.nodes[0]), 3, -1, 3)[k][:, :, k]
        U = np.einsum("iab,ia->ib", bending.reshape(-1, 3, bending.shape[1])[k], n)
        rest = np.einsum("iajb,ia,jb->ij", among, n, n, optimize=True) - U @ U.T
        return result + _between(N[:, used], rest)

    @cached_property
    def _normal(self) -> list[sp.csr_matrix]:
        """Of each level, (n, n) correction between normal components [mm/N]."""
        return [level.correction.normal(level.normals) for level in self.levels]


def _between(N: sp.csr_matrix, C: Floats | Singles) -> Singles:
    """N C Nᵀ in single precision."""
    N = N.astype(np.float32)
    return np.asarray(N @ (N @ C.astype(np.float32)).T)
