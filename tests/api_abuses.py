"""What a user of the public API may get wrong, and what must come of it: one clear error, or the right number.

Every row builds all that it needs, from two flat blocks of a few cells: `UPPER` stands on `LOWER`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import gmsh
import numpy as np

from meshes.blocks import box, rectangle
from meshes.gmsh_io import gmsh_model, write_msh
from solver.problem import (
    Body,
    BodyForce,
    Contact,
    EvolventError,
    Fixed,
    Freedom,
    InputError,
    Material,
    MeshData,
    MeshError,
    Nitsche,
    Placement,
    Problem,
    Rigid,
    SearchError,
    Step,
    Sweep,
    Traction,
    cell_stress,
    reactions,
    read_msh,
    solve,
    sweep,
    write_paraview,
)

NAN, INF = float("nan"), float("inf")
PRESSURE = 100.0

UPPER = rectangle(2.0, 1.0, 2, 1, 1, origin=(0.0, 1.0))
LOWER = rectangle(2.0, 1.0, 3, 1, 1)
CUBE = box((1.0, 1.0, 1.0), (1, 1, 1), 1)
CURVED = rectangle(2.0, 1.0, 2, 2, 2)
TALL = rectangle(2.0, 2.0, 2, 2, 1)
TET = box((1.0, 1.0, 1.0), (1, 1, 1), 1, "tetrahedron")


@dataclass(frozen=True)
class Abuse:
    """name: what is wrong. call: given a folder, does it. error, words: what it has to raise, with these words."""

    name: str
    call: Callable[[Path], Any]
    words: tuple[str, ...]
    error: type[EvolventError] = InputError


@dataclass(frozen=True)
class Fine:
    """Odd but right: `call` gives a number or array that has to be `wanted`, to this relative accuracy."""

    name: str
    call: Callable[[Path], Any]
    wanted: Any
    accuracy: float = 1e-8


def steel(**changes: Any) -> Material:
    return Material(**{"youngs_modulus": 210e3, "poissons_ratio": 0.3, **changes})


def upper(mesh: Any = UPPER, **changes: Any) -> Body:
    """Pressed from above, led at its left side."""
    stated = {"supports": (Fixed("left", "x"),), "loads": (Traction("top", (0.0, -PRESSURE)),), "name": "upper"}
    return Body(mesh, **{**stated, **changes})


def lower(mesh: Any = LOWER, **changes: Any) -> Body:
    """Stands on its bottom."""
    return Body(mesh, **{"supports": (Fixed("left", "x"), Fixed("bottom", "y")), "name": "lower", **changes})


def problem(bodies: Any = None, contacts: Any = None, **changes: Any) -> Problem:
    bodies = (upper(), lower()) if bodies is None else bodies
    return Problem(bodies, (contact(),) if contacts is None else contacts, **changes)


def contact(first: Any = (0, "bottom"), second: Any = (1, "top"), **changes: Any) -> Contact:
    return Contact(first, second, **{"reach": 0.1, **changes})


def pressures(stated: Problem, step: Step | None = None) -> Any:
    return solve(stated, step).contacts[0].pressure


def force(stated: Problem, step: Step | None = None) -> Any:
    return solve(stated, step).contacts[0].force


def mesh(base: MeshData = UPPER, **changes: Any) -> Callable[[Path], Body]:
    """A body on a mesh of which something has been replaced."""
    return lambda _: Body(replace(base, **changes), name="upper")


def moved(base: MeshData, node: int, place: tuple[float, ...]) -> MeshData:
    points = base.points.copy()
    points[node, : len(place)] = place
    return replace(base, points=points)


def numbered(base: MeshData, row: int, *nodes: int) -> MeshData:
    cells = base.cells.copy()
    cells[row] = nodes
    return replace(base, cells=cells)


def group(base: MeshData, name: str, facets: Any) -> MeshData:
    return replace(base, facets={**base.facets, name: np.asarray(facets, dtype=np.int64)})


def file(content: bytes, name: str = "mesh.msh") -> Callable[[Path], MeshData]:
    """Reads a file of this content."""

    def read(folder: Path) -> MeshData:
        (folder / name).write_bytes(content)
        return read_msh(folder / name)

    return read


def cut_file(share: float) -> Callable[[Path], MeshData]:
    """Reads a mesh of which only the beginning has been written."""

    def read(folder: Path) -> MeshData:
        write_msh(UPPER, folder / "whole.msh")
        whole = (folder / "whole.msh").read_bytes()
        return file(whole[: int(share * len(whole))])(folder)

    return read


def gmsh_file(order: int = 1, names: tuple[str, str] = ("body", "top"), **options: float) -> Callable[[Path], MeshData]:
    """Reads a square that gmsh has meshed in some way; "recombine": the second half in quadrilaterals."""

    def read(folder: Path) -> MeshData:
        with gmsh_model("square"):
            halves = [gmsh.model.occ.addRectangle(x, 0, 0, 1, 1) for x in (0, 2)]
            gmsh.model.occ.synchronize()
            if names[0]:
                gmsh.model.addPhysicalGroup(2, halves, name=names[0])
            gmsh.model.addPhysicalGroup(1, [3], name=names[1])
            gmsh.option.setNumber("Mesh.SecondOrderIncomplete", options.get("incomplete", 0))
            for half in halves[: int(options.get("recombine", 0))]:
                gmsh.model.mesh.setRecombine(2, half)
            gmsh.model.mesh.generate(2)
            gmsh.model.mesh.setOrder(order)
            gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 0)
            gmsh.write(str(folder / "square.msh"))
        return read_msh(folder / "square.msh")

    return read


def apart(distance: float) -> Problem:
    return problem((upper(moved_all(UPPER, distance)), lower()))


def moved_all(base: MeshData, up: float) -> MeshData:
    return replace(base, points=base.points + np.array([0.0, up, 0.0]))


def doubled(base: MeshData) -> MeshData:
    """The same cells twice side by side, with nothing that joins them."""
    n = len(base.points)
    facets = {name: np.concatenate([rows, rows + n]) for name, rows in base.facets.items()}
    points = np.concatenate([base.points, base.points + np.array([3.0, 0.0, 0.0])])
    return replace(base, points=points, cells=np.concatenate([base.cells, base.cells + n]), facets=facets, volumes={})


MESHES = [
    Abuse("path for a mesh", lambda _: Body("block.msh"), ("wanted a MeshData, found 'block.msh'", "read_msh"), MeshError),
    Abuse("no mesh", lambda _: Body(None), ("wanted a MeshData, found None",), MeshError),
    Abuse("points as a list", mesh(points=UPPER.points.tolist()), ("points \\(n, 3\\).* found a list",), MeshError),
    Abuse("plane points", mesh(points=UPPER.points[:, :2]), ("points \\(n, 3\\).* found shape \\(6, 2\\)",), MeshError),
    Abuse("integer points", mesh(points=UPPER.points.astype(int)), ("float64.*int64",), MeshError),
    Abuse("complex points", mesh(points=UPPER.points + 0j), ("float64.*complex128",), MeshError),
    Abuse("points of objects", mesh(points=UPPER.points.astype(object)), ("float64.*object",), MeshError),
    Abuse("points of text", mesh(points=UPPER.points.astype(str)), ("float64",), MeshError),
    Abuse("no points", mesh(points=np.empty((0, 3))), ("wanted points",), MeshError),
    Abuse("NaN point", lambda _: Body(moved(UPPER, 2, (NAN,))), ("1 points of 6.* point 2",), MeshError),
    Abuse("infinite point", lambda _: Body(moved(UPPER, 0, (0.0, INF))), ("finite coordinates", "point 0"), MeshError),
    Abuse("cells as a list", mesh(cells=UPPER.cells.tolist()), ("integers \\(n, 4\\).* found a list",), MeshError),
    Abuse("cells of floats", mesh(cells=UPPER.cells.astype(float)), ("integers .*float64",), MeshError),
    Abuse("cells of booleans", mesh(cells=UPPER.cells.astype(bool)), ("integers .*bool",), MeshError),
    Abuse("one row of cells", mesh(cells=UPPER.cells[0]), ("integers \\(n, 4\\)",), MeshError),
    Abuse("no cells", mesh(cells=UPPER.cells[:0]), ("at least one cell",), MeshError),
    Abuse("cell index too large", mesh(cells=UPPER.cells + 1), ("points from 0 to 5", "count the points"), MeshError),
    Abuse("negative cell index", mesh(cells=UPPER.cells - 1), ("points from 0 to 5", "-1"), MeshError),
    Abuse("eight-node cells", mesh(CURVED, cells=CURVED.cells[:, :8]), ("\\(n, 9\\)", "SecondOrderIncomplete"), MeshError),
    Abuse("order too high", mesh(order=3), ("order 1 or 2, found 3",), MeshError),
    Abuse("order zero", mesh(order=0), ("order 1 or 2, found 0",), MeshError),
    Abuse("order as text", mesh(order="1"), ("order 1 or 2, found '1'",), MeshError),
    Abuse("order as a float", mesh(order=1.0), ("order 1 or 2, found 1.0",), MeshError),
    Abuse("order True", mesh(order=True), ("order 1 or 2, found True",), MeshError),
    Abuse("order that the cells have not", mesh(order=2), ("\\(n, 9\\).* \\(2, 4\\)",), MeshError),
    Abuse("shape quad", mesh(shape="quad"), ("triangle, quadrilateral.* found 'quad'",), MeshError),
    Abuse("shape None", mesh(shape=None), ("found None",), MeshError),
    Abuse("shape of 3D", mesh(shape="hexahedron"), ("\\(n, 8\\)",), MeshError),
    Abuse("shape that is a list", mesh(shape=["triangle"]), ("found \\['triangle'\\]",), MeshError),
    Abuse("tetrahedra for quadrilaterals", mesh(TET, shape="quadrilateral", facets={}), ("quadrilaterals in the plane z = 0",), MeshError),
    Abuse("loose point", mesh(points=np.vstack([UPPER.points, [[9.0, 9, 0]]])), ("1 points in none", "point 6"), MeshError),
    Abuse("cell twice", mesh(cells=UPPER.cells[[0, 1, 0]]), ("every cell once, found 1",), MeshError),
    Abuse("cell twice, turned", mesh(cells=np.vstack([UPPER.cells, np.roll(UPPER.cells[:1], 1, 1)])), ("once",), MeshError),
    Abuse("size zero", mesh(points=0.0 * UPPER.points), ("found 2 of 2 cells folded or flat",), MeshError),
    Abuse("flat cells", mesh(points=UPPER.points * [1, 0, 1]), ("found 2 of 2 cells folded or flat",), MeshError),
    Abuse("flat hexahedron", mesh(CUBE, points=CUBE.points * [1, 1, 0]), ("found 1 of 1 cells folded",), MeshError),
    Abuse("folded inside", lambda _: Body(moved(TALL, 4, (2.5, 2.5))), ("of 4 cells folded", "worst is cell"), MeshError),
    Abuse("inverted hexahedron", lambda _: Body(moved(CUBE, 7, (-1, -1, -1))), ("1 of 1 cells folded",), MeshError),
    Abuse("folded middle node", lambda _: Body(moved(CURVED, int(CURVED.cells[0, 4]), (0.99,))), ("1 of 4 cells",), MeshError),
    Abuse("node twice in a cell", lambda _: Body(numbered(TALL, 0, 0, 1, 4, 4)), ("wanted",), MeshError),
    Abuse("all clockwise", mesh(cells=UPPER.cells[:, ::-1].copy()), ("counter-clockwise", "turned_over"), MeshError),
    Abuse("one clockwise", lambda _: Body(numbered(UPPER, 0, *UPPER.cells[0, ::-1])), ("1 of 2 cells folded", "number"), MeshError),
    Abuse("bent plane", mesh(points=UPPER.points + [[0, 0, 1]] * (np.arange(6) == 2)[:, None]), ("plane z = 0",), MeshError),
    Abuse("no facet groups", mesh(facets=None), ("facet groups by their names",), MeshError),
    Abuse("facet groups as a list", mesh(facets=[1]), ("facet groups by their names",), MeshError),
    Abuse("facet groups by number", mesh(facets={1: UPPER.facets["top"]}), ("by their names",), MeshError),
    Abuse("facets of floats", mesh(facets={"top": UPPER.facets["top"] * 1.0}), ("group 'top'.*float64",), MeshError),
    Abuse("facets beyond the points", mesh(facets={"top": UPPER.facets["top"] + 9}), ("points from 0 to 5",), MeshError),
    Abuse("facets of three nodes", mesh(facets={"top": UPPER.cells[:, :3]}), ("\\(n, 2\\)",), MeshError),
    Abuse("two loose pieces", lambda _: solve(problem((upper(doubled(UPPER)), lower()))), ("2 pieces", "weld"), MeshError),
    Abuse("turn over in 3D", lambda _: CUBE.turned_over(), ("2D mesh",), MeshError),
]

FILES = [
    Abuse("no file", lambda f: read_msh(f / "none.msh"), ("found nothing at", "check the path"), MeshError),
    Abuse("folder for a file", lambda f: read_msh(f), ("found a folder",), MeshError),
    Abuse("number for a file", lambda _: read_msh(5), ("path of a gmsh file, found 5",), MeshError),
    Abuse("None for a file", lambda _: read_msh(None), ("path of a gmsh file, found None",), MeshError),
    Abuse("empty file", file(b""), ("found an empty file",), MeshError),
    Abuse("binary junk", file(bytes(range(256)) * 9), ("begins with", "save it as .msh"), MeshError),
    Abuse("an STL surface", file(b"solid\nendsolid\n", "part.stl"), ("MSH format",), MeshError),
    Abuse("a script that runs a command", file(b'SystemCall "touch gone";'), ("MSH format",), MeshError),
    Abuse("half a file", cut_file(0.5), ("whole mesh",), MeshError),
    Abuse("nearly a whole file", cut_file(0.97), ("whole mesh",), MeshError),
    Abuse("header only", file(b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"), ("named physical volume",), MeshError),
    Abuse("no named body", gmsh_file(names=("", "top")), ("named physical volume",), MeshError),
    Abuse("third order", gmsh_file(order=3), ("order 1 or 2",), MeshError),
    Abuse("mixed cells", gmsh_file(recombine=1), ("one cell shape", "recombine everywhere or nowhere"), MeshError),
    Abuse("serendipity", gmsh_file(order=2, recombine=2, incomplete=1), ("SecondOrderIncomplete = 0",), MeshError),
]

MATERIALS = [
    Abuse(f"E = {E!r}", lambda _, E=E: Material(E, 0.3), ("youngs_modulus: wanted a finite number > 0",))
    for E in (0.0, -210e3, NAN, INF, "210e3", None, True, [210e3], np.array([210e3]), 1j)
] + [
    Abuse(f"ν = {ν!r}", lambda _, ν=ν: Material(210e3, ν), ("poissons_ratio: wanted −1 < ν < 0.5",))
    for ν in (0.5, 0.7, -1.0, NAN, "0.3", None, False)
] + [
    Abuse("text for a material", lambda _: upper(material="steel"), ("upper: wanted a Material, found 'steel'",)),
    Abuse("a modulus for a material", lambda _: upper(material=210e3), ("wanted a Material, found 210000.0",)),
]  # fmt: skip

SUPPORTS = [
    Abuse(f"directions {letters!r}", lambda _, letters=letters: Fixed("top", letters), ('out of "xyz"', "write"))
    for letters in ("", "q", "xyzw", "xx", "X", "x,y", None, 0, ("x",))
] + [
    Abuse(f"support of {name!r}", lambda _, name=name: Fixed(name), ("support: wanted a name", "facet group"))
    for name in (None, 3, "", ("top",))
] + [
    Abuse(f"displaced by {u!r}", lambda _, u=u: Fixed("top", "y", u), ("wanted a finite displacement",))
    for u in (NAN, INF, "0.1", None, True)
] + [
    Abuse("displaced in no direction", lambda _: Fixed("top", displacement=0.1), ("one direction",)),
    Abuse("displaced in two directions", lambda _: Fixed("top", "xy", 0.1), ("one direction", "found 'xy'")),
    Abuse("z in 2D", lambda _: upper(supports=(Fixed("top", "z"),)), ('out of "xy", as the body is 2D',)),
    Abuse("x and z in 2D", lambda _: upper(supports=(Fixed("top", "xz"),)), ('out of "xy"', "found 'xz'")),
    Abuse("unknown group held", lambda _: upper(supports=(Fixed("floor"),)), ("bottom, left, right, top, found 'floor'",), MeshError),
    Abuse("empty group held", lambda _: upper(group(UPPER, "none", np.empty((0, 2))), supports=(Fixed("none"),)), ("empty",), MeshError),
    Abuse("support without a comma", lambda _: upper(supports=(Fixed("left", "x"))), ("a tuple of Fixed", "write")),
    Abuse("names for supports", lambda _: upper(supports=("left",)), ("found 'left' in it",)),
    Abuse("text for supports", lambda _: upper(supports="left"), ("a tuple of Fixed, found 'left'",)),
    Abuse("None for supports", lambda _: upper(supports=None), ("a tuple of Fixed, found None",)),
    Abuse("load among the supports", lambda _: upper(supports=(Traction("top", (0.0, 1.0)),)), ("found a Traction",)),
    Abuse("supports that contradict", lambda _: upper(supports=(Fixed("top", "y", 0.1), Fixed("top", "y", 0.2))), ("one displacement along y", "0.2 mm and 0.1 mm")),
    Abuse("contradiction at a corner", lambda _: upper(supports=(Fixed("left", "y"), Fixed("top", "y", 0.1))), ("0.1 mm and 0 mm", "shared nodes")),
    Abuse("coupling moved by a support", lambda _: upper(supports=(Fixed("top", "y", 0.1),), rigid=Rigid("top"), loads=()), ("a rigid coupling",)),
]  # fmt: skip

LOADS = [
    Abuse(f"traction {vector!r}", lambda _, vector=vector: Traction("top", vector), ("two finite components", "one number a direction"))
    for vector in ((1.0,), (), (1.0, 2.0, 3.0, 4.0), (NAN, 0.0), (0.0, INF), -100.0, "down", None, ("0", "-1"), ((0.0, 1.0),), np.eye(2))
] + [
    Abuse("three components in 2D", lambda _: upper(loads=(Traction("top", (0.0, 0.0, -1.0)),)), ("traction on 'top': wanted 2 components", "2D")),
    Abuse("two components in 3D", lambda _: Body(CUBE, loads=(Traction("top", (0.0, -1.0)),)), ("wanted 3 components",)),
    Abuse("three-dimensional weight in 2D", lambda _: upper(loads=(BodyForce((0.0, 0.0, -1.0)),)), ("body force: wanted 2 components",)),
    Abuse("weight as a number", lambda _: BodyForce(7.7e-5), ("two finite components \\[N/mm³\\]",)),
    Abuse("weight not a number", lambda _: BodyForce((0.0, NAN)), ("two finite components",)),
    Abuse("traction on nothing", lambda _: Traction("", (0.0, 1.0)), ("wanted a name",)),
    Abuse("traction on an unknown group", lambda _: upper(loads=(Traction("roof", (0.0, 1.0)),)), ("found 'roof'",), MeshError),
    Abuse("traction inside", lambda _: Body(group(TALL, "cut", [[1, 4]]), loads=(Traction("cut", (0.0, 1.0)),)), ("'cut'", "found 2 behind"), MeshError),
    Abuse("traction across cells", lambda _: Body(group(TALL, "far", [[0, 8]]), loads=(Traction("far", (0.0, 1.0)),)), ("'far'", "found 0 behind"), MeshError),
    Abuse("facet loaded twice", lambda _: upper(group(UPPER, "top", UPPER.facets["top"][[0, 0]])), ("each facet once",), MeshError),
    Abuse("load without a comma", lambda _: upper(loads=Traction("top", (0.0, 1.0))), ("a tuple of Traction or BodyForce",)),
    Abuse("support among the loads", lambda _: upper(loads=(Fixed("top"),)), ("found a Fixed",)),
    Abuse("vector among the loads", lambda _: upper(loads=((0.0, -1.0),)), ("found \\(0.0, -1.0\\) in it",)),
]  # fmt: skip

COUPLINGS = [
    Abuse(f"freedom {name!r}", lambda _, name=name: Freedom(name, load=1.0), ("one of the rigid motions x, y, z",))
    for name in ("w", "", "xy", "X", None, 1, ["x"])
] + [
    Abuse(f"freedom loaded by {load!r}", lambda _, load=load: Freedom("x", load=load), ("finite load",))
    for load in (NAN, INF, -INF, "1", True, [1.0])
] + [
    Abuse("freedom moved by NaN", lambda _: Freedom("x", displacement=NAN), ("finite load or displacement",)),
    Abuse("freedom without a value", lambda _: Freedom("x"), ("either a load or a displacement, found neither",)),
    Abuse("freedom with two values", lambda _: Freedom("x", 1.0, 1.0), ("found both",)),
    Abuse("z in 2D is no freedom", lambda _: upper(rigid=Rigid("top", (Freedom("z", 1.0),))), ("rigid motion of x, y, rz",)),
    Abuse("rx in 2D is no freedom", lambda _: upper(rigid=Rigid("top", (Freedom("rx", 1.0),))), ("found 'rx'",)),
    Abuse("freedom twice", lambda _: Rigid("top", (Freedom("y", 1.0), Freedom("y", displacement=1.0))), ("each freedom once",)),
    Abuse("freedom without a comma", lambda _: Rigid("top", (Freedom("y", 1.0))), ("a tuple of Freedom",)),
    Abuse("names for freedoms", lambda _: Rigid("top", ("y",)), ("found 'y' in it",)),
    Abuse("text for freedoms", lambda _: Rigid("top", "y"), ("a tuple of Freedom, found 'y'",)),
    Abuse("coupling of no group", lambda _: Rigid(None), ("rigid coupling: wanted a name, found None",)),
    Abuse("coupling of an unknown group", lambda _: upper(rigid=Rigid("lid")), ("found 'lid'",), MeshError),
    Abuse("centre not a number", lambda _: Rigid("top", centre=(0.0, NAN, 0.0)), ("a centre of two or three",)),
    Abuse("centre as a number", lambda _: Rigid("top", centre=1.0), ("a centre of two or three",)),
    Abuse("plane centre in 3D", lambda _: Body(CUBE, rigid=Rigid("top", centre=(0.0, 1.0))), ("centre of 3",)),
    Abuse("name for a coupling", lambda _: upper(rigid="top"), ("rigid: wanted a Rigid, found 'top'",)),
    Abuse("coupling that a support holds", lambda _: solve(problem((Body(UPPER, supports=(Fixed("left"),), rigid=Rigid("top", (Freedom("y", 1.0),))), lower()))), ("supports that allow the freedoms y", "Fixed\\(group")),
    Abuse("number for a body's name", lambda _: upper(name=5), ("body: wanted a name, found 5",)),
    Abuse("no name for a body", lambda _: upper(name=""), ("wanted a name",)),
]  # fmt: skip

CONTACTS = [
    Abuse(f"friction {μ!r}", lambda _, μ=μ: contact(friction=μ), ("friction: wanted a finite number >= 0", "Coulomb"))
    for μ in (-0.1, NAN, INF, "0.1", None, True, [0.1])
] + [
    Abuse(f"reach {reach!r}", lambda _, reach=reach: contact(reach=reach), ("reach: wanted a finite number > 0", "leave it out"))
    for reach in (0.0, -1.0, NAN, INF, "far", False)
] + [
    Abuse(f"side {side!r}", lambda _, side=side: contact(side), ("first side: wanted a body's index and a facet group",))
    for side in ("bottom", 0, None, ("bottom", 0), (0,), (0, "bottom", 1), (0.0, "bottom"), (True, "bottom"), (0, None))
] + [
    Abuse("surface against itself", lambda _: contact((0, "top"), (0, "top")), ("two different surfaces",)),
    Abuse("body that is not there", lambda _: problem(contacts=(contact(second=(2, "top")),)), ("index below 2, found 2",)),
    Abuse("negative body", lambda _: problem(contacts=(contact(second=(-1, "top")),)), ("index below 2, found -1",)),
    Abuse("unknown group in contact", lambda _: problem(contacts=(contact(second=(1, "roof")),)), ("'lower'", "found 'roof'"), MeshError),
    Abuse("empty group in contact", lambda _: problem((upper(), lower(group(LOWER, "top", np.empty((0, 2)))))), ("'top', found it empty",), MeshError),
    Abuse("contact inside a body", lambda _: Problem((Body(group(TALL, "cut", [[1, 4]])), lower()), (contact((0, "cut")),)), ("'cut'", "found 2 behind"), MeshError),
    Abuse("facets twice in contact", lambda _: problem((upper(), lower(group(LOWER, "top", LOWER.facets["top"][[0, 0, 1]])))), ("each facet once",), MeshError),
    Abuse("body without contact", lambda _: problem((upper(), lower(), lower())), ("body 2 \\('lower'\\)",)),
    Abuse("no contacts", lambda _: problem(contacts=()), ("at least one contact",)),
    Abuse("no bodies", lambda _: problem((), ()), ("at least one contact",)),
    Abuse("one body for bodies", lambda _: problem(upper()), ("a tuple of Body",)),
    Abuse("mesh for a body", lambda _: problem((UPPER, LOWER)), ("found a MeshData",)),
    Abuse("contact without a comma", lambda _: problem(contacts=(contact())), ("a tuple of Contact",)),
    Abuse("2D against 3D", lambda _: problem((upper(), Body(CUBE, supports=(Fixed("bottom"),)))), ("all bodies in 2D or all in 3D, found both",)),
    Abuse("contact twice", lambda _: problem(contacts=(contact(), contact())), ("every pair of surfaces in one contact",)),
    Abuse("contact twice, turned", lambda _: problem(contacts=(contact(), contact((1, "top"), (0, "bottom")))), ("leave out one",)),
    Abuse("contact twice, under another name", lambda _: problem((upper(), lower(group(LOWER, "part", LOWER.facets["top"][:1]))), (contact(), contact(second=(1, "part")))), ("every pair of surfaces",)),
    Abuse("part against the whole", lambda _: Problem((upper(group(UPPER, "part", UPPER.facets["top"][:1])),), (contact((0, "part"), (0, "top")),)), ("without common facets",)),
    Abuse("text for nitsche", lambda _: problem(nitsche="skew"), ("wanted a Nitsche",)),
] + [
    Abuse(f"safety {x!r}", lambda _, x=x: Nitsche(safety=x), ("safety: wanted a finite number > 0",))
    for x in (0.0, -2.0, NAN, INF, "2", None)
] + [
    Abuse(f"theta {x!r}", lambda _, x=x: Nitsche(theta=x), ("theta: wanted −1 <= θ <= 1",))
    for x in (2.0, -1.5, NAN, "1", None)
]  # fmt: skip

PLACEMENTS = [
    Abuse(f"rotation {name}", lambda _, R=R: Placement(R, np.zeros(2)), words)
    for name, R, words in (
        ("that enlarges", 2.0 * np.eye(2), ("a rotation", "cannot be scaled")),
        ("that mirrors", np.diag([1.0, -1.0]), ("det R = 1",)),
        ("that shears", np.array([[1.0, 0.1], [0.0, 1.0]]), ("a rotation",)),
        ("of zeros", np.zeros((2, 2)), ("a rotation",)),
        ("rounded to three digits", [[0.866, -0.5], [0.5, 0.866]], ("full precision",)),
        ("not a number", np.full((2, 2), NAN), ("finite numbers of shape",)),
        ("3 by 2", np.eye(3)[:, :2], ("shape \\(2, 2\\) or \\(3, 3\\)",)),
        ("1 by 1", [[1.0]], ("shape \\(2, 2\\)",)),
        ("as an angle", 0.1, ("shape \\(2, 2\\)",)),
        ("of text", [["1", "0"], ["0", "1"]], ("finite numbers",)),
        ("with ragged rows", [[1.0, 0.0], [0.0]], ("finite numbers",)),
        ("None", None, ("finite numbers",)),
        ("of booleans", np.eye(2, dtype=bool), ("finite numbers",)),
    )
] + [
    Abuse(f"translation {x!r}", lambda _, x=x: Placement(np.eye(2), x), ("translation: wanted finite numbers of shape \\(2,\\)",))
    for x in ((0.0, 0.0, 0.0), (0.0,), (0.0, NAN), 1.0, None, "xy")
]  # fmt: skip

REST = Placement.at_rest(2)
STEPS = [
    Abuse(f"load factor {x!r}", lambda _, x=x: Step(x), ("step, load: wanted a finite factor",))
    for x in (NAN, INF, "1", None, True, [1.0])
] + [
    Abuse("one placement", lambda _: solve(problem(), Step(placements=(REST,))), ("one for each of the 2 bodies, found 1",)),
    Abuse("three placements", lambda _: solve(problem(), Step(placements=(REST,) * 3)), ("found 3",)),
    Abuse("no placements", lambda _: solve(problem(), Step(placements=())), ("found 0",)),
    Abuse("placements in 3D", lambda _: solve(problem(), Step(placements=(Placement.at_rest(3),) * 2)), ("the bodies are 2D",)),
    Abuse("placement without a tuple", lambda _: Step(placements=REST), ("a tuple of Placement",)),
    Abuse("arrays for placements", lambda _: Step(placements=(np.eye(2), np.eye(2))), ("a tuple of Placement",)),
    Abuse("freedom without a body", lambda _: Step(freedoms=(Freedom("x", 1.0),)), ("found a Freedom", "write")),
    Abuse("freedom of body 0.0", lambda _: Step(freedoms=((0.0, Freedom("x", 1.0)),)), ("pairs of a body's index",)),
    Abuse("freedom by name", lambda _: Step(freedoms=((0, "x"),)), ("pairs of a body's index",)),
    Abuse("freedom twice in a step", lambda _: Step(freedoms=((0, Freedom("x", 1.0)),) * 2), ("once",)),
    Abuse("freedom of no body", lambda _: solve(problem(), Step(freedoms=((7, Freedom("y", 1.0)),))), ("below 2, found 7",)),
    Abuse("freedom of body -1", lambda _: solve(problem(), Step(freedoms=((-1, Freedom("y", 1.0)),))), ("below 2, found -1",)),
    Abuse("freedom of a body without coupling", lambda _: solve(problem(), Step(freedoms=((0, Freedom("y", 1.0)),))), ("declare it",)),
    Abuse("factor for a step", lambda _: solve(problem(), 0.5), ("step: wanted a Step, found 0.5",)),
    Abuse("bodies for a problem", lambda _: solve((upper(), lower())), ("wanted a Problem",)),
    Abuse("step for a list of steps", lambda _: sweep(problem(), Step()), ("a list of steps", "write sweep")),
    Abuse("None for steps", lambda _: sweep(problem(), None), ("a list of steps, found None",)),
    Abuse("factors for steps", lambda _: list(sweep(problem(), [0.5, 1.0])), ("step: wanted a Step, found 0.5",)),
    Abuse("text for steps", lambda _: sweep(problem(), "all"), ("a list of steps, found 'all'",)),
]  # fmt: skip

RESULTS = [
    Abuse("displacement of no body", lambda _: solve(problem()).displacement(2), ("a body index below 2, found 2",)),
    Abuse("displacement by name", lambda _: solve(problem()).displacement("upper"), ("found 'upper'",)),
    Abuse("reactions of no body", lambda _: reactions(solve(problem()), -1), ("a body index below 2, found -1",)),
    Abuse("moments about nothing", lambda _: reactions(solve(problem()), 0, about=(NAN, 0.0)), ("about: wanted a point",)),
    Abuse("stress of another mesh", lambda _: cell_stress(UPPER, steel(), np.zeros((4, 2))), ("\\(6, 2\\)", "displacement")),
    Abuse("stress of text", lambda _: cell_stress(UPPER, steel(), "u"), ("\\(6, 2\\)",)),
    Abuse("ParaView of a problem", lambda f: write_paraview(problem(), f), ("a Solution",)),
    Abuse("ParaView of numbers", lambda f: write_paraview([1.0], f), ("Solutions only, found 1.0",)),
    Abuse("ParaView into nothing", lambda _: write_paraview(solve(problem()), ""), ("a folder to write into",)),
    Abuse("ParaView into a file", lambda f: (f / "x").write_text("x") and write_paraview(solve(problem()), f / "x"), ("a folder to write into", "take another")),
]  # fmt: skip

PHYSICS = [
    Abuse("too far apart", lambda _: solve(apart(5.0)), ("within 0.1 mm", "found none", "reach"), SearchError),
    Abuse("surfaces that look away", lambda _: solve(problem(contacts=(contact((0, "top")),))), ("within 0.1 mm", "reach"), SearchError),
    Abuse("a held surface that is to carry the pressure", lambda _: solve(hard(contact())), ("'bottom' of body 0: wanted a first surface that deforms", "name the other")),
]  # fmt: skip

ABUSES = [*MESHES, *FILES, *MATERIALS, *SUPPORTS, *LOADS, *COUPLINGS, *CONTACTS, *PLACEMENTS, *STEPS, *RESULTS, *PHYSICS]


MODULUS = 210e3 / (1.0 - 0.3**2)  # of uniaxial stress in plane strain
PUSH = 0.004
ROLLS = Fixed("left", "x")


def pushed(**changes: Any) -> Problem:
    """The same blocks, their top moved down by `PUSH`: uniform stress MODULUS·PUSH/2 over their height of 2 mm."""
    return problem((upper(supports=(ROLLS, Fixed("top", "y", -PUSH)), loads=()), lower()), **changes)


def scaled(length: float, stress: float) -> Problem:
    """The same problem in other units."""
    material = Material(210e3 * stress, 0.3)
    press = (Traction("top", (0.0, -PRESSURE * stress)),)
    bodies = (
        upper(replace(UPPER, points=UPPER.points * length), material=material, loads=press),
        lower(replace(LOWER, points=LOWER.points * length), material=material),
    )
    return problem(bodies, (contact(reach=0.1 * length),))


def in_one_body() -> Problem:
    """Both blocks as two pieces of one body, which touches itself."""
    n = len(UPPER.points)
    both = MeshData(
        np.concatenate([UPPER.points, LOWER.points]), "quadrilateral", 1, np.concatenate([UPPER.cells, LOWER.cells + n]),
        {**{f"upper {k}": v for k, v in UPPER.facets.items()}, **{f"lower {k}": v + n for k, v in LOWER.facets.items()}},
        {},
    )  # fmt: skip
    supports = (
        Fixed("upper left", "x"), Fixed("upper top", "y", -PUSH), Fixed("lower left", "x"), Fixed("lower bottom", "y"),
    )  # fmt: skip
    return problem((Body(both, supports=supports),), (contact((0, "upper bottom"), (0, "lower top")),))


def hard(between: Contact) -> Problem:
    """The upper block held at each of its nodes, the lower one pushed against it from below."""
    supports = (ROLLS, Fixed("bottom", "y", PUSH))
    return problem((upper(supports=(Fixed("top"), Fixed("bottom")), loads=()), lower(supports=supports)), (between,))


def ridden(load: float = 0.0, **changes: Any) -> Problem:
    """The upper block's top coupled and loaded, on top of the traction there."""
    rigid = Rigid("top", (Freedom("y", load=load), Freedom("rz", load=0.0)))
    return problem((upper(supports=(), rigid=rigid, **changes), lower(supports=(Fixed("bottom"),))))


