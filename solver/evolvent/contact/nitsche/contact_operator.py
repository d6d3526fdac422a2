"""The contact operator of two paired surfaces: from jumps at nodes to tractions at points to nodal forces.

The jump between the bodies lives in the space of surface 1: J = e_1 − Πu_2 at its nodes. e_1 = u_1 − F is the extended
trace of body 1 and Π the L2 projection of body 2's trace along the normals of surface 1 (a mortar method: integrated
over segments, so that non-matching meshes pass the patch test). Or it has a space of its own (`JumpSpace`), onto which
both are projected: J = Π_1 e_1 − Π_2 u_2. The contact law holds at the quadrature points x_q:

    p(x) = γ(x) [Σ_k N_k(x) n_k·J_k − g(x)] ,   q(x) = γ_t(x) [Σ_k N_k(x) J_k + s(x)]_t
    λ = [p]_+ ,  τ = P_B(μλ)(q)                                   (local components, frames at the nodes)
    f_k = ∫ N_k (λ, τ) dΓ

The force −f acts on body 1, Πᵀf on body 2. This is the one-sided Nitsche method (Chouly, Fabre, Hild, Mlika, Pousin,
Renard 2017) with its flux recovered at the nodes (flux_recovery.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from evolvent.contact.nitsche.coulomb import LawValues
from evolvent.contact.nitsche.jump_space import BEYOND, JumpSpace
from evolvent.contact.nitsche.mortar_projection import MortarProjection
from evolvent.contact.nitsche.surface_mass import SurfaceMass
from evolvent.contact.search.pairing import Pairing
from evolvent.fem.lagrange import tabulate
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.reference_facets import hats
from evolvent.fem.surface import Surface
from evolvent_meshes.arrays import Floats, Ints

ContactLaw = Callable[[Floats], LawValues]
"""Function from trial tractions (q, k) to the law's values at the points."""


