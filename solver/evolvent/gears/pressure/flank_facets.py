"""Facets of a gear's loaded flank along its profile."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent_meshes.arrays import Floats

SAME_ROW = 1e-6
"""Curvature radii closer than this are of one row of nodes [mm]; between the nodes of a coarser flank they scatter."""
HEIGHT_TOLERANCE = 1e-6
"""Heights [mm] closer than this are equal."""


@dataclass(frozen=True, eq=False)
class FlankFacets:
    """The facets of a gear's loaded flank."""

    z: Floats
    """Heights (n,) of the flank's nodes [mm]."""
    rows: Floats
    """Transverse curvature radii (m + 1,) at which the m facets along the profile begin and end, ascending [mm]."""
    base_radius: float
    """Base radius of the gear [mm]."""

    @staticmethod
    def of(z: Floats, roll_lengths: Floats, base_radius: float, order: int) -> FlankFacets:
        """Facets of a flank, from its nodes at the end of the face; elsewhere modifications of the lead move the rows.
        z, roll_lengths: (n,) heights and curvature radii of the flank's nodes [mm]; order: of the facets."""
        ordered = np.sort(roll_lengths[z <= z.min() + HEIGHT_TOLERANCE])
        rows = ordered[np.diff(ordered, prepend=-np.inf) > SAME_ROW]
        return FlankFacets(z, rows[::-1][::order][::-1], base_radius)

    @property
    def row_before_tip(self) -> float:
        """Curvature radius [mm] at which the last row of facets before the tip begins."""
        return float(self.rows[-2])

    def lengths_at(self, roll_lengths: Floats) -> Floats:
        """Arc lengths (k,) [mm] of the facets in which curvature radii (k,) [mm] lie; of the first and last beyond."""
        facet = np.clip(np.searchsorted(self.rows, roll_lengths, side="right") - 1, 0, len(self.rows) - 2)
        return np.asarray(np.diff(self.rows**2)[facet] / (2.0 * self.base_radius))
