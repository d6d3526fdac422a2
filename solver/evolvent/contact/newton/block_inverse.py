"""Approximate inverse of a contact system's tangent: contacts one by one, coupled by a few smooth modes.

With A ≈ A_b + U K Uᵀ, A_b block-diagonal, and only the columns S of M = ∂F/∂J, T (f, δ) = (b, c) is f = b − M_S z with

    (I + A_b M_S) z = A_b b + U w − H δ ,   K⁻¹ w = Uᵀ f ,   Hᵀ f = c .

Each block is factored by itself, and a system of the size of (w, δ) couples them (Woodbury).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.linalg import block_diag, lu_factor, lu_solve
from scipy.sparse.csgraph import reverse_cuthill_mckee

from evolvent.contact.newton.snes import NotConverged
from evolvent_meshes.arrays import Floats, Ints, Singles

TANGENTIAL = 1.2
"""Tangential over normal compliance of the surface of a half-space, (1 − ν/2)/(1 − ν) at ν = 0.3 (Johnson 1985, 3.2 and
3.6)."""
COLUMNS = 128
"""Of a banded matrix, multiplied at once."""


@dataclass(frozen=True)
class NearlyNormal:
    """A compliance of n nodes with k components, roughly: blocks of normal components, and modes of all components.

    blocks: (n_i, n_i) of consecutive nodes [mm/N].
    modes: U (n·k, r).
    couplings: diagonal of K (r,), not zero [mm/N].
    """

    blocks: tuple[Singles, ...]
    modes: Floats
    couplings: Floats

    @property
    def size(self) -> int:
        """n·k."""
        return len(self.modes)

    @cached_property
    def starts(self) -> Ints:
        """First node of each block, and n."""
        return np.cumsum([0] + [len(block) for block in self.blocks])

    def normal(self, k: int) -> NearlyNormal:
        """That of the normal components."""
        return NearlyNormal(self.blocks, self.modes[::k], self.couplings)

    @staticmethod
    def sum(parts: Sequence[NearlyNormal]) -> NearlyNormal:
        """Of bodies with the same blocks of nodes."""
        blocks = tuple(np.sum(each, axis=0) for each in zip(*(part.blocks for part in parts)))
        return NearlyNormal(
            blocks, np.hstack([p.modes for p in parts]), np.concatenate([p.couplings for p in parts])
        )


class BlockInverse:
    """T⁻¹, roughly.

    rough: A.
    k: components a node.
    unknowns: (u,) that are active.
    M, H: (u, u) and (u, r) among them.
    kept: S (s,), columns of M that are not left out.

    Raises NotConverged where a free rigid motion meets no resistance.
    """

    def __init__(
        self, rough: NearlyNormal, k: int, unknowns: Ints, M: sp.csr_matrix, H: Floats, kept: Ints
    ) -> None:
        self._M = M[:, kept].tocsr()
        node, axis = np.divmod(unknowns, k)
        self._blocks = [
            _Block.of(block, k, start, node, axis, kept, self._M)
            for block, (start, end) in zip(rough.blocks, pairwise(rough.starts))
            if np.any((node[kept] >= start) & (node[kept] < end))
        ]
        self._smooth = np.hstack([rough.modes[unknowns], -H])
        self._under_smooth = (self._M.T @ self._smooth).T
        self._response = self._solved(self._smooth[kept])
        inner = block_diag(np.diag(1.0 / rough.couplings), np.zeros((H.shape[1],) * 2))
        inner = inner[: self._smooth.shape[1], : self._smooth.shape[1]] + self._under_smooth @ self._response
        self._scale = 1.0 / np.sqrt(np.abs(np.diag(inner)).clip(min=np.finfo(float).tiny))
        try:
            self._inner = np.linalg.inv(inner * self._scale * self._scale[:, None])
        except np.linalg.LinAlgError as error:
            raise NotConverged("contact: wanted nodes that resist every free rigid motion, found too few") from error

    def solve(self, right: Floats) -> Floats:
        """(f, δ) (u + r,) for (b, c)."""
        b, load = np.split(right, [self._M.shape[0]])
        z = np.zeros(self._M.shape[1])
        for block in self._blocks:
            z[block.kept] = block.solved(block.A @ b[block.near].astype(np.float32))
        known = self._smooth.T @ b - self._under_smooth @ z
        known[len(known) - len(load) :] += load
        v = self._scale * (self._inner @ (self._scale * known))
        z += self._response @ v
        return np.concatenate([b - self._M @ z, v[len(v) - len(load) :]]).astype(right.dtype)

    def _solved(self, right: Floats) -> Floats:
        """(I + A_b M_S)⁻¹ right, (s, c)."""
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
    order: in which they are factored.
    """

    kept: Ints
    near: Ints
    A: Singles
    factor: tuple[Singles, Ints]
    order: Ints

    @staticmethod
    def of(block: Singles, k: int, start: int, node: Ints, axis: Ints, kept: Ints, M: sp.csr_matrix) -> _Block:
        near = np.flatnonzero((node >= start) & (node < start + len(block)))
        mine = np.flatnonzero(np.isin(kept, near))
        own = M[kept[mine]][:, mine]
        mine = mine[reverse_cuthill_mckee(own, symmetric_mode=False)]
        rows = kept[mine]
        A = block[np.ix_(node[rows] - start, node[near] - start)]
        if k > 1:
            A = A * _same_axis(axis[rows], axis[near])
        B = _times_banded(A[:, np.searchsorted(near, rows)], M[rows][:, mine].tocsc())
        B[np.diag_indices_from(B)] += 1.0
        return _Block(mine, near, A, lu_factor(B, overwrite_a=True, check_finite=False), rows)

    def solved(self, right: Singles) -> Singles:
        """(I + A_b M_S)⁻¹ right, (s_i, ...)."""
        return np.asarray(lu_solve(self.factor, right, check_finite=False))


def _same_axis(rows: Ints, columns: Ints) -> Singles:
    """(s, u) how compliant a component is over the normal one; zero between different ones."""
    compliant = np.where(rows == 0, 1.0, TANGENTIAL)[:, None]
    return np.where(rows[:, None] == columns, compliant, 0.0).astype(np.float32)


def _times_banded(A: Singles, M: sp.csc_matrix) -> Singles:
    """A M for a matrix M with few diagonals, ordered so: ten times faster than a sparse product."""
    result = np.zeros((len(A), M.shape[1]), dtype=np.float32, order="F")
    for a in range(0, M.shape[1], COLUMNS):
        part = M[:, a : a + COLUMNS]
        if part.nnz:
            low, high = part.indices.min(), part.indices.max() + 1
            result[:, a : a + COLUMNS] = A[:, low:high] @ part[low:high].toarray().astype(np.float32)
    return result
