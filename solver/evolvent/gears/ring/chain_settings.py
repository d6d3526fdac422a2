"""How sectors are joined to a ring, and which of their teeth are named."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.gears.ring.sector_interfaces import ClosedRing
from evolvent_meshes.arrays import Floats
from evolvent_meshes.rotation import turn


@dataclass(frozen=True)
class ChainSettings:
    """The teeth that rows may name, of a ring of 2π/pitch sectors.

    pitch: angle of a sector [rad].
    count: number of teeth.
    first: number of the lowest tooth; tooth s is tooth 0 turned by +s pitches.
    dimension: of space, d.
    tolerance: relative error (Frobenius) of the coupling T G Tᵀ; 1e-13 is rounding.

    Raises ValueError where the sectors cannot be closed.
    """

    pitch: float
    count: int
    first: int = 0
    dimension: int = 3
    tolerance: float = 1e-13

    def __post_init__(self) -> None:
        sectors = 2 * np.pi / self.pitch
        if abs(sectors - round(sectors)) > 1e-9 * sectors or self.count > round(sectors):
            raise ValueError(
                f"closed ring of sectors: wanted a pitch that divides the circle and no more teeth than it has, found "
                f"a pitch of {self.pitch} rad ({sectors:.6f} to the circle) and {self.count} teeth; correct them"
            )

    def frames_of_faces(self, size: int) -> sp.csr_array:
        """Matrix from face displacements (2c = `size`: low; high in the frame of the next sector) to those in the
        sector's own."""
        next_frame = turn(self.pitch, self.dimension)
        low, high = sp.eye(size // 2), sp.kron(sp.eye(size // 2 // self.dimension), next_frame)
        return sp.csr_array(sp.block_diag([low, high]))

    def joined(self, stiffness: Floats) -> ClosedRing:
        """The ring of sectors whose faces have this stiffness (2c × 2c)."""
        return ClosedRing(stiffness, round(2 * np.pi / self.pitch), self.count)
