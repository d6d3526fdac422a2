"""Quarters of blocks for circular contacts: rings of cells around a square core, one of which ends at the edge.

Near the edge of the contact the pressure varies as the square root of the distance. Rings of cells that end at the
expected edge resolve it as the cells of a line contact do; square cells, which the edge cuts at all angles, do not.
x points to the right, y to the back, z up; both shapes touch at the origin, the block below and the sphere above it.

Parameters that both functions share:

side: radius of the upright cylinder [mm].
height: of the cylinder [mm].
ring: radius at which a ring of cells ends [mm].
size: largest cells within the radius `ring` [mm]. Outside, the number of cells along the circle is the same, so that
    they widen with the radius.
fine: radius up to which cells are at most `size` long along the radius [mm].
order: of the cells, 1 or 2.
growth: largest ratio of the lengths of neighbouring cells outside `fine`.
fine_depth: depth of the cells of `size` [mm]; None: fine / 2.
"""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.structured_grid import (
    boundary_facets,
    facets_where,
    graded_ends,
    lattice_cells,
    subdivided,
    transfinite,
    weld,
)
from evolvent_meshes.shapes.blocks import over_sphere
from evolvent_meshes.shapes.lengths import check_lengths

CORE = 0.5  # half-width of the square core over the radius of the ring
BULGE = 0.7  # 1: the core is a square, 0: a disc; in between the angles of the cells are near 90°


def ring_block(
    side: float,
    height: float,
    ring: float,
    size: float,
    fine: float,
    order: int = 2,
    growth: float = 1.3,
    fine_depth: float | None = None,
) -> MeshData:
    """Quarter of an upright cylinder, -height <= z <= 0, of hexahedra, refined at the centre of its top.

    Facet groups: symmetry_x (x = 0), symmetry_y (y = 0), side, bottom, top.
    Raises MeshError unless 0 < ring < fine < side.
    """
    lengths = {"side": side, "height": height, "ring": ring, "size": size}
    check_lengths("ring_block", **lengths, fine=fine, growth=growth, fine_depth=fine_depth)
    depth = -graded_ends(height, size, fine / 2 if fine_depth is None else fine_depth, growth)[::-1]
    points, cells = _swept(side, ring, size, fine, order, growth, depth)
    return _finished(points, cells, order, {"bottom": points[:, 2] - points[:, 2].min(), "top": points[:, 2]}, side)


def ring_sphere(
    radius: float,
    side: float,
    height: float,
    ring: float,
    size: float,
    fine: float,
    order: int = 2,
    growth: float = 1.3,
    fine_depth: float | None = None,
) -> MeshData:
    """Quarter of an upright cylinder above z = 0, of hexahedra, its underside a sphere that touches the origin.

    radius: of the sphere about (0, 0, radius) [mm].
    Facet groups: arc (the sphere), top (z = height), symmetry_x, symmetry_y, side.
    Raises MeshError unless 0 < ring < fine < side and the sphere rises less than 0.7 height.
    """
    lengths = {"radius": radius, "side": side, "height": height, "ring": ring, "size": size}
    check_lengths("ring_sphere", **lengths, fine=fine, growth=growth, fine_depth=fine_depth)
    line = graded_ends(height, size, fine / 2 if fine_depth is None else fine_depth, growth)
    points, cells = _swept(side, ring, size, fine, order, growth, line)
    ends = {"arc": points[:, 2], "top": points[:, 2] - height}
    return _finished(over_sphere(points, radius, height), cells, order, ends, side)


def _swept(
    side: float, ring: float, size: float, fine: float, order: int, growth: float, z: Floats
) -> tuple[Floats, Ints]:
    """Points (n, 3) and cells of the quarter: its section, a core and two shells, swept over the cell ends z [mm]."""
    if not 0 < ring < fine < side:
        raise MeshError(f"rings: wanted 0 < ring < fine < side, found ring {ring}, fine {fine}, side {side} mm")
    n_angle = _count(np.pi / 4 * ring, size)
    inner = np.linspace(CORE * ring, ring, _count((1 - CORE) * ring, size) + 1)
    radii = subdivided(np.append(inner[:-1], ring + graded_ends(side - ring, size, fine - ring, growth)), order)
    angles = subdivided(np.linspace(0, np.pi / 4, n_angle + 1), order)
    heights, parts, cells, start = subdivided(z, order), [], [], 0
    for patch in (_core(angles, ring), _shell(angles, radii, ring), _shell(angles + np.pi / 4, radii, ring)):
        flat = np.repeat(patch[:, :, None], len(heights), axis=2)
        parts.append(np.concatenate([flat, np.broadcast_to(heights[:, None], (*flat.shape[:3], 1))], axis=3))
        counts = tuple((n - 1) // order for n in flat.shape[:3])
        cells.append(lattice_cells(counts, order) + start)
        start += int(np.prod(flat.shape[:3]))
    points = np.concatenate([part.reshape(-1, 3) for part in parts])
    keep, number = weld(points, 1e-6 * size)
    return points[keep], number[np.concatenate(cells)]


def _count(length: float, size: float) -> int:
    """Number of cells of at most `size` on a line."""
    return max(1, int(np.ceil(length / size - 1e-9)))


def _core_edge(angles: Floats, ring: float) -> Floats:
    """Radii (n,) of the core's edge, a square with convex sides, at angles (n,) [rad]."""
    return CORE * ring * (BULGE / np.maximum(np.cos(angles), np.sin(angles)) + 1 - BULGE)


def _shell(angles: Floats, radii: Floats, ring: float) -> Floats:
    """Grid (n_radii, n_angles, 2) from the core's edge outwards; circles from the radius `ring` on."""
    inside = np.maximum(0.0, ring - radii) / (ring - radii[0])
    r = radii[:, None] + inside[:, None] * (_core_edge(angles, ring) - radii[0])
    return np.stack([r * np.cos(angles), r * np.sin(angles)], axis=2)


def _core(angles: Floats, ring: float) -> Floats:
    """Grid (n, n, 2) of the core by transfinite interpolation of its four edges."""
    r = _core_edge(angles, ring)
    east = np.column_stack([r * np.cos(angles), r * np.sin(angles)])
    north = east[:, ::-1]
    along = r * np.sin(angles) / (r * np.sin(angles))[-1]
    axis = np.linspace(0, 1, len(angles)) * r[0]
    nothing = np.zeros_like(axis)
    south, west = np.column_stack([axis, nothing]), np.column_stack([nothing, axis])
    return transfinite(south, north, west, east, along, along)


def _finished(points: Floats, cells: Ints, order: int, ends: dict[str, Floats], side: float) -> MeshData:
    """The mesh with its facet groups; ends: name of the lower and the upper surface -> values (n,) that are 0 on it."""
    facets = boundary_facets("hexahedron", order, cells)
    x, y = points[:, 0], points[:, 1]
    zero = {"symmetry_x": x, "symmetry_y": y, "side": np.hypot(x, y) - side, **ends}
    groups = {name: facets_where(facets, np.abs(value) < 1e-9 * side) for name, value in zero.items()}
    return MeshData(points, "hexahedron", order, cells, groups, {"body": np.arange(len(cells))})
