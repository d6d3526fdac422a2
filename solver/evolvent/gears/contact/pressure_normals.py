"""Normals along which the pressure between the flanks of a tooth pair acts.

Where conjugate flanks touch, the pinion's normal n_1 and the wheel's n_2 are opposite, and either may carry the
pressure. Where a tip's corner bears off the path of contact they are degrees apart, and the corner has no normal at
all: without friction the force is along that of the smooth flank on which the corner slides, and along it the gap
opens as the gears turn, so that a force along another normal loses energy. The wheel's tip bears before the path of
contact begins, the pinion's after it ends. So the pressure is along n_1 up to the path's start, along −n_2 from its
end on, and turns from one to the other between them.
"""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair


def pressure_normals(first: Floats, second: Floats, pair: GearPair, ξ: Floats) -> Floats:
    """Unit normals (n, d) at the nodes of a tooth pair's contact.

    first, second: normals (n, d) of the pinion's flank and of the wheel's opposite. ξ: (n,) roll distances of the
    contact line in the nodes' slices [mm].
    """
    start, end = pair.path_of_contact
    share = np.clip((ξ - start) / (end - start), 0.0, 1.0)[:, None]
    mixed = (1.0 - share) * first - share * second
    return np.asarray(mixed / np.linalg.norm(mixed, axis=1, keepdims=True))
