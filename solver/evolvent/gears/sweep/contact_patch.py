"""The contact patch of a position and the friction in it, as predictions of the next position's.

All teeth are alike, and the patch moves on with the contact lines: so points are given relative to them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent_meshes.arrays import Bools, Floats

SLICE_WEIGHT = 0.5  # of distances along ξ beside those across the contact line; 0.02 to 0.5 predict equally well
THINNED = 3
"""One in so many points of a contact patch is kept: it predicts as well, and nearest points are found in half the time.
"""


@dataclass(frozen=True)
class ContactPatch:
    """Which points of a position are pressed, among one in THINNED.

    places: (k, 2), as of `contact_places`.
    pressed: (k,) bool.
    """

    places: Floats
    pressed: Bools

    @staticmethod
    def of(geometry: ContactGeometry, pressure: Floats) -> ContactPatch:
        """Contact patch from the pressures (q,) at the points."""
        return ContactPatch(contact_places(geometry)[::THINNED], pressure[::THINNED] > 0.0)

    def at(self, geometry: ContactGeometry) -> Bools:
        """Points (q,) bool of another position whose nearest point in this patch is pressed."""
        return np.asarray(self.pressed[cKDTree(self.places).query(contact_places(geometry))[1]])


NEAR = 0.05
"""Distance in roll distance [modules] within which friction is taken from another point: near the pitch point, where it
reverses, other contact lines know nothing of it."""


@dataclass(frozen=True)
class FrictionPattern:
    """Friction over pressure at the k pressed points of a position. It hardly changes at a roll distance and a distance
    from the contact line, as sliding depends on these.

    places: (k, 2), as of `contact_places`.
    ratio: (k, d−1), tangential traction over pressure.
    """

    places: Floats
    ratio: Floats

    @staticmethod
    def of(geometry: ContactGeometry, traction: Floats) -> FrictionPattern:
        """Friction pattern of tractions (q, d) at the points [MPa]."""
        on = traction[:, 0] > 0.0
        return FrictionPattern(contact_places(geometry)[on], traction[on, 1:] / traction[on, :1])

    def at(self, geometry: ContactGeometry) -> Floats:
        """Friction over pressure (q, d−1) at the points of another position, from the nearest point of this one; zero
        where that is none at this roll distance."""
        places = contact_places(geometry)
        if not len(self.places):
            return np.zeros((len(places), self.ratio.shape[1]))
        nearest = cKDTree(self.places).query(places)[1]
        reach = SLICE_WEIGHT * NEAR * geometry.stand.pair.pinion.normal_module
        near = np.abs(self.places[nearest, 0] - places[:, 0]) <= reach
        return np.where(near[:, None], self.ratio[nearest], 0.0)


def contact_places(geometry: ContactGeometry) -> Floats:
    """Places (q, 2) of the points: roll distance ξ times SLICE_WEIGHT and signed distance across the contact line
    [mm]."""
    ξ = geometry.operator.shape @ geometry.roll_distance
    return np.column_stack([SLICE_WEIGHT * ξ, geometry.across])
