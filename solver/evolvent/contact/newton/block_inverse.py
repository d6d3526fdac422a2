"""Approximate inverse of a contact system's tangent: contacts one by one, coupled by a few smooth modes.

With A ≈ A_b + U K Uᵀ, A_b block-diagonal, and only the columns S of M = ∂F/∂J, T (f, δ) = (b, c) is f = b − M_S z with

    (I + A_b M_S) z = A_b b + U w − H δ ,   K⁻¹ w = Uᵀ f ,   Hᵀ f + D δ = c .

Each block is banded, as only nodes near each other along a contact line are coupled in it; it is factored by itself,
and a system of the size of (w, δ) couples the blocks (Woodbury).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import reverse_cuthill_mckee

from evolvent.contact.newton.band_factor import BandFactor
from evolvent.contact.newton.reduced_tangent import FreeMotions
from evolvent.contact.newton.snes import NotConverged
from evolvent_meshes.arrays import Floats, Ints, Singles

TANGENTIAL = 1.2
"""Tangential over normal compliance of the surface of a half-space, (1 − ν/2)/(1 − ν) at ν = 0.3 (Johnson 1985, 3.2 and
3.6)."""


@dataclass(frozen=True)
class NearlyNormal:
    """Approximate compliance of n nodes with k components: blocks of normal components, and modes of all components.

    blocks: (n_i, n_i) of consecutive nodes, symmetric, sparse, in single precision [mm/N].
    modes: U (n·k, r).
    couplings: diagonal of K (r,), not zero [mm/N].
    """

    blocks: tuple[sp.csr_matrix, ...]
    modes: Floats
    couplings: Floats

    @property
    def size(self) -> int:
        """Number of unknowns, n·k."""
        return len(self.modes)

    @property
    def k(self) -> int:
        """Components a node."""
        return self.size // int(self.starts[-1])

    @cached_property
    def starts(self) -> Ints:
        """First node of each block, and n."""
        return np.cumsum([0] + [block.shape[0] for block in self.blocks])

    def normal(self, k: int) -> NearlyNormal:
        """Approximate compliance between normal components alone."""
        return NearlyNormal(self.blocks, self.modes[::k], self.couplings)

    def with_modes(self, other: NearlyNormal) -> NearlyNormal:
        """Approximate compliance with the modes of another one added."""
        couplings = np.concatenate([self.couplings, other.couplings])
        return NearlyNormal(self.blocks, np.hstack([self.modes, other.modes]), couplings)

    @property
    def nbytes(self) -> int:
        """Memory [bytes]."""
        return self.modes.nbytes + sum(block.data.nbytes + block.indices.nbytes for block in self.blocks)

    @staticmethod
    def sum(parts: Sequence[NearlyNormal]) -> NearlyNormal:
        """Sum of the approximate compliances of bodies with the same blocks of nodes."""
        blocks = tuple(sum(each[1:], each[0]) for each in zip(*(part.blocks for part in parts)))
        return NearlyNormal(
            blocks, np.hstack([p.modes for p in parts]), np.concatenate([p.couplings for p in parts])
        )


class BlockInverse:
    """Approximate inverse T⁻¹ of a tangent.

    rough: approximate compliance A.
    unknowns: (u,) that are active.
    M: (u, u) among them.
    motions: H (u, r) among them and D (r, r).
    kept: S (s,), columns of M that are not left out.

    Raises NotConverged where a free rigid motion meets no resistance.
    """

    def __init__(
        self, rough: NearlyNormal, unknowns: Ints, M: sp.csr_matrix, motions: FreeMotions, kept: Ints
    ) -> None:
        self._M = M[:, kept].tocsr()
        node, axis = np.divmod(unknowns, rough.k)
        contact = np.searchsorted(rough.starts, node, side="right") - 1
        self._blocks = [
            _Block.of(rough.blocks[i], node - rough.starts[i], np.where(contact == i, axis, -1), M, kept)
            for i in np.unique(contact[kept])
        ]
        self._smooth = np.hstack([rough.modes[unknowns], -motions.jumps])
        self._under_smooth = (self._M.T @ self._smooth).T
        self._response = self._solved(self._smooth[kept])
        inner = self._under_smooth @ self._response
        count = len(rough.couplings)
        inner[np.diag_indices(count)] += 1.0 / rough.couplings
        inner[count:, count:] += motions.resistance
        self._scale = 1.0 / np.sqrt(np.abs(np.diag(inner)).clip(min=np.finfo(float).tiny))
        try:
            self._inner = np.linalg.inv(inner * self._scale * self._scale[:, None])
        except np.linalg.LinAlgError as error:
            raise NotConverged("contact: wanted nodes that resist every free rigid motion, found too few") from error

    def solve(self, right: Floats) -> Floats:
        """Solution (f, δ) (u + r,) for a right-hand side (b, c)."""
        b, load = np.split(right, [self._M.shape[0]])
        z = np.zeros(self._M.shape[1])
        for block in self._blocks:
            z[block.kept] = block.solved(block.moved(b))
        known = self._smooth.T @ b - self._under_smooth @ z
        known[len(known) - len(load) :] += load
        v = self._scale * (self._inner @ (self._scale * known))
        z += self._response @ v
        return np.concatenate([b - self._M @ z, v[len(v) - len(load) :]]).astype(right.dtype)

    def _solved(self, right: Floats) -> Floats:
        """Solution (I + A_b M_S)⁻¹ right of all blocks, (s, c)."""
        result = np.zeros_like(right)
        for block in self._blocks:
            result[block.kept] = block.solved(right[block.kept].astype(np.float32))
        return result


@dataclass(frozen=True)
class _Block:
    """One contact.

    kept: (s_i,) its unknowns among S.
    near: (u_i,) its active unknowns.
    A: (s_i, u_i) rough compliance between them.
    factor: of I + A_b M_S.
    """

    kept: Ints
    near: Ints
    A: sp.csr_matrix
    factor: BandFactor

    @staticmethod
    def of(block: sp.csr_matrix, node: Ints, axis: Ints, M: sp.csr_matrix, kept: Ints) -> _Block:
        """One contact with the factor of its block. block: of its nodes. node: of each active unknown; axis: component,
        −1 where it is of another contact."""
        near, mine = np.flatnonzero(axis >= 0), np.flatnonzero(axis[kept] >= 0)
        A = block[node[kept[mine]]]
        mine = mine[reverse_cuthill_mckee(A[:, node[kept[mine]]], symmetric_mode=True)]
        rows = kept[mine]
        A = _of_components(block[node[rows]], node[near], axis[rows], axis[near])
        factor = BandFactor(A[:, np.searchsorted(near, rows)], M[rows][:, rows].tocsc())
        return _Block(mine, near, A, factor)

    def moved(self, b: Floats) -> Singles:
        """Jumps A_b b (s_i,) for forces (u,) on all active unknowns."""
        return np.asarray(self.A @ b[self.near].astype(np.float32))

    def solved(self, right: Singles) -> Singles:
        """Solution (I + A_b M_S)⁻¹ right of the block, (s_i, ...)."""
        return self.factor.solve(right)


def _of_components(block: sp.csr_matrix, node: Ints, rows: Ints, columns: Ints) -> sp.csr_matrix:
    """Compliance (s, u) between unknowns from that of normal components (s, nodes): none between different components,
    more between tangential ones. node: (u,); rows, columns: their components."""
    parts, order = [], []
    for axis in np.unique(rows):
        of_axis, here = np.flatnonzero(columns == axis), np.flatnonzero(rows == axis)
        part = block[here][:, node[of_axis]]
        values = part.data * np.float32(TANGENTIAL if axis else 1.0)
        parts.append(sp.csr_matrix((values, of_axis[part.indices], part.indptr), (len(here), len(columns))))
        order.append(here)
    if len(parts) == 1:
        return parts[0]
    return sp.vstack(parts, format="csr")[np.argsort(np.concatenate(order))]
