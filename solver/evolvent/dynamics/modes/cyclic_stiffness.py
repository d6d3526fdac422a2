"""The stiffness of a ring of equal sectors in one of its harmonics, inverted by one real factor for all harmonics.

In harmonic k of N sectors the displacements of a sector's high cut face are those of its low one turned by the pitch
and times e^{iθ}, θ = 2πk/N. With these eliminated, K(θ) u = b on interior and low face (n complex unknowns), whose
interior does not depend on θ: it is factored once, and a dense block of the low face's size for each harmonic (Thomas,
Int. J. Numer. Meth. Eng. 14 (1979) 81-102).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from evolvent.fem.condensation.schur_complement import Factor
from evolvent_meshes.arrays import Floats, Ints

Numbers = NDArray[np.float64 | np.complex128]


@dataclass(frozen=True)
class CyclicFaces:
    """Degrees of freedom of a sector: those of its interior and of its two cut faces."""

    interior: Ints
    """Interior degrees of freedom (n_i,)."""
    low: Ints
    """Degrees of freedom (c,) of the low cut face."""
    high: Ints
    """Degrees of freedom (c,) of the high cut face, in the order of the low one."""
    turn: sp.csr_matrix
    """Map (c, c) from the low face's displacements to the same turned by the pitch."""

    def reduced(self, matrix: sp.csr_matrix, phase: complex) -> sp.csr_matrix:
        """TᴴKT (n_i + c, n_i + c) of a sector's matrix (N, N) at e^{iθ}; real where that is."""
        T = self._expansion(phase)
        return (T.conj().T @ matrix @ T).tocsr()

    def gathered(self, forces: Numbers, phase: complex) -> Numbers:
        """Tᴴf (n_i + c,) of forces on a sector (N,) at e^{iθ}."""
        return np.asarray(self._expansion(phase).conj().T @ forces)

    def expanded(self, reduced: Numbers, phase: complex, size: int) -> Numbers:
        """A sector's displacements (size, ...) from those of interior and low face (n_i + c, ...)."""
        inside, low = np.split(reduced, [len(self.interior)])
        whole = np.zeros((size, *reduced.shape[1:]), dtype=np.result_type(reduced, phase))
        whole[self.interior], whole[self.low], whole[self.high] = inside, low, phase * (self.turn @ low)
        return whole

    def _expansion(self, phase: complex) -> sp.csr_matrix:
        n_i, c = len(self.interior), len(self.low)
        size = int(max(self.interior.max(), self.low.max(initial=0), self.high.max(initial=0))) + 1
        turned = (phase * self.turn).tocoo()
        rows = np.concatenate([self.interior, self.low, self.high[turned.row]])
        columns = np.concatenate([np.arange(n_i + c), n_i + turned.col])
        values = np.concatenate([np.ones(n_i + c), turned.data])
        return sp.csr_matrix((values, (rows, columns)), (size, n_i + c))


class CyclicStiffness:
    """K of a sector (N, N) [N/mm], its interior factored. Raises NotPositiveDefinite, OutOfMemory."""

    def __init__(self, stiffness: sp.csr_matrix, faces: CyclicFaces) -> None:
        self.faces = faces
        self._stiffness = stiffness
        self._inside = Factor(stiffness[faces.interior][:, faces.interior].tocsr())

    def inverse(self, phase: complex) -> CyclicInverse:
        """Inverse K(θ)⁻¹ at e^{iθ}."""
        across = (self._low + phase * self._high).tocsr()
        return CyclicInverse(self._inside, across, cho_factor(self._face(phase), lower=True), across.shape[0])

    def negative(self, phase: complex) -> int:
        """Number of negative eigenvalues of K(θ): all are of the low face, as the interior was factored (Wittrick and
        Williams, Q. J. Mech. Appl. Math. 24 (1971) 263-284)."""
        return int(np.count_nonzero(np.linalg.eigvalsh(self._face(phase)) < 0.0))

    def _face(self, phase: complex) -> Numbers:
        """Stiffness (c, c) of the low face at e^{iθ}, with the interior eliminated."""
        S, c = self._schur, len(self.faces.low)
        return S[:c, :c] + S[c:, c:] + phase * S[:c, c:] + np.conj(phase) * S[c:, :c]

    @cached_property
    def _low(self) -> sp.csr_matrix:
        return self._stiffness[self.faces.interior][:, self.faces.low].tocsr()

    @cached_property
    def _high(self) -> sp.csr_matrix:
        """Stiffness (n_i, c) between interior and high face, in the frame of the low one."""
        return (self._stiffness[self.faces.interior][:, self.faces.high] @ self.faces.turn).tocsr()

    @cached_property
    def _schur(self) -> Floats:
        """Stiffness (2c, 2c) of both cut faces with the interior eliminated, the high one in the frame of the low
        one."""
        faces, turn = self.faces, self.faces.turn
        cut = np.concatenate([faces.low, faces.high])
        both = sp.block_diag([sp.eye(len(faces.low)), turn]).tocsr()
        own = both.T @ self._stiffness[cut][:, cut] @ both
        across = sp.hstack([self._low, self._high]).tocsr()
        return np.asarray(own.toarray() - across.T @ self._inside.solve(across.toarray()))


@dataclass(frozen=True)
class CyclicInverse:
    """Inverse K(θ)⁻¹ on interior and low face."""

    inside: Factor
    """Factor of the interior stiffness."""
    across: sp.csr_matrix
    """Stiffness (n_i, c) between interior and low face."""
    face: tuple[Numbers, bool]
    """Cholesky factor of the low face's stiffness."""
    count: int
    """Number n_i of interior degrees of freedom."""

    def solve(self, right: Numbers) -> Numbers:
        """Displacements u (n_i + c,) under forces b (n_i + c,)."""
        b, on_face = np.split(right, [self.count])
        low = cho_solve(self.face, on_face - self.across.conj().T @ self._solved(b))
        return np.concatenate([self._solved(b - self.across @ low), low])

    def _solved(self, right: Numbers) -> Numbers:
        if not np.iscomplexobj(right):
            return self.inside.solve(np.real(right))
        parts = self.inside.solve(np.column_stack([right.real, right.imag]))
        return parts[:, 0] + 1j * parts[:, 1]
