"""Approximate compliance matrix of fine flanks, for the preconditioner of Newton steps.

Each tooth by itself has normal components only, which are few numbers; its bending under smooth loads and the
coupling of teeth are modes of all components. Good to a few per cent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.linalg import block_diag, cholesky, solve_triangular

from evolvent.contact.newton.block_inverse import NearlyNormal
from evolvent.fem.surface import Surface
from evolvent.gears.two_level.flank_window import FlankWindow, ToothWindow
from evolvent.gears.two_level.refined_level import RefinedLevel
from evolvent_meshes.arrays import Floats, Ints, Singles

SMOOTH = ((0, 0), (0, 1), (1, 0), (1, 1), (0, 2), (2, 0))
"""Powers of radius and height in the normal loads under which a tooth's bending is told from the rest. GMRES iterations
of a frictional Newton step of Yang's pair at standard with none, the first three, all six: 12, 8, 7. Tangential loads
of the same kind save but one product in thirty."""
COUPLED = 3e-3
"""Fraction of the largest coupling between teeth below which a coupling is left out."""
TOGETHER = 250
"""Largest number of nodes of a group; those of neighbouring groups are coupled. With 1000, 500, 250, 120, the first
position of 23/81 teeth, 2.5 N·m on 5 mm of face, takes 504, 506, 510, 598 products and 23, 13, 7, 4 s of factoring."""


@dataclass(frozen=True)
class RoughFlanks:
    """Flanks of a gear, from which approximate compliance matrices are made.

    flank: of the coarse sector.
    levels: from the coarsest to the finest.
    """

    flank: Surface
    levels: Sequence[RefinedLevel]

    def nearly(self, window: FlankWindow) -> NearlyNormal:
        """Approximate compliance of a window, as block matrix and modes."""
        coupling, size = window.ring.leading(COUPLED)
        bending = [self._bending(t.nodes[0], C) for t, C in zip(window.teeth, window.ring.own)]
        modes = np.hstack([coupling, block_diag(*bending)])
        sizes = np.append(size, np.ones(modes.shape[1] - len(size)))
        blocks = [self._block(*each) for each in zip(window.teeth, window.ring.own, bending)]
        return NearlyNormal(tuple(blocks), window.smooth(modes), sizes)

    def _bending(self, nodes: Ints, C: Floats) -> Floats:
        """U (c·3, b): how a tooth with compliance C (c·3, c·3) between some coarse nodes moves under normal loads that
        are polynomials of radius and height, C ≈ U Uᵀ for such loads (Nyström)."""
        x = self.flank.points[nodes]
        r, z = (np.interp(v, [v.min(), v.max()], [-1.0, 1.0]) for v in (np.hypot(x[:, 0], x[:, 1]), x[:, 2]))
        load = np.stack([r**i * z**j for i, j in SMOOTH], axis=1)
        P = (self.flank.normals[nodes][:, :, None] * load[:, None]).reshape(-1, len(SMOOTH))
        moved = C @ P
        return np.asarray(solve_triangular(cholesky(P.T @ moved, lower=True), moved.T, lower=True).T)

    def _block(self, tooth: ToothWindow, C: Floats, bending: Floats) -> sp.csr_matrix:
        """Normal compliance (n, n) of a tooth's part of the contact without its bending, between nodes that are near
        along the face [mm/N]. Nodes further apart hardly change how well it preconditions."""
        lattice = self.levels[-1].correction.lattice
        x = tooth.map.opposite(lattice.at(tooth.nodes[-1]))
        layer = float(np.diff(self._heights).max())
        near, members = _groups(x[:, 2], layer, layer / self.levels[-1].correction.per_layer)
        parts = self._parts(lattice.interpolation(x), tooth, C, bending, near / layer)
        rows, columns, values = [], [], []
        for first, second in [*zip(members, members), *pairwise(members)]:
            dense = np.sum([_between(N[first], S, N[second]) for N, S in parts], axis=0)
            i, j = np.nonzero(np.abs(x[first, 2][:, None] - x[second, 2]) <= near)
            rows.append(first[i])
            columns.append(second[j])
            values.append(dense[i, j] if first is not second else 0.5 * dense[i, j])
        half = sp.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (len(x),) * 2)
        return (half + half.T).tocsr()

    def _parts(
        self, N: sp.csr_matrix, tooth: ToothWindow, C: Floats, bending: Floats, near: float
    ) -> list[tuple[sp.csr_matrix, sp.csr_matrix | Singles]]:
        """N_l, S_l of each level and of the coarse flank: the normal compliance is Σ N_l S_l N_lᵀ. N: from the finest
        nodes. near: how many coarse layers nodes are apart at most; those of a cell at either end count too."""
        parts: list[tuple[sp.csr_matrix, sp.csr_matrix | Singles]] = []
        for level in reversed(self.levels):
            used = np.unique(N.indices)
            within = near + 4 / level.correction.per_layer
            parts.append((N[:, used].astype(np.float32).tocsr(), level.normal.among(used, within)))
            N = (N @ level.transfer).tocsr()
        place = np.full(N.shape[1], -1)
        place[tooth.nodes[0]] = np.arange(len(tooth.nodes[0]))
        used = np.unique(N.indices)
        k, n = place[used], self.flank.normals[used]
        among = C.reshape(len(tooth.nodes[0]), 3, -1, 3)[k][:, :, k]
        U = np.einsum("iab,ia->ib", bending.reshape(-1, 3, bending.shape[1])[k], n)
        rest = np.einsum("iajb,ia,jb->ij", among, n, n, optimize=True) - U @ U.T
        return [*parts, (N[:, used].astype(np.float32).tocsr(), rest.astype(np.float32))]

    @cached_property
    def _heights(self) -> Floats:
        """Heights of the layers' limits in the coarse flank [mm]."""
        return np.unique(np.round(self.flank.points[:, 2], 9))[::2]


def _groups(z: Floats, near: float, least: float) -> tuple[float, list[Ints]]:
    """Nodes with heights z (n,) in groups that are `near` high [mm], halved until none has more nodes than TOGETHER or
    they are no higher than `least`, the distance of two levels of nodes; and how high that is."""
    while True:
        group = ((z - z.min()) / near).astype(np.int64)
        sizes = np.bincount(group)
        if sizes.max() <= TOGETHER or near <= least:
            return near, [np.flatnonzero(group == each) for each in range(len(sizes))]
        near *= 0.5


def _between(N: sp.csr_matrix, S: sp.csr_matrix | Singles, M: sp.csr_matrix) -> Singles:
    """Product N S Mᵀ as a dense matrix."""
    rows, columns = np.unique(N.indices), np.unique(M.indices)
    among = S[rows][:, columns]
    dense = among.toarray() if sp.issparse(among) else among
    return np.asarray(N[:, rows] @ (M[:, columns] @ dense.T).T)
