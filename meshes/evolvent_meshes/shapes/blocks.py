"""The verification shapes: blocks, discs and a spherical cap, as structured grids with graded contact zones.

In 2D x runs to the right and y up, in 3D x to the right, y to the back and z up. Contact shapes touch at the origin:
the disc and the cap stand on it from above, the graded blocks lie below it with their tops at height zero. Every node
of a curved contact boundary, mid-side nodes too, lies on the circle or sphere itself. All cells are in the volume group
"body".
"""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.structured_grid import (
    SIMPLEX,
    TENSOR_SHAPE,
    boundary_facets,
    facets_where,
    graded_ends,
    lattice_cells,
    mirrored_line,
    split_to_simplices,
    subdivided,
    tensor_points,
    transfinite,
    weld,
)


def rectangle(
    width: float,
    height: float,
    nx: int,
    ny: int,
    order: int = 2,
    shape: str = "quadrilateral",
    origin: tuple[float, float] = (0.0, 0.0),
) -> MeshData:
    """Uniform rectangle [mm] with its lower left corner at `origin`; facet groups left, right, bottom, top."""
    x = origin[0] + np.linspace(0, width, nx + 1)
    y = origin[1] + np.linspace(0, height, ny + 1)
    return _tensor_block((x, y), order, shape, {"left": 0, "right": 0, "bottom": 1, "top": 1})


