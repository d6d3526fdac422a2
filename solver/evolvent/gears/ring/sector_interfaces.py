"""The cut faces of equal sectors joined to a closed ring: their displacements under forces on them.

Interface i is the low face of sector i, its displacement v_i (c) in that sector's frame. With the sector's stiffness S
(2c × 2c: low face, high face in the frame of the next sector) the joined stiffness A is block circulant and falls into
one c × c block per harmonic, however many teeth there are.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_solve, cholesky

from evolvent_meshes.arrays import Complexes, Floats, Ints


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