@dataclass(frozen=True)
class ContactOperator:
    """Jump at n nodes of surface 1 and contact at q points on it, in the common frame.

    nodes: (m,) indices of the nodes of surface 1 about the points: those of the jump (m = n), but where the jump has a
        space of its own.
    frames: (n, d, d) nodal frames, rows normal, t1[, t2].
    jump1: (n, n1) and
    jump2: (n, n2) weights of the jump J = jump1·e_1 − jump2·u_2.
    mass: (m, m) ∫N_k N_l over all of surface 1 about these nodes; where the jump has a space of its own, over the
        quadrature points [mm²; mm in 2D].
    trace: (q, m) shape functions of surface 1 at the points.
    shape: (q, n) shape functions of the jump at the points.
    hat: (q, m) piecewise linear hat functions of surface 1 at the points.
    points: (q, d) positions [mm].
    weights: (q,) quadrature weights [mm²; mm in 2D].
    gap: (q,) gaps without displacement [mm].
    stabiliser: (q, 2) γ and γ_t [MPa/mm].
    """

    nodes: Ints
    frames: Floats
    jump1: sp.csr_matrix | MortarProjection
    jump2: MortarProjection
    mass: SurfaceMass
    trace: sp.csr_matrix
    shape: sp.csr_matrix
    hat: sp.csr_matrix
    points: Floats
    weights: Floats
    gap: Floats
    stabiliser: Floats

    @property
    def n(self) -> int:
        """Number of nodes of the jump."""
        return len(self.frames)

    @property
    def d(self) -> int:
        """Space dimension."""
        return self.frames.shape[1]

    def pressing_along(self, normals: Floats) -> ContactOperator:
        """The operator with the pressure along other unit normals (n, d), a few degrees from those of surface 1.

        The distance along them to a surface 2 that they are normal to is g n·n_1. γ is not changed, an error of the
        order of the square of the angle.
        """
        shorter = np.einsum("ja,ja->j", normals, self.frames[:, 0])
        return replace(self, frames=tangent_frames(normals), gap=self.gap * (self.shape @ shorter))

    def before(self, jump: Floats) -> ContactOperator:
        """The operator of surfaces that were searched after displacements, with the gaps before these displacements, as
        the jumps of the solution include them; jump: (q, d) of these displacements at the points [mm]."""
        normals = self.shape @ self.frames[:, 0]
        return replace(self, gap=self.gap + np.einsum("qa,qa->q", normals, jump))

    def worn(self, depth: Floats, softness: Floats) -> ContactOperator:
        """The operator of worn surfaces: λ = γ(J − g − h − cλ), with c in series with γ.

        depth: h (q,), depth that both surfaces have lost together [mm].
        softness: c (q,), depth that they lose per pressure while it acts [mm/MPa].
        """
        γ, γ_t = self.stabiliser.T
        return replace(self, gap=self.gap + depth, stabiliser=np.column_stack([γ / (1.0 + γ * softness), γ_t]))

    def trial(self, jump: Floats, slip: Floats | None = None) -> Floats:
        """Trial tractions (q, k) [MPa] from local jumps (n, k) [mm], k = 1 (normal only) or d; slip: (q, d−1), added to
        the tangential jump at the points."""
        k, at_points = jump.shape[1], self.shape @ jump
        at_points[:, 0] -= self.gap
        if slip is not None and k > 1:
            at_points[:, 1:] += slip
        return at_points * self.slope(k)

    def slope(self, k: int) -> Floats:
        """Derivative of each trial traction by its jump at the points, (q, k) [MPa/mm]."""
        return np.hstack([self.stabiliser[:, :1]] + [self.stabiliser[:, 1:]] * (k - 1))

    def forces(self, traction: Floats) -> Floats:
        """Nodal forces f (n, k) [N] from tractions at the points (q, k) [MPa]."""
        return np.asarray(self.shape.T @ (self.weights[:, None] * traction))

    def tangent(self, law: LawValues) -> sp.csr_matrix:
        """Derivative ∂f/∂J (n·k, n·k) [N/mm], sparse, in full blocks of node pairs."""
        active = np.flatnonzero(law.derivative.any(axis=(1, 2)))
        slope = self.weights[active, None] * self.slope(law.traction.shape[1])[active]
        return sandwiched(self.shape[active], law.derivative[active] * slope[:, None])

    def averaged(self, traction: Floats) -> tuple[Floats, Floats]:
        """Weights m_j (m,) and tractions t_j (m, k) averaged with the hat functions: Σ m_j t_j is the total force."""
        m = self.hat.T @ self.weights
        mean = self.hat.T @ (self.weights[:, None] * traction)
        return m, mean / np.where(m > 0.0, m, 1.0)[:, None]

    def flux(self, traction: Floats) -> Floats:
        """F = Γ⁻¹S (m, d) [mm] at the nodes of surface 1 in the common frame, from point tractions (q, d) [MPa].

        At a converged state the recovered traction S is −(λn + τ), and the trace of body 1 is u_1 = e_1 + F. F is
        projected, not averaged: repeating it in the next step changes nothing, and no traction is smoothed.
        """
        moved = self.weights[:, None] * self.common(traction / self.slope(self.d))
        return -self.mass.solved(self.trace.T @ moved)

    def projected(self, values: Floats) -> Floats:
        """Values (n, c) at the nodes of the jump from those at the nodes of surface 1 (m, c)."""
        return self.jump1.of_columns() @ values if isinstance(self.jump1, MortarProjection) else values

    def gathered(self, forces: Floats) -> Floats:
        """Forces (n, c) on the nodes of the jump from forces (m, c) on those of surface 1: of the same tractions."""
        if not isinstance(self.jump1, MortarProjection):
            return forces
        return np.asarray(self.jump1.of_columns().mixed @ self.mass.solved(forces))

    def common(self, traction: Floats) -> Floats:
        """Vectors (q, d) in the common frame from local components (q, k)."""
        axes = [self.shape @ self.frames[:, i] for i in range(traction.shape[1])]
        return np.asarray(sum(traction[:, i : i + 1] * axis for i, axis in enumerate(axes)))

    def local_map(self, side: int, rotation: Floats) -> sp.csr_matrix:
        """Matrix (n·d, n_s·d) from displacements of surface `side` (1 or 2), in its body's frame, to local jumps, with
        the sign of the jump; rotation: (d, d), from the body's frame to the common one."""
        jump, sign = (self.jump1, 1.0) if side == 1 else (self.jump2, -1.0)
        weights = jump.matrix() if isinstance(jump, MortarProjection) else jump
        return frames_times(self.frames @ rotation * sign, weights)


