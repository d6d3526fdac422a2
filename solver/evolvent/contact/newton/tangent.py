"""The tangent of the contact system.

With M = ∂F/∂J (sparse), A the compliance and H the free rigid motions, a Newton step solves

    T y = b ,   T = [I + M A, −M H; Hᵀ, 0]

Only the columns in which M is not zero couple anything. Where a point slides, its traction hardly depends on the
tangential jump: ∂τ/∂q is μλ/|q| (I − t⊗t), 1e-3 where slip is large beside the elastic displacement. Leaving such
columns out makes the system a third as large, 27 times cheaper to factor, and the inverse of a nearby tangent.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.contact.newton.reduced_tangent import KeptColumns
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.nitsche.contact_operator import ContactOperator, Law
from evolvent_meshes.arrays import Floats, Ints

LOOSE = 0.05  # a point whose traction follows the tangential jump with less than this share of γ_t slides freely


@dataclass(frozen=True)
class Tangent:
    """T at one state. M, A: (m, m), H: (m, r). kept: the columns of M that a nearby tangent has; whole: whether these
    are all."""

    M: sp.csr_matrix
    A: Floats
    H: Floats
    kept: Ints
    whole: bool

    @staticmethod
    def of(operator: ContactOperator, law: Law, A: Floats, H: Floats) -> Tangent:
        """At the state in which `law` holds at the quadrature points. Raises NotConverged where nothing touches."""
        M = operator.tangent(law)
        k = law.traction.shape[1]
        normal, used = np.arange(M.shape[0]) % k == 0, _columns(M)
        kept = used & (normal | np.repeat(_held_nodes(operator, law), k))
        if not kept.any() and H.shape[1]:
            raise NotConverged(
                "contact: wanted one that holds every free rigid motion, found no node in contact; bring the bodies "
                "together, or hold the motion"
            )
        return Tangent(M, A, H, np.flatnonzero(kept), bool(np.array_equal(kept, used)))

    def times(self, y: Floats) -> Floats:
        """T y."""
        force, motion = np.split(y, [self.M.shape[0]])
        jump = self.H @ motion - self.A @ force
        return np.concatenate([force - self.M @ jump, self.H.T @ force])

    def solve(self, right: Floats) -> Floats:
        """T⁻¹ right, (m + r,), by a factor of all columns. Raises NotConverged where T is singular."""
        inverse = KeptColumns.of(self.M, self.A, self.H, np.flatnonzero(_columns(self.M)))
        first: Floats = inverse.solve(right)
        second: Floats = inverse.solve(right - self.times(first))  # f = b − M z cancels digits: refined once
        return first + second


def _columns(M: sp.csr_matrix) -> np.ndarray:
    """Which columns of M hold anything, (m,) bool."""
    used = np.zeros(M.shape[1], dtype=bool)
    used[M.indices[M.data != 0.0]] = True
    return used


def _held_nodes(operator: ContactOperator, law: Law) -> np.ndarray:
    """(n,) bool: nodes with a point near by whose traction follows the tangential jump."""
    held = np.abs(law.derivative[:, 1:, 1:]).max(axis=(1, 2), initial=0.0) > LOOSE
    near = np.zeros(len(operator.nodes), dtype=bool)
    near[operator.shape[np.flatnonzero(held)].indices] = True
    return near
