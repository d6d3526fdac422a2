"""The map from displacements of a gear's flank to the jump across the contact of a tooth pair, and its transpose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.contact.nitsche.mortar_projection import MortarProjection
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class JumpMap:
    """Displacements at m flank nodes of one gear, in its frame, to local jumps at the n nodes of one tooth pair.

    projection: Π (n, m); None where it is the identity.
    axes: (n, k, d), rows of the local frames in the gear's frame, with the jump's sign.
    """

    projection: MortarProjection | None
    axes: Floats

    def jumps(self, displacements: Floats) -> Floats:
        """Local jumps (n·k, c) from c columns of displacements (m·d, c)."""
        n, k, d = self.axes.shape
        columns = displacements.shape[1]
        u = displacements.reshape(-1, d * columns)
        projected = u if self.projection is None else self.projection @ u
        return np.matmul(self.axes, projected.reshape(n, d, columns)).reshape(n * k, columns)

    def forces(self, contact_forces: Floats) -> Floats:
        """Forces (m, d) on the gear's nodes under contact forces (n, k), but for the sign: the transposed map."""
        nodal = np.einsum("jka,jk->ja", self.axes, contact_forces)
        return nodal if self.projection is None else self.projection.transposed(nodal)
