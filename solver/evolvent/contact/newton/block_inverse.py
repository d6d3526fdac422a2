"""Approximate inverse of a contact system's tangent: contacts one by one, coupled by a few smooth modes.

With A ≈ A_b + U K Uᵀ, A_b block-diagonal, and only the columns S of M = ∂F/∂J, T (f, δ) = (b, c) is f = b − M_S z with

    (I + A_b M_S) z = A_b b + U w − H δ ,   K⁻¹ w = Uᵀ f ,   Hᵀ f + D δ = c .

Each block is factored by itself, and a system of the size of (w, δ) couples the blocks (Woodbury).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lu_factor, lu_solve

from evolvent.contact.newton.reduced_tangent import FreeMotions
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent_meshes.arrays import Bools, Floats, Ints, Reals, Singles

TANGENTIAL = 1.2
"""Tangential over normal compliance of the surface of a half-space, (1 − ν/2)/(1 − ν) at ν = 0.3 (Johnson 1985, 3.2 and
3.6)."""
NEGLIGIBLE = 1e-3
"""Amount of an orthogonal mode over the largest one, up to which the blocks are as large for loads as smooth as it."""


@dataclass(frozen=True)
class NearlyNormal:
    """Approximate compliance of n nodes with k components: blocks of normal components, and modes of all components.

    blocks: (n_i, n_i) of consecutive nodes, symmetric, in single precision [mm/N; with masses mm⁵/N].
    modes: U (n·k, r).
    couplings: diagonal of K (r,), not zero [mm/N].
    masses: M (n_i, n_i) of each block where the blocks are M A M, for `sum` to solve with; none where they are A.
    """

    blocks: tuple[Singles, ...]
    modes: Floats
    couplings: Floats
    masses: tuple[SurfaceMass, ...] = ()

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
        assert not self.masses
        return NearlyNormal(self.blocks, self.modes[::k], self.couplings)

    def with_modes(self, other: NearlyNormal) -> NearlyNormal:
        """Approximate compliance with the modes of another one added."""
        assert not self.masses
        couplings = np.concatenate([self.couplings, other.couplings])
        return NearlyNormal(self.blocks, np.hstack([self.modes, other.modes]), couplings)

    def of_few_modes(self) -> NearlyNormal:
        """Approximate compliance with few orthogonal modes in place of U."""
        assert not self.masses
        return NearlyNormal(self.blocks, *few_modes(self.modes, self.couplings))

    @property
    def nbytes(self) -> int:
        """Memory [bytes]."""
        return self.modes.nbytes + sum(block.nbytes for block in self.blocks)

    @staticmethod
    def sum(parts: Sequence[NearlyNormal]) -> NearlyNormal:
        """Sum of the approximate compliances of bodies with the same blocks of nodes and the same masses, as A."""
        blocks = [sum(each[1:], each[0]) for each in zip(*(part.blocks for part in parts))]
        if parts[0].masses:
            blocks = [mass.sandwiched(block) for mass, block in zip(parts[0].masses, blocks)]
        return NearlyNormal(
            tuple(blocks), np.hstack([p.modes for p in parts]), np.concatenate([p.couplings for p in parts])
        )


def few_modes(modes: Floats, couplings: Floats) -> tuple[Floats, Floats]:
    """Orthogonal modes (m, s) and amounts κ (s,) of U K Uᵀ, without those of negligible amounts. modes: U (m, r);
    couplings: diagonal of K (r,)."""
    s, V = np.linalg.eigh(modes.T @ modes)
    apart = s > np.finfo(float).eps * len(s) * s.max(initial=0.0)
    V, s = V[:, apart], np.sqrt(s[apart])  # U = (U V/s) sVᵀ, with orthonormal columns in brackets
    κ, W = np.linalg.eigh((V * s).T @ (couplings[:, None] * (V * s)))
    large = np.abs(κ) > NEGLIGIBLE * np.abs(κ).max(initial=0.0)
    return modes @ (V / s @ W[:, large]), κ[large]


@dataclass(frozen=True)
class RoughContact:
    """One contact, between its nodes with active unknowns.

    near: (u_i,) places of these among the active unknowns of all contacts.
    node: (u_i,) index of the node of each.
    axis: (u_i,) its component.
    A: (a, a) rough compliance between the normal components of its nodes, in single precision.
    """

    near: Ints
    node: Ints
    axis: Ints
    A: Singles

    @staticmethod
    def of(block: Singles, near: Ints, node: Ints, axis: Ints) -> RoughContact:
        """One contact from the compliance `block` of its nodes; `node` and `axis` (u_i,) of its active unknowns."""
        nodes, place = np.unique(node, return_inverse=True)
        return RoughContact(near, place, axis, block[np.ix_(nodes, nodes)])

    def part(self, kept: Bools) -> RoughPart:
        """The part that a tangent needs. kept: (u,) whether it keeps the column of each active unknown."""
        mine = np.flatnonzero((self.axis == 0) | kept[self.near])
        axis = self.axis[mine]
        scale = np.where(axis > 0, np.float32(TANGENTIAL), np.float32(1.0))
        A = self.A[np.ix_(self.node[mine], self.node)] * (scale[:, None] * (axis[:, None] == self.axis))
        return RoughPart(self.near[mine], self.near, A, A[:, mine])


@dataclass(frozen=True)
class RoughPart:
    """Rough compliance of one contact from its active unknowns `near` (u_i,) to its unknowns `rows` (s_i,): none
    between different components, more between tangential ones.

    A: (s_i, u_i).
    among: (s_i, s_i) between the rows.
    """

    rows: Ints
    near: Ints
    A: Singles
    among: Singles


@dataclass(frozen=True)
class RoughContacts:
    """Approximate compliance between some unknowns (u,), contact by contact.

    contacts: those with some of them.
    modes: U (u, r).
    couplings: diagonal of K (r,) [mm/N].
    """

    contacts: tuple[RoughContact, ...]
    modes: Floats
    couplings: Floats

    @staticmethod
    def of(rough: NearlyNormal, unknowns: Ints) -> RoughContacts:
        """Approximate compliance `rough` between unknowns (u,), where the normal component of their node is one too."""
        node, axis = np.divmod(unknowns, rough.k)
        contact = np.searchsorted(rough.starts, node, side="right") - 1
        contact[~np.isin(node, node[axis == 0])] = -1
        places = [(i, np.flatnonzero(contact == i)) for i in np.unique(contact[axis == 0])]
        contacts = [RoughContact.of(rough.blocks[i], at, node[at] - rough.starts[i], axis[at]) for i, at in places]
        return RoughContacts(tuple(contacts), rough.modes[unknowns], rough.couplings)


class BlockInverse:
    """Approximate inverse T⁻¹ of a tangent.

    rough: approximate compliance A between the active unknowns (u,).
    M: (u, u) among them.
    motions: H (u, r) among them and D (r, r).
    kept: columns of M that are not left out. S has the normal components of all nodes beside these.

    Raises NotConverged where a free rigid motion meets no resistance.
    """

    def __init__(self, rough: RoughContacts, M: sp.csr_matrix, motions: FreeMotions, kept: Ints) -> None:
        is_kept = np.zeros(M.shape[0], dtype=bool)
        is_kept[kept] = True
        self._parts = [contact.part(is_kept) for contact in rough.contacts if is_kept[contact.near].any()]
        rows = np.concatenate([np.zeros(0, dtype=int), *(part.rows for part in self._parts)])
        self._ends = np.cumsum([0] + [len(part.rows) for part in self._parts])
        self._M = _columns(M, rows, is_kept)
        M = self._M[rows].T.tocsr()
        self._factors = [
            _factored(part.among, M[start:end, start:end])
            for part, start, end in zip(self._parts, self._ends, self._ends[1:])
        ]
        self._smooth = np.hstack([rough.modes, -motions.jumps])
        self._under_smooth = (self._M.T @ self._smooth).T
        self._response = self._solved(self._smooth[rows])
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
        local, moved = b.astype(np.float32, copy=False), np.empty(self._ends[-1], dtype=np.float32)
        for part, start, end in zip(self._parts, self._ends, self._ends[1:]):
            moved[start:end] = part.A @ local[part.near]
        z = self._solved(moved)
        known = self._smooth.T @ b - self._under_smooth @ z
        known[len(known) - len(load) :] += load
        v = self._scale * (self._inner @ (self._scale * known))
        z += self._response @ v
        return np.concatenate([b - self._M @ z, v[len(v) - len(load) :]]).astype(right.dtype)

    def _solved(self, right: Reals) -> Floats:
        """Solution (I + A_b M_S)⁻¹ right of all contacts, (s,) or (s, c), good to single precision."""
        result = np.empty(right.shape)
        for factor, start, end in zip(self._factors, self._ends, self._ends[1:]):
            result[start:end] = lu_solve(factor, right[start:end].astype(np.float32, copy=False), check_finite=False)
        return result


def _factored(A: Singles, M: sp.csr_matrix) -> tuple[Singles, Ints]:
    """LU factors of I + A Mᵀ. Raises NotConverged where it is singular."""
    T = (M @ A.T).T  # a sparse matrix from the left is what SciPy multiplies with
    T[np.diag_indices(len(T))] += 1.0
    factor, pivots = lu_factor(T, overwrite_a=True, check_finite=False)
    if not np.all(np.diag(factor)):
        raise NotConverged("contact: wanted a tangent that can be inverted, found a singular one")
    return factor, pivots


def _columns(M: sp.csr_matrix, rows: Ints, kept: Bools) -> sp.csr_matrix:
    """Columns `rows` (s,) of M, those zero that are not kept."""
    place = np.full(M.shape[1], -1, dtype=M.indices.dtype)
    place[rows] = np.arange(len(rows))
    place[~kept] = -1
    column = place[M.indices]
    used = column >= 0
    ends = np.append(0, np.cumsum(used))[M.indptr]
    return sp.csr_matrix((M.data[used], column[used], ends), (M.shape[0], len(rows)))
