"""Both sectors of a gear pair as one mesh, in place as the gears mesh."""

from __future__ import annotations

import numpy as np

from evolvent.gears.meshing.levelled_meshes import LevelledMesh, run_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import nominal_angles
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData


def standing_pair(problem: GearProblem) -> MeshData:
    """Both sectors in place at φ = 0 as one mesh, tooth pair 0 touching at the pitch point; coarse sectors where flanks
    have levels of their own.

    Groups: pinion_tooth, pinion_flank, ..., wheel_tooth, ... Raises MeshError.
    """
    pair = problem.pair
    first, second = (_sector(problem, member) for member in Member)
    angles = nominal_angles(pair, 0.0)
    centre = np.array([pair.centre_distance, 0.0, 0.0])
    points = [_turned(first, float(angles[0])), _turned(second, float(angles[1])) + centre]
    facets = {f"pinion_{name}": nodes for name, nodes in first.facets.items()}
    facets |= {f"wheel_{name}": nodes + len(first.points) for name, nodes in second.facets.items()}
    volumes = {f"pinion_{name}": cells for name, cells in first.volumes.items()}
    volumes |= {f"wheel_{name}": cells + len(first.cells) for name, cells in second.volumes.items()}
    cells = np.concatenate([first.cells, second.cells + len(first.points)])
    return MeshData(np.concatenate(points), first.shape, first.order, cells, facets, volumes)


def _turned(mesh: MeshData, angle: float) -> Floats:
    cosine, sine = np.cos(angle), np.sin(angle)
    return mesh.points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _sector(problem: GearProblem, member: Member) -> MeshData:
    sector = run_mesh(problem, member)
    return sector.mesh if isinstance(sector, LevelledMesh) else sector
