"""The tangent of the contact system.

With M = ∂F/∂J (sparse), A the compliance and H the free rigid motions, a Newton step solves

    T y = b ,   T = [I + M A, −M H; Hᵀ, D]

with D what resists the free motions (`FreeMotions`).

Only the columns in which M is not zero couple the unknowns. The traction of a sliding point hardly depends on the
tangential jump: ∂τ/∂q is μλ/|q| (I − t⊗t), about 1e-3 if the slip is large against the elastic displacement. Without
these columns the system is a third as large and 27 times cheaper to factor; its inverse is that of an approximate
tangent.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.contact.newton.jump_compliance import JumpCompliance
from evolvent.contact.newton.reduced_tangent import FreeMotions, ReducedTangent
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.nitsche.contact_operator import ContactOperator
from evolvent.contact.nitsche.coulomb import LawValues
from evolvent_meshes.arrays import Bools, Floats, Ints

SLIDING = 0.05  # a point slides if its traction changes with the tangential jump by less than this fraction of γ_t


@dataclass(frozen=True)
class Tangent:
    """T at one state.

    M: ∂F/∂J (m, m) [N/mm].
    A: compliance (m, m).
    motions: H (m, r) and D (r, r) of the free rigid motions.
    kept: columns of M that the approximate tangent keeps.
    whole: whether these are all that are not zero.
    """

    M: sp.csr_matrix
    A: JumpCompliance
    motions: FreeMotions
    kept: Ints
    whole: bool

    @staticmethod
    def of(operator: ContactOperator, law: LawValues, A: JumpCompliance, motions: FreeMotions) -> Tangent:
        """Tangent at the state with the law's values at the quadrature points. Raises NotConverged where nothing
        touches and nothing else resists the motions."""
        M = operator.tangent(law)
        k = law.traction.shape[1]
        normal, used = np.arange(M.shape[0]) % k == 0, _columns(M)
        kept = used & (normal | np.repeat(_sticking_nodes(operator, law), k))
        if not kept.any() and motions.count and not motions.resistance.any():
            raise NotConverged(
                "contact: wanted one that holds every free rigid motion, found no node in contact; bring the bodies "
                "together, check the sign of the load, or hold the motion"
            )
        return Tangent(M, A, motions, np.flatnonzero(kept), bool(np.array_equal(kept, used)))

    def times(self, y: Floats) -> Floats:
        """Product T y with the tangent."""
        force, motion = np.split(y, [self.M.shape[0]])
        jump = self.motions.jumps @ motion - self.A.times(force)
        return np.concatenate([force - self.M @ jump, self.motions.balance(force, motion)])

    def solve(self, right: Floats) -> Floats:
        """T⁻¹ right, (m + r,), with all columns, where A is a matrix. Raises NotConverged where T is singular."""
        assert self.A.matrix is not None
        inverse = ReducedTangent.of(self.M, self.A.matrix, self.motions, np.flatnonzero(_columns(self.M)))
        return refined(inverse.solve, self.times, right)


def refined(solve: Callable[[Floats], Floats], times: Callable[[Floats], Floats], right: Floats) -> Floats:
    """T⁻¹ right with one refinement: the solve loses digits by cancellation.

    solve, times: products with an approximate T⁻¹, and with T.
    """
    first = solve(right)
    return first + solve(right - times(first))


def _columns(M: sp.csr_matrix) -> Bools:
    """Columns of M that are not zero, (m,) bool."""
    used = np.zeros(M.shape[1], dtype=bool)
    used[M.indices[M.data != 0.0]] = True
    return used


def _sticking_nodes(operator: ContactOperator, law: LawValues) -> Bools:
    """Nodes (n,) bool of facets with a point whose traction changes with the tangential jump."""
    sticking = np.abs(law.derivative[:, 1:, 1:]).max(axis=(1, 2), initial=0.0) > SLIDING
    near = np.zeros(operator.n, dtype=bool)
    near[operator.shape[np.flatnonzero(sticking)].indices] = True
    return near
