"""Verification shapes: blocks, discs and spherical caps, as structured grids with graded contact zones.

In 2D x points to the right and y up, in 3D x to the right, y to the back and z up. Shapes touch at the origin: discs
and caps lie above it, graded blocks below it with their tops at height zero. All nodes of a curved contact boundary,
also mid-side nodes, lie on the circle or sphere. All cells are in the volume group "body".

Parameters that all functions share:

order: of the cells, 1 or 2.
shape: of the cells, in 2D "quadrilateral" or "triangle", in 3D "hexahedron" or "tetrahedron".
size: largest cells in the contact zone [mm].
fine: half-width of the contact zone [mm].
fine_depth: depth of the contact zone [mm]; None: fine / 2.
growth: largest ratio of the lengths of neighbouring cells outside the contact zone.

Each raises MeshError for a shape or order that it has not and for lengths that are not above 0, graded ones unless fine
lies inside the block and growth >= 1.
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
from evolvent_meshes.shapes.lengths import check_counts, check_lengths, check_tuples


def rectangle(
    width: float, height: float, nx: int, ny: int, order: int = 2, shape: str = "quadrilateral",
    origin: tuple[float, float] = (0.0, 0.0),
) -> MeshData:
    """Uniform rectangle of nx × ny cells.

    width, height: [mm].
    origin: lower left corner [mm].
    Facet groups: left, right, bottom, top.

    >>> mesh = rectangle(40.0, 20.0, nx=4, ny=2)
    >>> mesh.cells.shape, mesh.points.shape, list(mesh.facets)
    ((8, 9), (45, 3), ['left', 'right', 'bottom', 'top'])
    """
    check_lengths("rectangle", width=width, height=height)
    check_counts("rectangle", nx=nx, ny=ny)
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
    """Uniform box.

    size: lengths along x, y, z [mm].
    counts: cells along x, y, z.
    origin: lowest corner [mm].
    Facet groups: left and right (ends of x), front and back (ends of y), bottom and top (ends of z).
    """
    check_tuples("box", 3, size=size, counts=counts, origin=origin)
    for length, count in zip(size, counts):
        check_lengths("box", size=length)
        check_counts("box", counts=count)
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
    """Rectangle |x| <= width/2, -height <= y <= 0, refined at the centre of its top.

    width, height: [mm].
    Facet groups: left, right, bottom, top.
    """
    lengths = {"width": width, "height": height, "size": size}
    check_lengths("graded_rectangle", **lengths, fine=fine, growth=growth, fine_depth=fine_depth)
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
    """Quarter of a block, 0 <= x, y <= side, -height <= z <= 0, refined at the origin, the centre of the block's top.

    side, height: [mm].
    Facet groups: symmetry_x (x = 0), symmetry_y (y = 0), right (x = side), back (y = side), bottom, top.
    """
    lengths = {"side": side, "height": height, "size": size}
    check_lengths("graded_box", **lengths, fine=fine, growth=growth, fine_depth=fine_depth)
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
    """Quarter of a square block above z = 0 with a spherical underside that touches the origin.

    radius: of the sphere about (0, 0, radius) [mm].
    side: of the quarter, 0 <= x, y <= side [mm].
    height: z of the flat top [mm].
    Facet groups: arc (the sphere), top, symmetry_x (x = 0), symmetry_y (y = 0), right, back.
    Raises MeshError unless the sphere rises less than 0.7 height over the block.
    """
    lengths = {"radius": radius, "side": side, "height": height, "size": size}
    check_lengths("sphere_quarter", **lengths, fine=fine, growth=growth, fine_depth=fine_depth)
    line = graded_ends(side, size, fine, growth)
    z = graded_ends(height, size, fine / 2 if fine_depth is None else fine_depth, growth)
    axes = {"symmetry_x": 0, "right": 0, "symmetry_y": 1, "back": 1, "arc": 2, "top": 2}
    flat = _tensor_block((line, line, z), order, shape, axes)
    points = over_sphere(flat.points, radius, height)
    return MeshData(points, flat.shape, order, flat.cells, flat.facets, flat.volumes)


def over_sphere(points: Floats, radius: float, height: float) -> Floats:
    """Points (n, 3) [mm] of a block, 0 <= z <= height, moved along z so that its underside lies on a sphere.

    radius: of the sphere about (0, 0, radius) [mm].
    height: z of the top, which does not move [mm].
    Raises MeshError unless the sphere rises less than 0.7 height over the block.
    """
    x, y, _ = points.T
    reach = float(np.hypot(x, y).max())
    if reach >= radius or radius - np.sqrt(radius**2 - reach**2) > 0.7 * height:
        raise MeshError(
            f"block over a sphere: wanted a sphere that rises less than 0.7 times the height, found radius {radius}, "
            f"height {height}, a block that reaches {reach:g} mm from the axis; take a smaller side or a larger height"
        )
    return lifted(points, radius - np.sqrt(radius**2 - x**2 - y**2), height)


def lifted(points: Floats, sag: Floats, height: float) -> Floats:
    """Points (n, 3) [mm] of a block, 0 <= z <= height, whose underside is raised by sag (n,) [mm]; its top stays."""
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
    """Disc about (0, radius), or its lower half, refined where it touches the origin.

    radius: [mm].
    half: whether only the lower half is meshed.
    contact: half-width of the facet group arc [mm]; None: 2 fine. The group ends at 45° from the lowest point.
    Facet groups: arc (|x| <= contact), of a half disc top (the flat cut at y = radius).
    The contact zone is fine/2 deep.
    """
    lengths = {"radius": radius, "size": size, "contact": size if contact is None else contact}
    check_lengths("cylinder_2d", **lengths, fine=fine, growth=growth)
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
"""Half-width of the disc's core over the radius."""


