"""The mesh under several torques in line contact: each position is made once, for all torques."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from evolvent.gears.gear_model import GearModel
from evolvent.gears.line.line_gears import LineGears
from evolvent_meshes.arrays import Floats


def line_figures(model: GearModel, torques: Sequence[float], angles: Floats) -> Iterator[Floats]:
    """Figures (m, 5) of positions one after the other, under each torque [N·mm], see `figures_of`.

    The loads act along the normals of the helicoids, so that the torques of both gears have the ratio of the base radii
    exactly, and no position stores power. Raises NotConverged, TooWide.
    """
    gears, pinion = LineGears.of(model), model.pair.pinion.base_radius
    for angle in angles:
        position = gears.position(float(angle))
        rows = []
        for torque in torques:
            found = position.under(torque / model.base_radius / model.width_factor)
            stiffness = found.stiffness * model.width_factor
            given = torque / model.width_factor * pinion / model.base_radius
            rows.append((found.approach, stiffness, given, 0.0, position.on_edges(found.load)))
        yield np.array(rows)