def frames_times(frames: Floats, weights: sp.csr_matrix) -> sp.csr_matrix:
    """Blocks frames_j · weights_jk: (n·d, n_s·d)."""
    n, d, _ = frames.shape
    blocks = weights.data[:, None, None] * np.repeat(frames, np.diff(weights.indptr), axis=0)
    shape = (n * d, weights.shape[1] * d)
    return sp.bsr_matrix((blocks, weights.indices, weights.indptr), shape=shape).tocsr()


def sandwiched(N: sp.csr_matrix, D: Floats) -> sp.csr_matrix:
    """Matrix Σ_q N_qi D_q N_qj for N (q, n) and D (q, k, k), as (n·k, n·k) of blocks (i, j).

    The points of a facet are contiguous and have the same nodes, so that a facet's sum is a dense product: five times
    faster than k² sparse products.
    """
    n, k, width = N.shape[1], D.shape[1], np.diff(N.indptr)
    facets = [_facet_blocks(N[width == w], D[width == w], w) for w in np.unique(width)]
    if not facets:
        return sp.csr_matrix((n * k, n * k))
    pairs, place = np.unique(np.concatenate([i * n + j for i, j, _ in facets]), return_inverse=True)
    added = sp.csr_matrix((np.ones(len(place)), place, np.arange(len(place) + 1)), (len(place), len(pairs)))
    blocks = added.T @ np.concatenate([block for _, _, block in facets])
    i, j = np.divmod(pairs, n)
    rows = np.searchsorted(i, np.arange(n + 1))
    return sp.bsr_matrix((blocks.reshape(-1, k, k), j, rows), shape=(n * k, n * k)).tocsr()


def _facet_blocks(N: sp.csr_matrix, D: Floats, width: int) -> tuple[Ints, Ints, Floats]:
    """Nodes i, j and entries (·, k²) of the blocks of each run of points with the same `width` nodes."""
    nodes, values = N.indices.reshape(-1, width).astype(np.int64), N.data.reshape(-1, width)
    first = np.flatnonzero(np.append(True, (nodes[1:] != nodes[:-1]).any(axis=1)))
    right = (values[:, :, None] * D.reshape(len(D), 1, -1)).reshape(len(D), -1)
    blocks = np.stack([values[a:b].T @ right[a:b] for a, b in pairwise([*first, len(D)])])
    i, j = np.repeat(nodes[first], width, axis=1), np.tile(nodes[first], width)
    return i.ravel(), j.ravel(), blocks.reshape(i.size, -1)


