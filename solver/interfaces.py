"""The cut faces of equal sectors joined to a closed ring or an open chain: what moves there under forces on sectors.

Interface i is the low face of sector i, its displacement v_i (c) in that sector's frame. With the sector's stiffness S
(2c × 2c: low face, high face in the frame of the next sector) the joined stiffness A is block tridiagonal; for a closed
ring it is block circulant and falls into one c × c block per harmonic, however many teeth there are.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve, cholesky, solve_triangular

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


class Interfaces(Protocol):
    """Joined sectors 0 … n − 1."""

    def coupling(self, sector: int, other: int) -> Floats:
        """B G Bᵀ (r × r): B times the face displacements of `sector` under the face forces Bᵀ of `other`."""
        ...

    def couplings(self) -> Floats:
        """All different couplings side by side, (r × r·number)."""
        ...

    def displacements(self, sources: dict[int, Floats]) -> list[Floats]:
        """v_i (c) of the interfaces 0 … n under face forces (2c: low, high) of sectors."""
        ...


class Ring:
    """`total` sectors closed to a full circle, the couplings kept for sectors less than `reach` apart."""

    def __init__(self, stiffness: Floats, reduced: Floats, total: int, reach: int) -> None:
        self._stiffness = stiffness
        self._total = total
        offsets = np.arange(min(reach, total // 2 + 1))
        self._couplings = np.zeros((len(offsets), len(reduced), len(reduced)))
        low, high = np.hsplit(reduced, 2)
        for harmonic, weight, turn in self._harmonics():
            half = solve_triangular(self._factor(turn), (low + turn * high).conj().T, lower=True)
            product = half.conj().T @ half
            for offset in offsets:
                phase = weight * np.exp(2j * np.pi * harmonic * offset / total)
                self._couplings[offset] += phase.real * product.real - phase.imag * product.imag

    def coupling(self, sector: int, other: int) -> Floats:
        """See `Interfaces.coupling`."""
        offset = (sector - other) % self._total
        if offset > self._total // 2:
            return self._couplings[self._total - offset].T
        return self._couplings[offset]

    def couplings(self) -> Floats:
        """See `Interfaces.couplings`."""
        return np.hstack([*self._couplings, *(coupling.T for coupling in self._couplings[1:])])

    def displacements(self, sources: dict[int, Floats]) -> list[Floats]:
        """See `Interfaces.displacements`; factorises every harmonic again, as keeping them all would need gigabytes."""
        size = len(self._stiffness) // 2
        places = np.arange(self._total + 1)
        result = np.zeros((self._total + 1, size))
        for harmonic, weight, turn in self._harmonics():
            forces = np.zeros(size, dtype=complex)
            for sector, force in sources.items():
                forces += np.exp(-2j * np.pi * harmonic * sector / self._total) * (
                    force[:size] + np.conj(turn) * force[size:]
                )
            wave = cho_solve((self._factor(turn), True), forces)
            result += weight * np.outer(np.exp(2j * np.pi * harmonic * places / self._total), wave).real
        return list(result)

    def _harmonics(self) -> Iterator[tuple[int, float, complex]]:
        """Harmonic, its weight in the real sum (k and n − k together), and e^{2πik/n}."""
        for harmonic in range(self._total // 2 + 1):
            alone = 2 * harmonic in (0, self._total)
            yield harmonic, (1 if alone else 2) / self._total, np.exp(2j * np.pi * harmonic / self._total)

    def _factor(self, turn: complex) -> Complexes:
        size = len(self._stiffness) // 2
        across = turn * self._stiffness[:size, size:]
        block = self._stiffness[:size, :size] + self._stiffness[size:, size:] + across + across.conj().T
        return cholesky(block, lower=True, overwrite_a=True)


class OpenChain:
    """`count` sectors in a row, the two outermost faces free, or fixed when `clamped`: A = L Lᵀ, block by block."""

    def __init__(self, stiffness: Floats, reduced: Floats, count: int, clamped: bool) -> None:
        self._size = len(stiffness) // 2
        self._count = count
        self._held = (0, count) if clamped else ()
        self._diagonal, self._lower = self._factors(stiffness)
        self._couplings = np.empty((count, count, len(reduced), len(reduced)))
        for sector in range(count):
            faces = self.displacements({sector: reduced.T})
            for other in range(count):
                self._couplings[other, sector] = reduced @ np.concatenate(faces[other : other + 2])

    def coupling(self, sector: int, other: int) -> Floats:
        """See `Interfaces.coupling`."""
        return self._couplings[sector, other]

    def couplings(self) -> Floats:
        """See `Interfaces.couplings`."""
        return np.hstack([coupling for row in self._couplings for coupling in row])

    def displacements(self, sources: dict[int, Floats]) -> list[Floats]:
        """See `Interfaces.displacements`."""
        sample = next(iter(sources.values()))
        right = [np.zeros((self._size, *sample.shape[1:])) for _ in range(self._count + 1)]
        for sector, force in sources.items():
            right[sector] += force[: self._size]
            right[sector + 1] += force[self._size :]
        for i in self._held:
            right[i][:] = 0.0
        return self._solve(right, first=min(sources))

    def _factors(self, stiffness: Floats) -> tuple[list[Floats], list[Floats]]:
        low, high = slice(None, self._size), slice(self._size, None)
        diagonal: list[Floats] = []
        lower: list[Floats] = []
        for i in range(self._count + 1):
            block = (stiffness[low, low] if i < self._count else 0.0) + (stiffness[high, high] if i > 0 else 0.0)
            below = np.zeros_like(block)
            if i in self._held:
                block = np.eye(self._size)
            elif i > 0 and i - 1 not in self._held:
                below = solve_triangular(diagonal[-1], stiffness[low, high], lower=True).T
                block = block - below @ below.T
            diagonal.append(cholesky(block, lower=True))
            lower.append(below)
        return diagonal, lower

    def _solve(self, right: list[Floats], first: int) -> list[Floats]:
        for i in range(first, len(right)):
            before = right[i] - self._lower[i] @ right[i - 1] if i > first else right[i]
            right[i] = solve_triangular(self._diagonal[i], before, lower=True)
        for i in range(len(right) - 1, -1, -1):
            after = right[i] - self._lower[i + 1].T @ right[i + 1] if i + 1 < len(right) else right[i]
            right[i] = solve_triangular(self._diagonal[i], after, lower=True, trans="T")
        return right


def compressed(matrix: Floats, tolerance: float, step: int = 64) -> tuple[Floats, Floats]:
    """U (m × r, orthonormal columns), B (r × n) with ‖matrix − U B‖ ≤ tolerance ‖matrix‖ (Frobenius).

    Source: Martinsson and Voronin 2016, doi 10.1137/15M1026080, blocked randomised QB (fixed seed). `matrix` is used
    up as work space.
    """
    random = np.random.default_rng(0)
    wanted = tolerance * np.linalg.norm(matrix)
    basis, reduced = np.empty((len(matrix), 0)), np.empty((0, matrix.shape[1]))
    while np.linalg.norm(matrix) > wanted and basis.shape[1] < min(matrix.shape):
        width = min(step, min(matrix.shape) - basis.shape[1])
        sample = matrix @ random.standard_normal((matrix.shape[1], width))
        # twice: the residual's columns are tiny and lose orthogonality against what is there already
        for _ in range(2):
            sample, _ = np.linalg.qr(sample - basis @ (basis.T @ sample))
        rows = sample.T @ matrix
        matrix -= sample @ rows
        basis, reduced = np.hstack([basis, sample]), np.vstack([reduced, rows])
    return basis, reduced
