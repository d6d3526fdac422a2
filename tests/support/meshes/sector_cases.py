"""Sectors of the papers' gears, coarse, with the start of the fine flank below the active profile."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.paper_pairs import he, yang, zhang

GEARS: dict[str, tuple[Callable[[], GearPair], int]] = {
    "yang pinion": (yang, 0),
    "yang wheel": (yang, 1),
    "he": (he, 0),
    "zhang pinion": (zhang, 0),
    "zhang gear": (zhang, 1),
}

ROUNDING = 1e-12
"""Largest difference [mm] of points that are meshed alike twice: sums round by where arrays lie in memory."""
COARSE = SectorResolution(profile_elements=12, face_elements=4)


def gear_and_start(name: str) -> tuple[GearParameters, float]:
    """A gear and a flank start a little below the start of its active profile."""
    make, index = GEARS[name]
    pair = make()
    gear = pair.gears[index]
    return gear, max(gear.root_form_diameter, pair.active_start_diameters[index] - 0.15)


@cache
def sector(name: str, shape: str = "hexahedron") -> MeshData:
    """A coarse sector."""
    gear, start = gear_and_start(name)
    return sector_mesh(gear, replace(COARSE, flank_start_diameter=start), shape)


def nodes_of(mesh: MeshData, group: str) -> Floats:
    """Points of a facet group."""
    return mesh.points[np.unique(mesh.facets[group])]


def turned(points: Floats, angle: float) -> Floats:
    """Points turned about +z."""
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