def contact_operator(
    pairing: Pairing, first: Surface, second: Surface, stabiliser: Floats, frames: Floats,
    facets: Ints | None = None, jumps: JumpSpace | None = None,
) -> ContactOperator:
    """The operator on the quadrature points of a pairing.

    first, second: the surfaces in the common frame.
    stabiliser: (n1, 2) γ and γ_t at the nodes of surface 1 [MPa/mm].
    frames: (n1, d, d) at the nodes of surface 1.
    facets: those of surface 1 in whose space the jump lies; by default those that have a point.
    jumps: the space of the jump, None: that of surface 1.
    """
    facets = np.unique(pairing.facet1) if facets is None else facets
    nodes = np.unique(first.facets[facets])
    place = np.full(len(first.points), -1)
    place[nodes] = np.arange(len(nodes))
    N1 = tabulate(first.shape, first.order, pairing.xi1)[0]
    N2 = tabulate(second.shape, second.order, pairing.xi2)[0]
    ψ = hats(first.shape, first.order, pairing.xi1)
    columns1, columns2 = place[first.facets[pairing.facet1]], second.facets[pairing.facet2]
    trace, hat = _rows(columns1, N1, len(nodes)), _rows(columns1, ψ, len(nodes))
    mass, mixed = SurfaceMass.of(first, facets, nodes), _rows(columns2, N2, len(second.points))
    if jumps is None:
        chosen = sp.csr_matrix((np.ones(len(nodes)), (np.arange(len(nodes)), nodes)), (len(nodes), len(first.points)))
        shape, frames = trace, frames[nodes]
        jump1: sp.csr_matrix | MortarProjection = chosen
        jump2 = _projection(pairing, first, second, nodes, mass, trace, mixed)
    else:
        own = _rows(first.facets[pairing.facet1], N1, len(first.points))
        shape, frames = jumps.shape, jumps.frames
        jump1, jump2 = jumps.projections(pairing.weight, (first, own), (second, mixed))
        # cells of surface 1 are cut by those of the jump: only its mass at the points is consistent with forces there
        mass = SurfaceMass((trace.T @ sp.diags(pairing.weight) @ trace + BEYOND * mass.matrix).tocsr())
    return ContactOperator(
        nodes, frames, jump1, jump2, mass, trace, shape, hat,
        np.einsum("qk,qka->qa", N1, first.points[first.facets[pairing.facet1]]),
        pairing.weight,
        pairing.gap,
        1.0 / (hat @ (1.0 / stabiliser[nodes])),  # 1/γ is interpolated, as in the flux F = S/γ
    )


def _projection(
    pairing: Pairing,
    first: Surface,
    second: Surface,
    nodes: Ints,
    mass: SurfaceMass,
    N1: sp.csr_matrix,
    N2: sp.csr_matrix,
) -> MortarProjection:
    """Mortar projection Π (n, n2): M Π = ∫N_1 N_2∘π. Where surface 2 does not cover a facet, u_2 is extended from its
    nearest nodes, so that Π is defined there too and preserves constants."""
    w = sp.diags(pairing.weight)
    covered = N1.T @ w @ N1
    nearest = cKDTree(second.points).query(first.points[nodes])[1]
    P = sp.csr_matrix((np.ones(len(nodes)), (np.arange(len(nodes)), nearest)), (len(nodes), len(second.points)))
    mixed = (N1.T @ w @ N2 + (mass.matrix - covered) @ P).tocsr()
    mixed.eliminate_zeros()
    return MortarProjection(mass, mixed)


def _rows(columns: Ints, values: Floats, count: int) -> sp.csr_matrix:
    """Sparse matrix (q, count) with values (q, k) in columns (q, k)."""
    q, k = columns.shape
    return sp.csr_matrix((values.ravel(), columns.ravel(), k * np.arange(q + 1)), (q, count))


def stacked(operators: list[ContactOperator]) -> ContactOperator:
    """Several contacts as one operator with the nodes and points of all; the jumps are block-diagonal."""
    if len(operators) == 1:
        return operators[0]

    def rows(name: str) -> Floats:
        return np.concatenate([getattr(op, name) for op in operators])

    def diagonal(name: str) -> sp.csr_matrix:
        return sp.block_diag([getattr(op, name) for op in operators], format="csr")

    first = [op.jump1 for op in operators]
    return ContactOperator(
        np.concatenate([op.nodes for op in operators]), rows("frames"),
        MortarProjection.stacked(first) if isinstance(first[0], MortarProjection) else diagonal("jump1"),
        MortarProjection.stacked([op.jump2 for op in operators]), SurfaceMass.stacked([op.mass for op in operators]),
        diagonal("trace"), diagonal("shape"), diagonal("hat"),
        rows("points"), rows("weights"), rows("gap"), rows("stabiliser"),
    )
