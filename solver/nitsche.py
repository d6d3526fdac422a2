"""The contact operator of one pair of surfaces at one position.

At node j of surface 1, with hat function ψ_j and m_j = ∫ψ_j over the part of surface 1 that faces surface 2:

    J_j = (1/m_j) ∫ψ_j (e_1 − u_2∘π),  e_1 = u_1 − F the extended trace of body 1     (weighted jump)
    G_j = (1/m_j) ∫ψ_j g n·n_j                                                        (weighted gap)
    λ_j = [γ_j(n_j·J_j − G_j)]_+ ,  τ_j = P_B(μλ_j)(γ_t,j (J_j + s_j)_t)

and the nodal contact force f_j = m_j(λ_j n_j + τ_j) presses −f on body 1 and +f on body 2 through the same weights.
This is the one-sided Nitsche method (Chouly, Fabre, Hild, Mlika, Pousin, Renard 2017) with its flux recovered at the
nodes (solver/traction.py) and its nonlinearity evaluated there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from meshes.data import Floats, Ints
from solver.lagrange import tabulate
from solver.search import Pairing
from solver.surface import Surface, hats

NEGLIGIBLE = 1e-9  # share of a node's own weight below which its overlap with the other surface is nothing


@dataclass(frozen=True)
class ContactOperator:
    """Weighted jump and gap at the n nodes of surface 1 that face surface 2; all in the common frame.

    nodes: (n,) indices into surface 1. weights: (n,) m_j. gap: (n,) G_j [mm].
    frames: (n, d, d) rows n, t1[, t2]. jump1: (n, n1), jump2: (n, n2) the weights of J = jump1·e_1 − jump2·u_2.
    stabiliser: (n, 2) γ, γ_t.
    """

    nodes: Ints
    weights: Floats
    gap: Floats
    frames: Floats
    jump1: sp.csr_matrix
    jump2: sp.csr_matrix
    stabiliser: Floats

    @property
    def d(self) -> int:
        """Space dimension."""
        return self.frames.shape[1]

    def trial(self, jump: Floats, slip: Floats | None = None) -> Floats:
        """Trial tractions (n, d') from local jumps (n, d'), d' = 1 (normal only) or d; slip (n, d−1) is added to J_t."""
        p = self.stabiliser[:, :1] * (jump[:, :1] - self.gap[:, None])
        if jump.shape[1] == 1:
            return p
        tangential = jump[:, 1:] if slip is None else jump[:, 1:] + slip
        return np.hstack([p, self.stabiliser[:, 1:] * tangential])

    def trial_slope(self, d: int) -> Floats:
        """∂trial/∂J of each local component, (n, d)."""
        return np.hstack([self.stabiliser[:, :1]] + [self.stabiliser[:, 1:]] * (d - 1))

    def flux(self, force: Floats) -> Floats:
        """F = Γ⁻¹S (n, d) [mm] in the common frame at a converged state, where the recovered traction S is −(λn + τ);
        from local nodal forces (n, d). The true trace is u_1 = e_1 + F."""
        compliance = 1.0 / (self.weights[:, None] * self.trial_slope(self.d))
        return -np.einsum("jia,ji->ja", self.frames, force * compliance)

    def restricted(self, keep: Ints) -> ContactOperator:
        """The operator on some of its nodes only."""
        return ContactOperator(
            self.nodes[keep], self.weights[keep], self.gap[keep], self.frames[keep],
            self.jump1[keep], self.jump2[keep], self.stabiliser[keep],
        )  # fmt: skip

    def local_map(self, side: int, rotation: Floats) -> sp.csr_matrix:
        """(n·d, n_s·d): displacements of surface `side` (1 or 2), in its body's frame, to local jumps.

        rotation (d, d) turns the body's frame into the common one; the sign of the jump is included.
        """
        jump, sign = (self.jump1, 1.0) if side == 1 else (self.jump2, -1.0)
        return frames_times(self.frames @ rotation * sign, jump)