def box(
    size: tuple[float, float, float],
    counts: tuple[int, int, int],
    order: int = 2,
    shape: str = "hexahedron",
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> MeshData:
    """Uniform box [mm] with its lowest corner at `origin`.

    Facet groups: left and right (x low, high), front and back (y low, high), bottom and top (z low, high).
    """
    lines = tuple(o + np.linspace(0, s, n + 1) for o, s, n in zip(origin, size, counts, strict=True))
    axes = {"left": 0, "right": 0, "front": 1, "back": 1, "bottom": 2, "top": 2}
    return _tensor_block(lines, order, shape, axes)


def graded_rectangle(
    width: float,
    height: float,
    size: float,
    fine: float,
    order: int = 2,
    shape: str = "quadrilateral",
    growth: float = 1.3,
    fine_depth: float | None = None,
) -> MeshData:
    """Block |x| <= width/2, -height <= y <= 0 [mm] refined at its top centre; groups left, right, bottom, top.

    Cells of `size` over |x| <= fine and down to `fine_depth` (default fine/2), each next one `growth` times larger.
    """
    x = mirrored_line(graded_ends(width / 2, size, fine, growth))
    y = -graded_ends(height, size, fine / 2 if fine_depth is None else fine_depth, growth)[::-1]
    return _tensor_block((x, y), order, shape, {"left": 0, "right": 0, "bottom": 1, "top": 1})


def graded_box(
    side: float,
    height: float,
    size: float,
    fine: float,
    order: int = 2,
    shape: str = "hexahedron",
    growth: float = 1.3,
    fine_depth: float | None = None,
) -> MeshData:
    """Quarter block 0 <= x, y <= side, -height <= z <= 0 [mm] refined at the origin, the centre of its top.

    Facet groups: symmetry_x (x = 0), symmetry_y (y = 0), right (x = side), back (y = side), bottom, top.
    """
    line = graded_ends(side, size, fine, growth)
    z = -graded_ends(height, size, fine / 2 if fine_depth is None else fine_depth, growth)[::-1]
    axes = {"symmetry_x": 0, "right": 0, "symmetry_y": 1, "back": 1, "bottom": 2, "top": 2}
    return _tensor_block((line, line, z), order, shape, axes)


def sphere_quarter(
    radius: float,
    side: float,
    height: float,
    size: float,
    fine: float,
    order: int = 2,
    shape: str = "hexahedron",
    growth: float = 1.3,
    fine_depth: float | None = None,
) -> MeshData:
    """Quarter of a square block with a spherical underside that touches the origin from above.

    0 <= x, y <= side, from the sphere of `radius` about (0, 0, radius) up to the flat top at z = height [mm]. Facet
    groups: arc (the sphere), top, symmetry_x, symmetry_y, right, back. Raises MeshError unless the sphere rises less
    than 0.7 height over the block.
    """
    line = graded_ends(side, size, fine, growth)
    z = graded_ends(height, size, fine / 2 if fine_depth is None else fine_depth, growth)
    axes = {"symmetry_x": 0, "right": 0, "symmetry_y": 1, "back": 1, "arc": 2, "top": 2}
    flat = _tensor_block((line, line, z), order, shape, axes)
    points = over_sphere(flat.points, radius, height)
    return MeshData(points, flat.shape, order, flat.cells, flat.facets, flat.volumes)


def over_sphere(points: Floats, radius: float, height: float) -> Floats:
    """Points (n, 3) of an upright block, 0 <= z <= height [mm], lifted: its underside comes to lie on the sphere of
    `radius` about (0, 0, radius), its top stays. Raises MeshError unless the sphere rises less than 0.7 height."""
    x, y, _ = points.T
    reach = float(np.hypot(x, y).max())
    if reach >= radius or radius - np.sqrt(radius**2 - reach**2) > 0.7 * height:
        raise MeshError(
            f"block over a sphere: wanted a sphere that rises less than 0.7 times the height, found radius {radius}, "
            f"height {height}, a block that reaches {reach:g} mm from the axis; take a smaller side or a larger height"
        )
    return lifted(points, radius - np.sqrt(radius**2 - x**2 - y**2), height)


def lifted(points: Floats, sag: Floats, height: float) -> Floats:
    """Points (n, 3) of an upright block, 0 <= z <= height [mm]: its underside is raised by sag (n,), its top stays."""
    x, y, z = points.T
    return np.column_stack([x, y, sag + z * (1 - sag / height)])


def cylinder_2d(
    radius: float,
    size: float,
    fine: float,
    order: int = 2,
    shape: str = "quadrilateral",
    half: bool = True,
    contact: float | None = None,
    growth: float = 1.3,
) -> MeshData:
    """Disc of `radius` [mm] about (0, radius), or its lower half, refined where it touches the origin.

    Cells of `size` along the arc over |x| <= fine and down to fine/2, growing outwards and upwards. Facet groups: arc
    (the arc over |x| <= contact, default 2 fine, at most up to 45° from the lowest point), and of a half disc top (the
    flat cut at y = radius).
    """
    bottom = subdivided(mirrored_line(graded_ends(np.pi / 4, size / radius, fine / radius, growth)), order)
    depth = subdivided(graded_ends((1 - _CORE) * radius, size, fine / 2, growth), order)
    points, cells = _disc(radius, bottom, depth, order, half)
    facets = boundary_facets("quadrilateral", order, cells)
    x, y = points[:, 0], points[:, 1]
    tolerance = 1e-9 * radius
    reach = min(2 * fine if contact is None else contact, radius / np.sqrt(2)) + tolerance
    rim = (abs(np.hypot(x, y - radius) - radius) < tolerance) & (y < radius)
    groups = {"arc": facets_where(facets, rim & (abs(x) <= reach))}
    if half:
        groups["top"] = facets_where(facets, abs(y - radius) < tolerance)
    return _finished(points, cells, order, shape, groups, None)


_CORE = 0.5
"""Half-width of the disc's core, as a part of the radius."""


def _disc(radius: float, bottom: Floats, depth: Floats, order: int, half: bool) -> tuple[Floats, Ints]:
    """Points (n, 2) and cells of a disc made of a core and shells; depths are below the arc at its lowest point."""
    n_side = max(4, len(bottom) // (4 * order))
    right = subdivided(np.linspace(0.25, 0.5 if half else 0.75, n_side + 1), order) * np.pi
    shells = [bottom, right, -right[::-1]] if half else [bottom, right, -right[::-1], bottom + np.pi]
    patches = [_shell(angles, depth / depth[-1], radius) for angles in shells] + [_core(bottom, right, radius, half)]
    cells, start = [], 0
    for patch in patches:
        n, m = patch.shape[:2]
        cells.append(lattice_cells(((n - 1) // order, (m - 1) // order), order) + start)
        start += n * m
    points = np.concatenate([patch.reshape(-1, 2) for patch in patches])
    keep, number = weld(points, 1e-8 * radius)
    return points[keep], number[np.concatenate(cells)]


def _shell(angles: Floats, depth: Floats, radius: float) -> Floats:
    """Grid (n angles, n depths, 2) from the arc (depth 0) to the core (depth 1); angles from the lowest point."""
    outer = _polar(angles, np.full_like(angles, radius), radius)
    inner = _core_edge(angles, radius)
    return np.asarray(outer[:, None] + depth[:, None] * (inner - outer)[:, None])


def _core(bottom: Floats, right: Floats, radius: float, half: bool) -> Floats:
    """Grid (n bottom, n right, 2) of the core by transfinite interpolation of its four edges."""
    south, east, west = (_core_edge(angles, radius) for angles in (bottom, right, -right))
    if half:
        north = np.column_stack([south[:, 0] * east[-1, 0] / south[-1, 0], np.full(len(south), radius)])
    else:
        north = _core_edge(np.pi - bottom, radius)
    s = (south[:, 0] - south[0, 0]) / (south[-1, 0] - south[0, 0])
    t = (east[:, 1] - east[0, 1]) / (east[-1, 1] - east[0, 1])
    return transfinite(south, north, west, east, s, t)


def _core_edge(angles: Floats, radius: float) -> Floats:
    """Points (n, 2) of the core's edge: a square with bulging sides."""
    square = 1 / np.maximum(abs(np.sin(angles)), abs(np.cos(angles)))
    return _polar(angles, _CORE * radius * (0.7 * square + 0.3), radius)


def _polar(angles: Floats, distance: Floats, radius: float) -> Floats:
    """Points (n, 2) at a distance from the centre (0, radius); angles from the lowest point, positive to the right."""
    return np.column_stack([distance * np.sin(angles), radius - distance * np.cos(angles)])


def _tensor_block(lines: tuple[Floats, ...], order: int, shape: str, axes: dict[str, int]) -> MeshData:
    """Tensor grid of cell ends; `axes` gives each facet group's direction, low side first."""
    positions = [subdivided(line, order) for line in lines]
    points = tensor_points(*positions)
    cells = lattice_cells(tuple(len(line) - 1 for line in lines), order)
    facets = boundary_facets(TENSOR_SHAPE[len(lines)], order, cells)
    groups: dict[str, Ints] = {}
    sides = dict.fromkeys(axes.values(), 0)
    for name, axis in axes.items():
        end = positions[axis][-sides[axis]]
        groups[name] = facets_where(facets, points[:, axis] == end)
        sides[axis] = 1
    return _finished(points, cells, order, shape, groups, np.arange(len(points)) // len(positions[-1]))


def _finished(
    points: Floats, cells: Ints, order: int, shape: str, groups: dict[str, Ints], key: Ints | None
) -> MeshData:
    """The mesh in the wanted shape; points may have two coordinates. Raises MeshError for a wrong shape or order."""
    dimension = points.shape[1]
    tensor = TENSOR_SHAPE[dimension]
    if order not in (1, 2) or shape not in (tensor, SIMPLEX[tensor]):
        raise MeshError(
            f"{dimension}D block: wanted order 1 or 2 and shape {tensor} or {SIMPLEX[tensor]}, found {order}, {shape}"
        )
    points = np.pad(points, ((0, 0), (0, 3 - dimension)))
    mesh = MeshData(points, tensor, order, cells, groups, {"body": np.arange(len(cells))})
    return mesh if shape == tensor else split_to_simplices(mesh, key)
