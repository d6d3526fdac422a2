"""Approximate compliance matrix of fine flanks, for the preconditioner of Newton steps.

Each tooth by itself has normal components only, which are few numbers; its bending under smooth loads and the
coupling of teeth are modes of all components. Good to a few per cent.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
import scipy.sparse as sp
from scipy.linalg import block_diag, cholesky, solve_triangular

from evolvent.contact.newton.block_inverse import NearlyNormal, few_modes
from evolvent.fem.surface import Surface
from evolvent.gears.two_level.flank_window import FlankWindow
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
SPARSE = 20.0
"""How much longer an entry of a sparse matrix takes than one of a dense matrix in a product."""

Part = Callable[[tuple[int, int], tuple[int, int]], Singles]
"""Part of a matrix: rows and columns from the first to before the last of each pair."""


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
        modes, sizes = few_modes(modes, np.append(size, np.ones(modes.shape[1] - len(size))))
        return NearlyNormal(tuple(self._blocks(window, bending)), window.smooth(modes), sizes)

    def _bending(self, nodes: Ints, C: Floats) -> Floats:
        """U (c·3, b): how a tooth with compliance C (c·3, c·3) between some coarse nodes moves under normal loads that
        are polynomials of radius and height, C ≈ U Uᵀ for such loads (Nyström)."""
        x = self.flank.points[nodes]
        r, z = (np.interp(v, [v.min(), v.max()], [-1.0, 1.0]) for v in (np.hypot(x[:, 0], x[:, 1]), x[:, 2]))
        load = np.stack([r**i * z**j for i, j in SMOOTH], axis=1)
        P = (self.flank.normals[nodes][:, :, None] * load[:, None]).reshape(-1, len(SMOOTH))
        moved = C @ P
        return np.asarray(solve_triangular(cholesky(P.T @ moved, lower=True), moved.T, lower=True).T)

    def _blocks(self, window: FlankWindow, bending: Sequence[Floats]) -> Iterator[sp.csr_matrix]:
        """Normal compliance (n, n) of each tooth's part of the contact without its bending, between nodes that are near
        along the face [mm/N]. Nodes further apart hardly change how well it preconditions."""
        lattice = self.levels[-1].correction.lattice
        points = [tooth.map.opposite(lattice.at(tooth.nodes[-1])) for tooth in window.teeth]
        layer = float(np.diff(self._heights).max())
        least = layer / self.levels[-1].correction.per_layer
        groups = [_groups(x[:, 2], layer, least) for x in points]
        apart = max(near for near, _ in groups) / layer
        tiles = [  # nodes of a cell at either end of what is near count too
            level.normal.among(at.strips, apart + 4 / level.correction.per_layer)
            for level, at in zip(self.levels, window.levels)
        ]
        starts = np.zeros(len(self.levels), dtype=int)  # of a tooth's nodes
        for tooth, C, U, x, (near, members) in zip(window.teeth, window.ring.own, bending, points, groups):
            parts: list[tuple[sp.csr_matrix, Part]] = []
            N = lattice.interpolation(x)
            for level, among, nodes, start in list(zip(self.levels, tiles, tooth.nodes[1:], starts))[::-1]:
                number = among.number[start : start + len(nodes)]
                parts.append((_of_columns(N, nodes, number, len(among.number)), among.part))
                N = (N @ level.transfer).tocsr()
            starts += [len(nodes) for nodes in tooth.nodes[1:]]
            order = np.argsort(self.flank.points[tooth.nodes[0], 2], kind="stable")
            rest = self._rest(tooth.nodes[0], C, U)[np.ix_(order, order)]
            number = np.arange(len(order))
            parts.append((_of_columns(N, tooth.nodes[0][order], number, len(rest)), partial(_part, rest)))
            yield _near_rows(x[:, 2], near, members, parts)

    def _rest(self, nodes: Ints, C: Floats, bending: Floats) -> Singles:
        """Normal compliance (c, c) [mm/N] between some coarse nodes (c,) of a tooth without its bending. C (c·3, c·3):
        of all components."""
        n = self.flank.normals[nodes]
        U = np.einsum("iab,ia->ib", bending.reshape(-1, 3, bending.shape[1]), n)
        half = np.einsum("iaj,ia->ij", C.reshape(len(n), 3, -1), n)
        rest = np.einsum("ijb,jb->ij", half.reshape(len(n), -1, 3), n) - U @ U.T
        return np.asarray(rest, dtype=np.float32)

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


def _near_rows(
    z: Floats, near: float, members: Sequence[Ints], parts: Sequence[tuple[sp.csr_matrix, Part]]
) -> sp.csr_matrix:
    """Sum Σ N S Nᵀ (n, n) of the parts N, S between nodes with heights z (n,) that are `near` at most [mm], group by
    group."""
    none = np.zeros(0, dtype=np.int64)
    below, under = np.zeros((0, len(members[0])), dtype=np.float32), none
    data, indices, counts = [], [], []
    for here, above in zip(members, [*members[1:], none]):
        both = np.concatenate([here, above])
        dense = np.sum([_between(N[here], S, N[both]) for N, S in parts], axis=0)
        row, columns = np.hstack([below.T, dense]), np.concatenate([under, both])
        is_near = np.abs(z[here][:, None] - z[columns]) <= near
        data.append(row[is_near])
        indices.append(np.broadcast_to(columns, row.shape)[is_near])
        counts.append(np.count_nonzero(is_near, axis=1))
        below, under = dense[:, len(here) :], here
    ends = np.append(0, np.cumsum(np.concatenate(counts)))
    grouped = sp.csr_matrix((np.concatenate(data), np.concatenate(indices), ends), (len(z), len(z)))
    return grouped[np.argsort(np.concatenate(members))]


def _between(N: sp.csr_matrix, S: Part, M: sp.csr_matrix) -> Singles:
    """Product N S Mᵀ as a dense matrix."""
    if not N.nnz:
        return np.zeros((N.shape[0], M.shape[0]), dtype=np.float32)
    (N, rows), (M, columns) = _narrowed(N), _narrowed(M)
    return np.asarray(_times(M, _times(N, S(rows, columns)).T).T)


def _times(N: sp.csr_matrix, dense: Singles) -> Singles:
    """Product with a dense matrix."""
    if N.shape[0] * N.shape[1] < SPARSE * N.nnz:
        return np.asarray(N.toarray() @ dense)
    return np.asarray(N @ np.ascontiguousarray(dense))


def _narrowed(N: sp.csr_matrix) -> tuple[sp.csr_matrix, tuple[int, int]]:
    """N from its first to its last column that is not zero; number of the first and of the one after the last."""
    low, high = int(N.indices.min()), int(N.indices.max()) + 1
    return sp.csr_matrix((N.data, N.indices - low, N.indptr), (N.shape[0], high - low)), (low, high)


def _of_columns(N: sp.csr_matrix, nodes: Ints, number: Ints, size: int) -> sp.csr_matrix:
    """N in single precision from `size` values; `number` (k,) is that of each of its nodes (k,), others have none."""
    place = np.zeros(N.shape[1], dtype=N.indices.dtype)
    place[nodes] = number
    return sp.csr_matrix((N.data.astype(np.float32), place[N.indices], N.indptr), (N.shape[0], size))


def _part(whole: Singles, rows: tuple[int, int], columns: tuple[int, int]) -> Singles:
    """Part of a matrix."""
    return whole[slice(*rows), slice(*columns)]
