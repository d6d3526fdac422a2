"""The contact patch of a position, as a prediction of the next position's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent_meshes.arrays import Bools, Floats

SLICE_WEIGHT = 0.5  # of distances along ξ beside those across the contact line; 0.02 to 0.5 predict equally well


@dataclass(frozen=True)
class ContactPatch:
    """Pressed points among the q points of a position. All teeth are alike, and the patch moves on with the contact
    lines: so it is given relative to them.

    places: (q, 2), roll distance ξ times SLICE_WEIGHT and signed distance across the contact line [mm].
    pressed: (q,) bool.
    """

    places: Floats
    pressed: Bools

    @staticmethod
    def of(geometry: ContactGeometry, pressure: Floats) -> ContactPatch:
        """Contact patch from the pressures (q,) at the points."""
        return ContactPatch(_places(geometry), pressure > 0.0)

    def at(self, geometry: ContactGeometry) -> Bools:
        """Points (q,) bool of another position whose nearest point in this patch is pressed."""
        return np.asarray(self.pressed[cKDTree(self.places).query(_places(geometry))[1]])


def _places(geometry: ContactGeometry) -> Floats:
    ξ = geometry.operator.shape @ geometry.roll_distance
    return np.column_stack([SLICE_WEIGHT * ξ, geometry.across])
