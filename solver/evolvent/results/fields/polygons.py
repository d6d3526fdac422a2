"""Surfaces of gears as polygons in space, with nodal values on their loaded flanks, for pictures and fields.

A gear that was solved in 2D is extruded over its face width.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.fem.nodal_frames import tangent_frames
from evolvent.gears.kinematics import spin
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.gear_shapes import GearShape
from evolvent.results.run_data import RunData, is_plane
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.member import Member

CUTS = ("cut_low", "cut_high")
"""Names of the facet groups on the cut faces between sectors."""
FINE = {
    9: ((0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)),
    6: ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    4: ((0, 1, 2, 3),),
    3: ((0, 1, 2),),
}
"""Number of nodes of a facet -> its subdivision into polygons on all nodes, in gmsh's order of nodes."""
CORNERS = {9: 4, 6: 3, 4: 4, 3: 3}
"""Number of nodes of a facet -> number of its corners."""


@dataclass(frozen=True)
class Polygons:
    """A surface of polygons."""

    points: Floats
    """(n, 3), its points [mm]."""
    faces: tuple[Ints, ...]
    """Arrays (m, k), the points of m polygons with k corners."""

    def moved(self, rotation: Floats, translation: Floats) -> Polygons:
        """The surface after x -> R x + t. rotation: R (3, 3); translation: t (3,) [mm]."""
        return Polygons(self.points @ rotation.T + translation, self.faces)


def joined(parts: list[Polygons]) -> Polygons:
    """Several surfaces as one."""
    starts = np.cumsum([0] + [len(part.points) for part in parts[:-1]])
    faces: dict[int, list[Ints]] = {}
    for part, start in zip(parts, starts):
        for face in part.faces:
            faces.setdefault(face.shape[1], []).append(face + start)
    return Polygons(
        np.concatenate([part.points for part in parts]), tuple(np.concatenate(same) for same in faces.values())
    )


def compact(points: Floats, faces: tuple[Ints, ...]) -> Polygons:
    """The surface with only those points (n, 3) [mm] that its faces use."""
    used = np.unique(np.concatenate([face.ravel() for face in faces]))
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    return Polygons(points[used], tuple(number[face] for face in faces))


def flank_surface(shape: GearShape, face_width: float) -> Polygons:
    """The loaded flank of tooth 0 on all its nodes, in the order of GearShape.flank_nodes; for a plane shape first
    those at −b/2, then those at +b/2. face_width: b [mm]."""
    number = np.full(len(shape.points), -1)
    number[shape.flank_nodes] = np.arange(len(shape.flank_nodes))
    facets, points = number[shape.facets["flank"]], shape.points[shape.flank_nodes]
    if is_plane(shape):
        return _extruded(points, _segments(facets), face_width)
    return Polygons(points, (_polygons(facets),))


def on_flank(shape: GearShape, values: Floats) -> Floats:
    """Values at the points of `flank_surface` from values (n, ...) at the flank nodes."""
    return np.concatenate([values, values]) if is_plane(shape) else values


def sector_surface(shape: GearShape, face_width: float, with_flank: bool) -> Polygons:
    """Surface of a sector without its cut faces, from the corners of its facets. with_flank: whether it has the loaded
    flank."""
    names = [name for name in shape.facets if name not in CUTS and (with_flank or name != "flank")]
    if is_plane(shape):
        sides = np.concatenate([_segments(shape.facets[name]) for name in names])
        return _with_lids(shape, _extruded(shape.points, sides, face_width), face_width)
    corners = [shape.facets[name][:, : CORNERS[shape.facets[name].shape[1]]] for name in names]
    return compact(shape.points, (np.concatenate(corners),))


def _polygons(facets: Ints) -> Ints:
    """Facets (m, nodes) as polygons (p, k) on all their nodes."""
    return np.concatenate([facets[:, list(part)] for part in FINE[facets.shape[1]]])


def _segments(lines: Ints) -> Ints:
    """Line facets (m, 2 or 3) as segments (s, 2)."""
    return lines if lines.shape[1] == 2 else np.concatenate([lines[:, [0, 2]], lines[:, [2, 1]]])


