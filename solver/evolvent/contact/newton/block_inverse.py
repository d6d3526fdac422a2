"""Approximate inverse of a contact system's tangent: contacts one by one, coupled by a few smooth modes.

With A ≈ A_b + U K Uᵀ, A_b block-diagonal, and only the columns S of M = ∂F/∂J, T (f, δ) = (b, c) is f = b − M_S z with

    (I + A_b M_S) z = A_b b + U w − H δ ,   K⁻¹ w = Uᵀ f ,   Hᵀ f = c .

Each block is factored by itself, and a system of the size of (w, δ) couples them (Woodbury).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

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

    @property
    def k(self) -> int:
        """Components a node."""
        return self.size // int(self.starts[-1])

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
        contact = np.searchsorted(rough.starts, node, side="right") - 1
        self._blocks = [
            _Block.of(rough.blocks[i], node - rough.starts[i], np.where(contact == i, axis, -1), M, kept)
            for i in np.unique(contact[kept])
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
            z[block.kept] = block.solved(block.moved(b))
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
class _Component:
    """One component of one contact.

    rows: (s_a,) its unknowns among the contact's s_i.
    near: (u_a,) its active unknowns.
    A: (s_a, u_a) rough compliance between them.
    """

    rows: Ints
    near: Ints
    A: Singles


@dataclass(frozen=True)
class _Block:
    """One contact.

    kept: (s_i,) its unknowns among S.
    components: those that it has.
    factor: of I + A_b M_S.
    """

    kept: Ints
    components: tuple[_Component, ...]
    factor: tuple[Singles, Ints]

    @staticmethod
    def of(block: Singles, node: Ints, axis: Ints, M: sp.csr_matrix, kept: Ints) -> _Block:
        """block: of its nodes. node: of each active unknown; axis: component, −1 where it is of another contact."""
        mine = np.flatnonzero(axis[kept] >= 0)
        own = M[kept[mine]][:, kept[mine]]
        order = reverse_cuthill_mckee(own, symmetric_mode=False)
        mine, own = mine[order], own[order][:, order]
        rows, B, components = kept[mine], np.empty((len(mine),) * 2, dtype=np.float32, order="F"), []
        for each in np.unique(axis[rows]):
            among, near = np.flatnonzero(axis[rows] == each), np.flatnonzero(axis == each)
            A = block[np.ix_(node[rows[among]], node[near])] * np.float32(TANGENTIAL if each else 1.0)
            B[among] = _times_banded(A[:, np.searchsorted(near, rows[among])], own[among].tocsc())
            components.append(_Component(among, near, A))
        B[np.diag_indices_from(B)] += 1.0
        return _Block(mine, tuple(components), lu_factor(B, overwrite_a=True, check_finite=False))

    def moved(self, b: Floats) -> Singles:
        """A_b b (s_i,) for forces (u,) on all active unknowns."""
        result = np.empty(len(self.kept), dtype=np.float32)
        for each in self.components:
            result[each.rows] = each.A @ b[each.near].astype(np.float32)
        return result

    def solved(self, right: Singles) -> Singles:
        """(I + A_b M_S)⁻¹ right, (s_i, ...)."""
        return np.asarray(lu_solve(self.factor, right, check_finite=False))


def _times_banded(A: Singles, M: sp.csc_matrix) -> Singles:
    """A M for a matrix M with few diagonals, ordered so: ten times faster than a sparse product."""
    result = np.zeros((len(A), M.shape[1]), dtype=np.float32, order="F")
    for a in range(0, M.shape[1], COLUMNS):
        part = M[:, a : a + COLUMNS]
        if part.nnz:
            low, high = part.indices.min(), part.indices.max() + 1
            result[:, a : a + COLUMNS] = A[:, low:high] @ part[low:high].toarray().astype(np.float32)
    return result
