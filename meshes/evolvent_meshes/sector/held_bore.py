"""The part of the bore at which a gear is held: layers of cells end at its ends, there and only there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError

ABOVE = 0.6
"""How far below the root circle, in normal modules, the layers are as on the flank: a rim is one module thick."""
FEWEST = 3
"""Layers beside which and on which the bore may be held."""


def node_heights(gear: GearParameters, heights: Floats, radius: Floats) -> Floats:
    """Heights (levels, nodes) [mm] of a swept section's nodes.

    heights: (levels,) of the layers' nodes on the flank, ends and middles in turn [mm].
    radius: (nodes,) of the section [mm].
    At the bore the nearest ends of layers are moved to the ends of a partial support, the others evenly between; above,
    less and less, in proportion to the radius. Raises MeshError for fewer than FEWEST layers.
    """
    plain = np.repeat(heights[:, None], len(radius), axis=1)
    if not gear.support.is_partial(gear.face_width) or len(heights) < 2:
        return plain
    bore, top = gear.bore_diameter / 2.0, gear.root_diameter / 2.0 - ABOVE * gear.normal_module
    share = np.clip((top - radius) / (top - bore), 0.0, 1.0)
    return plain + share * (_moved(gear, heights) - heights)[:, None]


def _moved(gear: GearParameters, heights: Floats) -> Floats:
    """Heights (levels,) [mm] at the bore, where layers end at the ends of the support."""
    ends, half = heights[::2], gear.face_width / 2.0
    if len(ends) <= FEWEST:
        raise MeshError(
            f"sector: wanted at least {FEWEST} layers where the gear is held on a part of its face, found "
            f"{len(ends) - 1}; take more face_elements"
        )
    low, high = gear.support.ends(gear.face_width)
    last = len(ends) - 1
    first = 0 if low <= -half else int(np.clip(np.argmin(abs(ends - low)), 1, last - 1))
    second = last if high >= half else int(np.clip(np.argmin(abs(ends - high)), first + 1, last - 1))
    if first >= second:  # both between the last two ends
        first = second - 1
    known = sorted({0, first, second, last})
    wanted = {0: -half, last: half, first: max(low, -half), second: min(high, half)}
    return np.interp(heights, ends[known], [wanted[each] for each in known])


def with_held_bore(gear: GearParameters, mesh: MeshData) -> MeshData:
    """The mesh with its facet group bore divided, where the support is partial: bore is held, bore_free is not."""
    if not gear.support.is_partial(gear.face_width) or mesh.dimension == 2:
        return mesh
    bore = mesh.facets["bore"]
    low, high = gear.support.ends(gear.face_width)
    middle = mesh.points[bore, 2].mean(axis=1)
    held = (middle > low) & (middle < high)
    groups: dict[str, Ints] = {"bore": bore[held], "bore_free": bore[~held]}
    return replace(mesh, facets=mesh.facets | groups)