def _extruded(points: Floats, segments: Ints, face_width: float) -> Polygons:
    """Segments extruded over the face width: quadrilaterals between the points at −b/2 and at +b/2."""
    n, half = len(points), np.array([0.0, 0.0, 0.5 * face_width])
    quads = np.column_stack([segments, segments[:, ::-1] + n])
    return Polygons(np.concatenate([points - half, points + half]), (quads,))


def _with_lids(shape: GearShape, sides: Polygons, face_width: float) -> Polygons:
    """The extruded sides of a sector with both end faces, each a polygon along the sector's outline."""
    outline = _loop(np.concatenate([_segments(facets) for facets in shape.facets.values()]))
    lids = np.stack([outline, outline[::-1] + len(shape.points)])
    return compact(sides.points, (*sides.faces, lids))


def _loop(segments: Ints) -> Ints:
    """The nodes (m,) of a closed line, in order. segments: (m, 2)."""
    neighbours: dict[int, list[int]] = {}
    for a, b in segments.tolist():
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    loop = [int(segments[0, 0]), int(segments[0, 1])]
    while len(loop) < len(neighbours):
        loop.append(next(k for k in neighbours[loop[-1]] if k != loop[-2]))
    return np.array(loop)


def place(result: PositionResult, gear: Member, tooth: int, surface: Polygons) -> Polygons:
    """The surface of a gear's tooth 0 moved to the place of tooth pair `tooth` at a position."""
    return surface.moved(result.stand.rotation(gear, 3, tooth), result.stand.centre(gear, 3))


def placed_teeth(
    run: RunData, result: PositionResult, gear: Member, teeth: list[int], bare: set[int]
) -> Polygons | None:
    """Sectors of a gear at a position as one surface; None without teeth. bare: teeth whose loaded flanks are left
    out."""
    kinds = [
        (
            sector_surface(run.shapes[gear], run.pair.face_width, with_flank),
            [t for t in teeth if (t in bare) != with_flank],
        )
        for with_flank in (True, False)
    ]
    placed = [place(result, gear, tooth, surface) for surface, members in kinds for tooth in members]
    return joined(placed) if placed else None


def all_teeth(run: RunData, gear: Member) -> list[int]:
    """All teeth of a gear, as indices of tooth pairs around 0."""
    z = run.pair.gears[gear].z
    return list(range(-(z // 2), z - z // 2))


def nodal(run: RunData, result: PositionResult, tooth: int, values: Floats) -> Floats:
    """Values at all flank nodes of a pinion tooth from values (n, ...) at the nodes of a position; 0 at other nodes."""
    everywhere = np.zeros((len(run.shapes[0].flank_nodes), *values.shape[1:]))
    here = result.tooth == tooth
    everywhere[result.node[here]] = values[here]
    return everywhere


def space_vectors(run: RunData, result: PositionResult, local: Floats) -> Floats:
    """Vectors (n, 3) in space from components (n, k) in the nodal frames (normal, transverse, third) of a position.

    The frames are made from normals of the exact flank; their difference to those of the mesh is too small to be seen.
    """
    vectors = np.zeros((len(local), 3))
    flank, d, k = flank_normals(run), 2 if run.plane else 3, local.shape[1]
    for tooth in np.unique(result.tooth):
        here = result.tooth == tooth
        normals = flank[result.node[here]] @ result.stand.rotation(Member.PINION, 3, int(tooth)).T
        vectors[here, :d] = np.einsum("jia,ji->ja", tangent_frames(normals[:, :d])[:, :k], local[here])
    return vectors


def flank_normals(run: RunData) -> Floats:
    """Outward unit normals (n, 3) of the exact involute helicoid at the pinion's flank nodes, in its own frame."""
    return np.asarray(Flank(run.pair.pinion).helicoid_normal(run.flank.roll_length, run.flank.z))


def sliding(run: RunData, result: PositionResult, tooth: int) -> Floats:
    """Sliding velocity (n, 3) of the pinion's flank nodes relative to the wheel, in space, per rad/s of pinion speed
    [mm/rad]: the tangential part of e_z × (x − c_1) + (z_1/z_2) e_z × (x − c_2)."""
    R = result.stand.rotation(Member.PINION, 3, tooth)
    x, normals = run.flank.points @ R.T, flank_normals(run) @ R.T
    v = spin(x, np.zeros(3)) + spin(x, result.stand.centre(Member.WHEEL, 3)) / run.pair.ratio
    return v - np.einsum("ja,ja->j", v, normals)[:, None] * normals
