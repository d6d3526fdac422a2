"""The cut faces of equal sectors joined to a closed ring or an open chain: their displacements under forces on them.

Interface i is the low face of sector i, its displacement v_i (c) in that sector's frame. With the sector's stiffness S
(2c × 2c: low face, high face in the frame of the next sector) the joined stiffness A is block tridiagonal; for a closed
ring it is block circulant and falls into one c × c block per harmonic, however many teeth there are.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular

from evolvent_meshes.arrays import Complexes, Floats, Ints


class JoinedSectors(Protocol):
    """Joined sectors 0 … n − 1."""

    def responses(self, forces: Floats) -> tuple[list[Floats], Ints]:
        """Displacements (2c × r: low, high) of the faces of sectors i under face forces (2c × r) of sectors j, each
        different one once, and (n × n) which of them belongs to i and j."""
        ...

    def displacements(self, sources: dict[int, Floats]) -> list[Floats]:
        """Displacements v_i (c, ...) of the interfaces 0 … n under face forces (2c, ...: low, high) of sectors."""
        ...


class ClosedRing:
    """Ring of `total` sectors closed to a full circle, `count` of them named."""

    def __init__(self, stiffness: Floats, total: int, count: int) -> None:
        self._stiffness = stiffness
        self._total = total
        self._count = count

    def responses(self, forces: Floats) -> tuple[list[Floats], Ints]:
        """Displacements (2c × r) of the faces of sectors under face forces (2c × r) of others, one for each offset 1 −
        n … n − 1 of the sectors, and (n × n) which of them belongs to sectors i and j."""
        faces = self.displacements({0: forces})
        offsets = np.arange(1 - self._count, self._count) % self._total
        places = np.arange(self._count)
        which = places[:, None] - places + self._count - 1
        return [np.concatenate(faces[offset : offset + 2]) for offset in offsets], which

    def displacements(self, sources: dict[int, Floats]) -> list[Floats]:
        """Displacements v_i (c, ...) of the interfaces 0 … n under face forces (2c, ...: low, high) of sectors. Factors
        every harmonic again: keeping them all would need gigabytes."""
        size = len(self._stiffness) // 2
        waves = []
        for harmonic in range(self._total // 2 + 1):
            turn = np.exp(2j * np.pi * harmonic / self._total)
            forces = sum(
                turn**-sector * (force[:size] + np.conj(turn) * force[size:]) for sector, force in sources.items()
            )
            waves.append(cho_solve((self._factor(turn), True), forces, overwrite_b=True))
        faces = np.fft.irfft(waves, self._total, axis=0)
        return [*faces, faces[0]]

    def _factor(self, turn: complex) -> Complexes:
        size = len(self._stiffness) // 2
        across = turn * self._stiffness[:size, size:]
        block = self._stiffness[:size, :size] + self._stiffness[size:, size:] + across + across.conj().T
        return cholesky(block, lower=True, overwrite_a=True)


class OpenChain:
    """Chain of `count` sectors, the two outermost faces free, or fixed when `clamped`: A = L Lᵀ, block by block."""

    def __init__(self, stiffness: Floats, count: int, clamped: bool) -> None:
        self._size = len(stiffness) // 2
        self._count = count
        self._held = (0, count) if clamped else ()
        self._diagonal, self._lower = self._factors(stiffness)

    def responses(self, forces: Floats) -> tuple[list[Floats], Ints]:
        """Displacements (2c × r) of the faces of each sector under face forces (2c × r) of each sector, and (n × n)
        which of them belongs to sectors i and j."""
        columns = [self.displacements({sector: forces}) for sector in range(self._count)]
        places = range(self._count)
        which = np.arange(self._count**2).reshape(self._count, self._count)
        return [np.concatenate(faces[place : place + 2]) for place in places for faces in columns], which

    def displacements(self, sources: dict[int, Floats]) -> list[Floats]:
        """Displacements v_i (c, ...) of the interfaces 0 … n under face forces (2c, ...: low, high) of sectors."""
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
