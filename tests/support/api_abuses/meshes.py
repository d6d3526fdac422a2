"""Meshes and mesh files that cannot be used."""

# mypy: ignore-errors
# the arguments are of the wrong types on purpose

from __future__ import annotations

import numpy as np

from evolvent import Body, MeshError, read_msh, solve
from evolvent_meshes.shapes.blocks import box, cylinder_2d, graded_box, graded_rectangle, rectangle, sphere_quarter
from evolvent_meshes.shapes.ellipse import ellipse_block, ellipse_punch
from evolvent_meshes.shapes.rings import ring_block, ring_sphere
from tests.support.api_abuses.blocks import (
    CUBE,
    CURVED,
    INF,
    NAN,
    TALL,
    TET,
    UPPER,
    Refused,
    cut_file,
    doubled,
    file,
    gmsh_file,
    lower,
    mesh,
    moved,
    numbered,
    problem,
    upper,
)

MESHES = [
    Refused(
        "path for a mesh", lambda _: Body("block.msh"), ("wanted a MeshData, found 'block.msh'", "read_msh"), MeshError
    ),
    Refused("no mesh", lambda _: Body(None), ("wanted a MeshData, found None",), MeshError),
    Refused("points as a list", mesh(points=UPPER.points.tolist()), ("points \\(n, 3\\).* found a list",), MeshError),
    Refused(
        "plane points", mesh(points=UPPER.points[:, :2]), ("points \\(n, 3\\).* found shape \\(6, 2\\)",), MeshError
    ),
    Refused("integer points", mesh(points=UPPER.points.astype(int)), ("float64.*int64",), MeshError),
    Refused("complex points", mesh(points=UPPER.points + 0j), ("float64.*complex128",), MeshError),
    Refused("points of objects", mesh(points=UPPER.points.astype(object)), ("float64.*object",), MeshError),
    Refused("points of text", mesh(points=UPPER.points.astype(str)), ("float64",), MeshError),
    Refused("no points", mesh(points=np.empty((0, 3))), ("wanted points",), MeshError),
    Refused("NaN point", lambda _: Body(moved(UPPER, 2, (NAN,))), ("1 points of 6.* point 2",), MeshError),
    Refused(
        "infinite point", lambda _: Body(moved(UPPER, 0, (0.0, INF))), ("finite coordinates", "point 0"), MeshError
    ),
    Refused("cells as a list", mesh(cells=UPPER.cells.tolist()), ("integers \\(n, 4\\).* found a list",), MeshError),
    Refused("cells of floats", mesh(cells=UPPER.cells.astype(float)), ("integers .*float64",), MeshError),
    Refused("cells of booleans", mesh(cells=UPPER.cells.astype(bool)), ("integers .*bool",), MeshError),
    Refused("one row of cells", mesh(cells=UPPER.cells[0]), ("integers \\(n, 4\\)",), MeshError),
    Refused("no cells", mesh(cells=UPPER.cells[:0]), ("at least one cell",), MeshError),
    Refused("cell index too large", mesh(cells=UPPER.cells + 1), ("points from 0 to 5", "count the points"), MeshError),
    Refused("negative cell index", mesh(cells=UPPER.cells - 1), ("points from 0 to 5", "-1"), MeshError),
    Refused(
        "eight-node cells", mesh(CURVED, cells=CURVED.cells[:, :8]), ("\\(n, 9\\)", "SecondOrderIncomplete"), MeshError
    ),
    Refused("order too high", mesh(order=3), ("order 1 or 2, found 3",), MeshError),
    Refused("order zero", mesh(order=0), ("order 1 or 2, found 0",), MeshError),
    Refused("order as text", mesh(order="1"), ("order 1 or 2, found '1'",), MeshError),
    Refused("order as a float", mesh(order=1.0), ("order 1 or 2, found 1.0",), MeshError),
    Refused("order True", mesh(order=True), ("order 1 or 2, found True",), MeshError),
    Refused("order that the cells have not", mesh(order=2), ("\\(n, 9\\).* \\(2, 4\\)",), MeshError),
    Refused("shape quad", mesh(shape="quad"), ("triangle, quadrilateral.* found 'quad'",), MeshError),
    Refused("shape None", mesh(shape=None), ("found None",), MeshError),
    Refused("shape of 3D", mesh(shape="hexahedron"), ("\\(n, 8\\)",), MeshError),
    Refused("shape that is a list", mesh(shape=["triangle"]), ("found \\['triangle'\\]",), MeshError),
    Refused(
        "tetrahedra for quadrilaterals",
        mesh(TET, shape="quadrilateral", facets={}),
        ("quadrilaterals in the plane z = 0",),
        MeshError,
    ),
    Refused(
        "loose point", mesh(points=np.vstack([UPPER.points, [[9.0, 9, 0]]])), ("1 points in none", "point 6"), MeshError
    ),
    Refused("cell twice", mesh(cells=UPPER.cells[[0, 1, 0]]), ("every cell once, found 1",), MeshError),
    Refused(
        "cell twice, turned", mesh(cells=np.vstack([UPPER.cells, np.roll(UPPER.cells[:1], 1, 1)])), ("once",), MeshError
    ),
    Refused("size zero", mesh(points=0.0 * UPPER.points), ("found 2 of 2 cells folded or flat",), MeshError),
    Refused("flat cells", mesh(points=UPPER.points * [1, 0, 1]), ("found 2 of 2 cells folded or flat",), MeshError),
    Refused("flat hexahedron", mesh(CUBE, points=CUBE.points * [1, 1, 0]), ("found 1 of 1 cells folded",), MeshError),
    Refused(
        "folded inside", lambda _: Body(moved(TALL, 4, (2.5, 2.5))), ("of 4 cells folded", "worst is cell"), MeshError
    ),
    Refused("inverted hexahedron", lambda _: Body(moved(CUBE, 7, (-1, -1, -1))), ("1 of 1 cells folded",), MeshError),
    Refused(
        "folded middle node",
        lambda _: Body(moved(CURVED, int(CURVED.cells[0, 4]), (0.99,))),
        ("1 of 4 cells",),
        MeshError,
    ),
    Refused("node twice in a cell", lambda _: Body(numbered(TALL, 0, 0, 1, 4, 4)), ("wanted",), MeshError),
    Refused("all clockwise", mesh(cells=UPPER.cells[:, ::-1].copy()), ("counter-clockwise", "turned_over"), MeshError),
    Refused(
        "one clockwise",
        lambda _: Body(numbered(UPPER, 0, *UPPER.cells[0, ::-1])),
        ("1 of 2 cells folded", "number"),
        MeshError,
    ),
    Refused(
        "bent plane",
        mesh(points=UPPER.points + [[0, 0, 1]] * (np.arange(6) == 2)[:, None]),
        ("plane z = 0",),
        MeshError,
    ),
    Refused("no facet groups", mesh(facets=None), ("facet groups by their names",), MeshError),
    Refused("facet groups as a list", mesh(facets=[1]), ("facet groups by their names",), MeshError),
    Refused("facet groups by number", mesh(facets={1: UPPER.facets["top"]}), ("by their names",), MeshError),
    Refused("facets of floats", mesh(facets={"top": UPPER.facets["top"] * 1.0}), ("group 'top'.*float64",), MeshError),
    Refused(
        "facets beyond the points", mesh(facets={"top": UPPER.facets["top"] + 9}), ("points from 0 to 5",), MeshError
    ),
    Refused("facets of three nodes", mesh(facets={"top": UPPER.cells[:, :3]}), ("\\(n, 2\\)",), MeshError),
    Refused(
        "two loose pieces", lambda _: solve(problem((upper(doubled(UPPER)), lower()))), ("2 pieces", "weld"), MeshError
    ),
    Refused("points beyond the universe", mesh(points=UPPER.points * 1e200), ("numbers up to 1e\\+30", "unit")),
    Refused("turn over in 3D", lambda _: CUBE.turned_over(), ("2D mesh",), MeshError),
]