def frames_times(frames: Floats, weights: sp.csr_matrix) -> sp.csr_matrix:
    """Blocks frames_j · weights_jk: (n·d, n_s·d)."""
    n, d, _ = frames.shape
    blocks = weights.data[:, None, None] * np.repeat(frames, np.diff(weights.indptr), axis=0)
    shape = (n * d, weights.shape[1] * d)
    return sp.bsr_matrix((blocks, weights.indices, weights.indptr), shape=shape).tocsr()


def contact_operator(pairing: Pairing, first: Surface, second: Surface, stabiliser: Floats) -> ContactOperator:
    """The weighted jump and gap from the quadrature points of a search; surfaces in the common frame."""
    ψ = hats(first.shape, first.order, pairing.xi1)
    N1 = tabulate(first.shape, first.order, pairing.xi1)[0]
    N2 = tabulate(second.shape, second.order, pairing.xi2)[0]
    nodes1, nodes2 = first.facets[pairing.facet1], second.facets[pairing.facet2]
    wψ = pairing.weight[:, None] * ψ
    n1, n2 = len(first.points), len(second.points)
    m = np.bincount(nodes1.ravel(), wψ.ravel(), n1)
    keep = np.flatnonzero(m > NEGLIGIBLE * first.weights())
    average = sp.diags(1.0 / m[keep])
    x1 = np.einsum("qk,qka->qa", N1, first.points[nodes1])
    x2 = np.einsum("qk,qka->qa", N2, second.points[nodes2])
    opening = np.zeros((n1, first.points.shape[1]))
    np.add.at(opening, nodes1, wψ[:, :, None] * (x2 - x1)[:, None, :])
    normals = first.normals[keep]
    return ContactOperator(
        keep,
        m[keep],
        np.einsum("ja,ja->j", normals, opening[keep] / m[keep, None]),
        tangent_frames(normals),
        (average @ _weighted(nodes1, wψ, nodes1, N1, (n1, n1))[keep]).tocsr(),
        (average @ _weighted(nodes1, wψ, nodes2, N2, (n1, n2))[keep]).tocsr(),
        stabiliser[keep],
    )


def _weighted(rows: Ints, wψ: Floats, columns: Ints, N: Floats, shape: tuple[int, int]) -> sp.csr_matrix:
    i = np.broadcast_to(rows[:, :, None], (*rows.shape, N.shape[1]))
    j = np.broadcast_to(columns[:, None, :], i.shape)
    values = wψ[:, :, None] * N[:, None, :]
    return sp.csr_matrix((values.ravel(), (i.ravel(), j.ravel())), shape)


def tangent_frames(normals: Floats) -> Floats:
    """Orthonormal frames (n, d, d) with rows n, t1[, t2]; t1 lies in the xy plane (a gear's transverse plane)."""
    n = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    if n.shape[1] == 2:
        return np.stack([n, np.stack([-n[:, 1], n[:, 0]], axis=1)], axis=1)
    flat = np.hypot(n[:, 0], n[:, 1])
    along_z = flat < 1e-8
    t1 = np.stack([-n[:, 1], n[:, 0], np.zeros(len(n))], axis=1) / np.where(along_z, 1.0, flat)[:, None]
    t1[along_z] = (1.0, 0.0, 0.0)
    t1 -= np.einsum("ja,ja->j", t1, n)[:, None] * n
    t1 /= np.linalg.norm(t1, axis=1, keepdims=True)
    return np.stack([n, t1, np.cross(n, t1)], axis=1)


def stacked(operators: list[ContactOperator]) -> ContactOperator:
    """Several contacts as one list of nodes (their jumps stay block-diagonal)."""
    if len(operators) == 1:
        return operators[0]
    return ContactOperator(
        np.concatenate([op.nodes for op in operators]),
        np.concatenate([op.weights for op in operators]),
        np.concatenate([op.gap for op in operators]),
        np.concatenate([op.frames for op in operators]),
        sp.block_diag([op.jump1 for op in operators], format="csr"),
        sp.block_diag([op.jump2 for op in operators], format="csr"),
        np.concatenate([op.stabiliser for op in operators]),
    )
