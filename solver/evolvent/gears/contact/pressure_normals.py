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

from evolvent.contact.nitsche.contact_operator import ContactOperator
from evolvent.fem.surface import Surface
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.kinematics import PairRotation
from evolvent_meshes.arrays import Floats


def pressure_normals(
    operator: ContactOperator, pinion: GearBody, wheel_flank: Surface, stand: PairRotation, tooth: int
) -> Floats:
    """Unit normals (n, d) at the nodes of a tooth pair's contact.

    operator: with the pinion's normals in its frames. wheel_flank: in the common frame.
    """
    start, end = stand.pair.path_of_contact
    ξ = stand.roll_distance(tooth, pinion.z[operator.nodes])
    share = np.clip((ξ - start) / (end - start), 0.0, 1.0)[:, None]
    mixed = (1.0 - share) * operator.frames[:, 0] - share * (operator.jump2 @ wheel_flank.normals)
    return np.asarray(mixed / np.linalg.norm(mixed, axis=1, keepdims=True))
