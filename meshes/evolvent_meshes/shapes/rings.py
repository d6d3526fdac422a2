"""Quarter blocks for round contacts: around a square core the cells lie in rings, and one of them ends at a circle.

The pressure of a round contact rises like a square root from its edge. Square cells that the edge cuts at all angles
follow it badly; rings whose cells end at the expected edge follow it as the cells of a line contact do. x runs to the
right, y to the back, z up; both shapes touch at the origin, the block from below and the sphere from above.
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

CORE = 0.5  # half-width of the square core, as a part of the ring's radius
BULGE = 0.7  # 1: the core is a square, 0: a disc; between, no cell is far from a right angle


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
    """Quarter of an upright cylinder of radius `side`, -height <= z <= 0 [mm], refined at the centre of its top.

    A ring of cells ends at the radius `ring`, and up to there the cells are at most `size` wide. Outside it their
    number along the circle stays, so that they widen with the radius; outwards they are at most `size` long up to the
    radius `fine`, and as deep down to `fine_depth` (default fine/2), each next one at most `growth` times more. Facet
    groups: symmetry_x (x = 0), symmetry_y (y = 0), side, bottom, top. Hexahedra. Raises MeshError unless
    0 < ring < fine < side.
    """
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
    """Quarter of an upright cylinder of radius `side` with a sphere of `radius` about (0, 0, radius) as its underside.

    Its flat top is at z = height [mm]. Sizes as for `ring_block`. Facet groups: arc (the sphere), top, symmetry_x,
    symmetry_y, side. Raises MeshError unless 0 < ring < fine < side and the sphere rises less than 0.7 height.
    """
    line = graded_ends(height, size, fine / 2 if fine_depth is None else fine_depth, growth)
    points, cells = _swept(side, ring, size, fine, order, growth, line)
    ends = {"arc": points[:, 2], "top": points[:, 2] - height}
    return _finished(over_sphere(points, radius, height), cells, order, ends, side)


def _swept(
    side: float, ring: float, size: float, fine: float, order: int, growth: float, z: Floats
) -> tuple[Floats, Ints]:
    """Points (n, 3) and cells of the quarter's section (core and two shells) over the cell ends z."""
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
    """Cells of at most `size` on a line."""
    return max(1, int(np.ceil(length / size - 1e-9)))


def _core_edge(angles: Floats, ring: float) -> Floats:
    """Radius of the core's edge: a square with bulging sides."""
    return CORE * ring * (BULGE / np.maximum(np.cos(angles), np.sin(angles)) + 1 - BULGE)


def _shell(angles: Floats, radii: Floats, ring: float) -> Floats:
    """Grid (n radii, n angles, 2) from the core's edge outwards, of circles from the ring on."""
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
    """The mesh with its facet groups; `ends` names the lower and upper surface by what vanishes there."""
    facets = boundary_facets("hexahedron", order, cells)
    x, y = points[:, 0], points[:, 1]
    zero = {"symmetry_x": x, "symmetry_y": y, "side": np.hypot(x, y) - side, **ends}
    groups = {name: facets_where(facets, np.abs(value) < 1e-9 * side) for name, value in zero.items()}
    return MeshData(points, "hexahedron", order, cells, groups, {"body": np.arange(len(cells))})