def remade(**changes: Any) -> Problem:
    return problem((upper(replace(UPPER, **changes)), lower()))


def frozen(values: Any) -> Any:
    result = values.copy()
    result.setflags(write=False)
    return result


def after_failure(_: Path) -> Any:
    """A sweep whose second step is refused and whose third is right."""
    run = Sweep(problem())
    run.solve(Step(0.5))
    try:
        run.solve(Step(placements=(REST,)))
    except InputError:
        return run.solve(Step(1.0)).contacts[0].pressure
    raise AssertionError("the step with one placement was taken")


def clockwise_file(folder: Path) -> Any:
    """Least Jacobian of a square whose surface points down, read from gmsh."""
    write_msh(replace(UPPER, cells=UPPER.cells[:, ::-1].copy()), folder / "down.msh")
    back = read_msh(str(folder / "down.msh"))
    return pressures(problem((upper(back), lower())))


TURN = np.array([[0.8, -0.6], [0.6, 0.8]])
AWAY = Placement(TURN.tolist(), [1e5, -1e5])
FINE = [
    Fine("lists for tuples", lambda _: pressures(Problem([upper(), lower()], [contact([0, "bottom"], [1, "top"])])), PRESSURE),
    Fine("numpy's numbers", lambda _: pressures(problem(contacts=(contact((np.int64(0), "bottom"), friction=np.float64(0.1)),)), Step(np.float32(0.5))), PRESSURE / 2),
    Fine("single precision points", lambda _: pressures(remade(points=UPPER.points.astype(np.float32))), PRESSURE),
    Fine("32-bit cells", lambda _: pressures(remade(cells=UPPER.cells.astype(np.int32))), PRESSURE),
    Fine("unsigned cells", lambda _: pressures(remade(cells=UPPER.cells.astype(np.uint64))), PRESSURE),
    Fine("columns first", lambda _: pressures(remade(points=np.asfortranarray(UPPER.points))), PRESSURE),
    Fine("arrays that cannot be written", lambda _: pressures(remade(points=frozen(UPPER.points), cells=frozen(UPPER.cells))), PRESSURE),
    Fine("plane at another height", lambda _: pressures(remade(points=UPPER.points + [0.0, 0.0, 7.0])), PRESSURE),
    Fine("swapped surfaces", lambda _: pressures(problem(contacts=(contact((1, "top"), (0, "bottom")),))), PRESSURE),
    Fine("swapped bodies", lambda _: pressures(problem((lower(), upper()), (contact((1, "bottom"), (0, "top")),))), PRESSURE),
    Fine("force on the second body", lambda _: force(problem()), [0.0, -2.0 * PRESSURE]),
    Fine("force on the second body, swapped", lambda _: force(problem(contacts=(contact((1, "top"), (0, "bottom")),))), [0.0, 2.0 * PRESSURE]),
    Fine("no load", lambda _: pressures(problem(), Step(0.0)), 0.0),
    Fine("a thousandth of a millionth of the load", lambda _: pressures(problem(), Step(1e-9)), PRESSURE * 1e-9),
    Fine("metres and pascals", lambda _: pressures(scaled(1e-3, 1e6)), PRESSURE * 1e6),
    Fine("nanometres", lambda _: pressures(scaled(1e-6, 1.0)), PRESSURE),
    Fine("kilometres", lambda _: pressures(scaled(1e6, 1.0)), PRESSURE),
    Fine("a thousand times softer", lambda _: pressures(problem((upper(material=steel(youngs_modulus=210.0e3)), lower(material=steel(youngs_modulus=210e6))))), PRESSURE),
    Fine("a thousand times stiffer", lambda _: pressures(problem((upper(material=steel(youngs_modulus=210e6)), lower()))), PRESSURE),
    Fine("nearly incompressible", lambda _: pressures(problem((upper(material=steel(poissons_ratio=0.4999)), lower()))), PRESSURE, 1e-6),
    Fine("auxetic", lambda _: pressures(problem((upper(material=steel(poissons_ratio=-0.9)), lower()))), PRESSURE),
    Fine("skew variant", lambda _: pressures(problem(nitsche=Nitsche(theta=-1.0))), PRESSURE),
    Fine("incomplete variant", lambda _: pressures(problem(nitsche=Nitsche(theta=0.0))), PRESSURE),
    Fine("a γ fifty times its limit", lambda _: pressures(problem(nitsche=Nitsche(safety=50.0))), PRESSURE),
    Fine("friction that holds everything", lambda _: pressures(problem(contacts=(contact(friction=1e6),))), PRESSURE),
    Fine("far from the origin, turned", lambda _: pressures(problem(), Step(placements=(AWAY, AWAY))), PRESSURE, 1e-6),
    Fine("the same mesh twice", lambda _: pressures(problem((upper(LOWER), lower())), Step(placements=(Placement(np.eye(2), (0.0, 1.0)), REST))), PRESSURE),
    Fine("no steps", lambda _: len(list(sweep(problem(), []))), 0),
    Fine("steps from a generator", lambda _: [s.contacts[0].force[1] for s in sweep(problem(), (Step(x) for x in (0.5, 1.0)))], [-PRESSURE, -2 * PRESSURE]),
    Fine("two loads on one face", lambda _: pressures(problem((upper(loads=(Traction("top", (0.0, -40.0)), Traction("top", (0.0, -60.0)))), lower()))), PRESSURE),
    Fine("a face moved", lambda _: pressures(pushed()), MODULUS * PUSH / 2.0),
    Fine("a face moved half of the way", lambda _: pressures(pushed(), Step(0.5)), MODULUS * PUSH / 4.0),
    Fine("a face moved away", lambda _: pressures(pushed(), Step(-1.0)), 0.0),
    Fine("a body against itself", lambda _: pressures(in_one_body()), MODULUS * PUSH / 2.0),
    Fine("a body held everywhere", lambda _: pressures(hard(contact((1, "top"), (0, "bottom")))), MODULUS * PUSH),
    Fine("traction on a rigid face", lambda _: force(ridden())[1], -2.0 * PRESSURE),
    Fine("traction on a rigid face, with a load", lambda _: force(ridden(-50.0))[1], -2.0 * PRESSURE - 50.0),
    Fine("a step's own load beside the factor", lambda _: force(ridden(-50.0), Step(0.5, freedoms=((0, Freedom("y", -80.0)),)))[1], -PRESSURE - 80.0),
    Fine("on after a refused step", after_failure, PRESSURE),
    Fine("a surface that points down", clockwise_file, PRESSURE),
]
