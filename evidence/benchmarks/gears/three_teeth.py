"""Yang's pair: the scene for Evolvent, and three teeth of each gear as one mesh for programs that condense nothing.

Three teeth are those that touch during the first half of the pitch. The cuts left and right of them are held, as the
bore is: left free, a sector of the wheel is a slender tower and five times too soft, and the other programs could not
carry the whole gears at this element size.
"""

from __future__ import annotations

import numpy as np

from evidence.benchmarks.comparison.task import Task, Turn
from evidence.scenes import helical_pair
from evolvent.gears.meshing.element_sizes import sector_resolutions
from evolvent.gears.meshing.sector_meshes import linear
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.arrays import Ints
from evolvent_meshes.gears.flank import nominal_angles
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.structured_grid import weld
from evolvent_meshes.rotation import turn
from evolvent_meshes.sector.sector import sector_mesh

TEETH = (-1, 0, 1)
FRICTION = 0.11
ROTATION = 1.78e-3  # rad of the pinion, which takes three teeth to about 250 N·m


def pair_scene(elements: float, *settings: str, level: str = "quick") -> Scene:
    """The pair at constant pinion torque with so many elements across the Hertz width 2b_H."""
    mesh = f"mesh.elements_per_contact_width={elements}", f'mesh.level="{level}"'
    return helical_pair(*mesh, f"contact.friction=[{FRICTION}]", *settings)


def three_teeth(elements: float, rotation: float = 0.0, order: int = 1, shape: str = "hexahedron") -> Task:
    """Three teeth of each gear at a pinion rotation φ [rad], standing in space as they mesh; order 1 or 2."""
    scene = pair_scene(elements)
    pair, bodies = scene.gear_pair(), []
    for member, gear, resolution in zip(Member, pair.gears, sector_resolutions(gear_problem(scene))):
        mesh = sector_mesh(gear, resolution, shape)
        mesh = mesh if order == 2 else linear(mesh)
        angle = float(nominal_angles(pair, rotation)[member])
        teeth = [angle + member.sign * tooth * 2 * np.pi / gear.z for tooth in TEETH]
        bodies.append(joined(mesh, teeth, member * pair.centre_distance))
    first, second = scene.materials()
    return Task(
        (bodies[0], bodies[1]),
        ((first.youngs_modulus, first.poissons_ratio), (second.youngs_modulus, second.poissons_ratio)),
        "hub",
        Turn(ROTATION),
        ((0, "hub", "z"), (1, "hub", "xyz")),
        ("flank", "flank"),
        FRICTION,
    )


def joined(sector: MeshData, angles: list[float], x: float) -> MeshData:
    """Copies of a sector turned about its axis, welded along their cuts, with the axis moved to (x, 0).

    Facet groups: flank, all of them; hub, the bores and the two cuts at the ends.
    """
    n, m = len(sector.points), len(angles)
    points = np.concatenate([sector.points @ turn(angle, 3).T for angle in angles]) + np.array([x, 0.0, 0.0])
    keep, number = weld(points, 1e-6)
    copies = [number[sector.cells + n * k] for k in range(m)]

    def everywhere(name: str) -> Ints:
        return np.concatenate([number[sector.facets[name] + n * k] for k in range(m)])

    first, last = int(np.argmin(angles)), int(np.argmax(angles))
    ends = number[sector.facets["cut_low"] + n * first], number[sector.facets["cut_high"] + n * last]
    facets = {"flank": everywhere("flank"), "hub": np.concatenate([everywhere("bore"), *ends])}
    cells = np.concatenate(copies)
    return MeshData(points[keep], sector.shape, sector.order, cells, facets, {"body": np.arange(len(cells))})