FILES = [
    Refused("no file", lambda f: read_msh(f / "none.msh"), ("found nothing at", "check the path"), MeshError),
    Refused("folder for a file", lambda f: read_msh(f), ("found a folder",), MeshError),
    Refused("number for a file", lambda _: read_msh(5), ("path of a gmsh file, found 5",), MeshError),
    Refused("None for a file", lambda _: read_msh(None), ("path of a gmsh file, found None",), MeshError),
    Refused("empty file", file(b""), ("found an empty file",), MeshError),
    Refused("binary junk", file(bytes(range(256)) * 9), ("begins with", "save it as .msh"), MeshError),
    Refused("an STL surface", file(b"solid\nendsolid\n", "part.stl"), ("MSH format",), MeshError),
    Refused("a script that runs a command", file(b'SystemCall "touch gone";'), ("MSH format",), MeshError),
    Refused("a name without end", lambda _: read_msh("x" * 5000), ("file that can be read",), MeshError),
    Refused("a NUL in the name", lambda _: read_msh("a\0b"), ("found nothing at",), MeshError),
    Refused("half a file", cut_file(0.5), ("complete mesh",), MeshError),
    Refused("nearly a whole file", cut_file(0.97), ("complete mesh",), MeshError),
    Refused("header only", file(b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"), ("named physical volume",), MeshError),
    Refused("no named body", gmsh_file(names=("", "top")), ("named physical volume",), MeshError),
    Refused("third order", gmsh_file(order=3), ("order 1 or 2",), MeshError),
    Refused("mixed cells", gmsh_file(recombine=1), ("one cell shape", "recombine everywhere or nowhere"), MeshError),
    Refused("serendipity", gmsh_file(order=2, recombine=2, incomplete=1), ("SecondOrderIncomplete = 0",), MeshError),
]

SHAPES = [
    Refused(f"shape, {name}", lambda _, make=make: make(), words, MeshError)
    for name, make, words in (
        ("width as text", lambda: graded_rectangle("20", 10, 0.1, 1.0), ("graded_rectangle, width: .* found '20'",)),
        ("negative size", lambda: graded_rectangle(20, 10, -0.1, 1.0), ("graded_rectangle, size: .* found -0.1",)),
        ("no height", lambda: graded_rectangle(20, 0.0, 0.1, 1.0), ("graded_rectangle, height: .* found 0.0",)),
        ("no growth", lambda: graded_rectangle(20, 10, 0.1, 1.0, growth=0.9), ("growth: .* from 1 on, found 0.9",)),
        ("depth as text", lambda: graded_rectangle(20, 10, 0.1, 1.0, fine_depth="1"), ("fine_depth: .* found '1'",)),
        ("count as a float", lambda: rectangle(20, 10, 2.0, 2), ("rectangle, nx: wanted a whole number",)),
        ("number for a size", lambda: box(1.0, (1, 1, 1)), ("box, size: wanted a tuple of 3 numbers, found 1.0",)),
        ("no cells of a box", lambda: box((1.0, 1.0, 1.0), (1, 0, 1)), ("box, counts: .* found 0",)),
        ("side as text", lambda: graded_box("5", 5, 0.1, 1.0), ("graded_box, side: .* found '5'",)),
        ("radius NaN", lambda: sphere_quarter(NAN, 4, 4, 0.2, 0.7), ("sphere_quarter, radius: .* found nan",)),
        ("cylinder of text", lambda: cylinder_2d("10", 0.1, 1.0), ("cylinder_2d, radius: .* found '10'",)),
        ("fine None", lambda: cylinder_2d(10, 0.1, None), ("cylinder_2d, fine: .* from 0 on, found None",)),
        ("ring as text", lambda: ring_block(4, 4, "1", 0.2, 2), ("ring_block, ring: .* found '1'",)),
        ("ring of no sphere", lambda: ring_sphere(0, 4, 4, 1, 0.2, 2), ("ring_sphere, radius: .* found 0",)),
        ("one half-axis", lambda: ellipse_block(1.0, 4, 0.2, 2), ("half_axes: wanted a tuple of 2 numbers",)),
        ("curvature as text", lambda: ellipse_punch((1, 1), ("1", 1), 4, 0.2, 2), ("curvatures: .* found '1'",)),
    )
]


ROWS = [*MESHES, *FILES, *SHAPES]