def _disc(radius: float, bottom: Floats, depth: Floats, order: int, half: bool) -> tuple[Floats, Ints]:
    """Points (n, 2) and cells of a disc of a core and shells; depth: distances from the arc, ending at the core."""
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
    """Grid (n_angles, n_depths, 2) from the arc (depth 0) to the core (depth 1); angles from the lowest point [rad]."""
    outer = _polar(angles, np.full_like(angles, radius), radius)
    inner = _core_edge(angles, radius)
    return np.asarray(outer[:, None] + depth[:, None] * (inner - outer)[:, None])


def _core(bottom: Floats, right: Floats, radius: float, half: bool) -> Floats:
    """Grid (n_bottom, n_right, 2) of the core by transfinite interpolation of its four edges."""
    south, east, west = (_core_edge(angles, radius) for angles in (bottom, right, -right))
    if half:
        north = np.column_stack([south[:, 0] * east[-1, 0] / south[-1, 0], np.full(len(south), radius)])
    else:
        north = _core_edge(np.pi - bottom, radius)
    s = (south[:, 0] - south[0, 0]) / (south[-1, 0] - south[0, 0])
    t = (east[:, 1] - east[0, 1]) / (east[-1, 1] - east[0, 1])
    return transfinite(south, north, west, east, s, t)


def _core_edge(angles: Floats, radius: float) -> Floats:
    """Points (n, 2) of the core's edge, a square with convex sides."""
    square = 1 / np.maximum(abs(np.sin(angles)), abs(np.cos(angles)))
    return _polar(angles, _CORE * radius * (0.7 * square + 0.3), radius)


def _polar(angles: Floats, distance: Floats, radius: float) -> Floats:
    """Points (n, 2) at a distance from the centre (0, radius); angles [rad] from the lowest point, x > 0 positive."""
    return np.column_stack([distance * np.sin(angles), radius - distance * np.cos(angles)])


def _tensor_block(lines: tuple[Floats, ...], order: int, shape: str, axes: dict[str, int]) -> MeshData:
    """Mesh of a tensor grid of cell ends; axes: facet group -> its direction, the group of the low end first."""
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
    """The mesh in the wanted cell shape, from points (n, 2) or (n, 3). Raises MeshError for a wrong shape or order."""
    dimension = points.shape[1]
    tensor = TENSOR_SHAPE[dimension]
    if order not in (1, 2) or shape not in (tensor, SIMPLEX[tensor]):
        raise MeshError(
            f"{dimension}D block: wanted order 1 or 2 and shape {tensor} or {SIMPLEX[tensor]}, found {order}, {shape}"
        )
    points = np.pad(points, ((0, 0), (0, 3 - dimension)))
    mesh = MeshData(points, tensor, order, cells, groups, {"body": np.arange(len(cells))})
    return mesh if shape == tensor else split_to_simplices(mesh, key)
