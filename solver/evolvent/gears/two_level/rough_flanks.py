"""Approximate compliance matrix of fine flanks, for the preconditioner of Newton steps.

Each tooth by itself has normal components only, which are few numbers; its bending under smooth loads and the
coupling of teeth are modes of all components. Good to a few per cent.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag, cholesky, solve_triangular

from evolvent.contact.newton.block_inverse import NearlyNormal, few_modes
from evolvent.fem.surface import Surface
from evolvent.gears.two_level.flank_window import FlankWindow
from evolvent.gears.two_level.refined_level import RefinedLevel
from evolvent_meshes.arrays import Floats, Ints, Singles

SMOOTH = ((0, 0), (0, 1), (1, 0), (1, 1), (0, 2), (2, 0))
"""Powers of radius and height in the normal loads under which a tooth's bending is told from the rest. GMRES
took 12 iterations in a frictional Newton step of Yang's pair at standard with none, 8 with the first three, 7 with all,
when contacts were in the space of the pinion's flank. Tangential loads of the same kind save but one product in thirty.
"""
COUPLED = 3e-3
"""Fraction of the largest coupling between teeth below which a coupling is left out."""


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
        masses = tuple(tooth.map.projection.mass for tooth in window.teeth if tooth.map.projection is not None)
        return NearlyNormal(tuple(self._blocks(window, bending)), window.smooth(modes), sizes, masses)

    def _bending(self, nodes: Ints, C: Floats) -> Floats:
        """U (c·3, b): how a tooth with compliance C (c·3, c·3) between some coarse nodes moves under normal loads that
        are polynomials of radius and height, C ≈ U Uᵀ for such loads (Nyström)."""
        x = self.flank.points[nodes]
        r, z = (np.interp(v, [v.min(), v.max()], [-1.0, 1.0]) for v in (np.hypot(x[:, 0], x[:, 1]), x[:, 2]))
        load = np.stack([r**i * z**j for i, j in SMOOTH], axis=1)
        P = (self.flank.normals[nodes][:, :, None] * load[:, None]).reshape(-1, len(SMOOTH))
        moved = C @ P
        return np.asarray(solve_triangular(cholesky(P.T @ moved, lower=True), moved.T, lower=True).T)

    def _blocks(self, window: FlankWindow, bending: Sequence[Floats]) -> Iterator[Singles]:
        """Normal compliance B C Bᵀ (n, n) [mm⁵/N] of each tooth's part of the contact without its bending, Π = M⁻¹ B
        the mortar projection of the flank."""
        tiles = [level.normal.among(at.strips) for level, at in zip(self.levels, window.levels)]
        first = np.zeros(len(self.levels), dtype=int)  # of a tooth's nodes
        for tooth, C, U in zip(window.teeth, window.ring.own, bending):
            assert tooth.map.projection is not None  # flanks in levels have contact lattices
            N = tooth.map.projection.mixed.astype(np.float32)
            tested = np.zeros((N.shape[0],) * 2, dtype=np.float32)
            for i in reversed(range(len(self.levels))):
                tiles[i].add_sandwiched(tested, N, first[i])
                transfer = self.levels[i].transfer[tooth.nodes[i + 1]][:, tooth.nodes[i]]
                N = (N @ transfer.astype(np.float32)).tocsr()
            first += [len(nodes) for nodes in tooth.nodes[1:]]
            whole = N.toarray()
            tested += whole @ self._rest(tooth.nodes[0], C, U) @ whole.T
            yield tested

    def _rest(self, nodes: Ints, C: Floats, bending: Floats) -> Singles:
        """Normal compliance (c, c) [mm/N] between some coarse nodes (c,) of a tooth without its bending. C (c·3, c·3):
        of all components."""
        n = self.flank.normals[nodes]
        U = np.einsum("iab,ia->ib", bending.reshape(-1, 3, bending.shape[1]), n)
        half = np.einsum("iaj,ia->ij", C.reshape(len(n), 3, -1), n)
        rest = np.einsum("ijb,jb->ij", half.reshape(len(n), -1, 3), n) - U @ U.T
        return np.asarray(rest, dtype=np.float32)
