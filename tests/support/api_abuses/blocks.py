"""Two blocks, `UPPER` on `LOWER`, with which calls of the public API are made, and the rows of the tables of calls."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import gmsh
import numpy as np

from evolvent import (
    Body,
    Contact,
    EvolventError,
    Fixed,
    InputError,
    Material,
    MeshData,
    Placement,
    Problem,
    Step,
    Traction,
    read_msh,
    solve,
)
from evolvent_meshes.mesh.gmsh_io import gmsh_model, write_msh
from evolvent_meshes.shapes.blocks import box, rectangle

NAN, INF = float("nan"), float("inf")
PRESSURE = 100.0
PUSH = 0.004
ROLLS = Fixed("left", "x")
REST = Placement.at_rest(2)

UPPER = rectangle(2.0, 1.0, 2, 1, 1, origin=(0.0, 1.0))
LOWER = rectangle(2.0, 1.0, 3, 1, 1)
CUBE = box((1.0, 1.0, 1.0), (1, 1, 1), 1)
CURVED = rectangle(2.0, 1.0, 2, 2, 2)
TALL = rectangle(2.0, 2.0, 2, 2, 1)
TET = box((1.0, 1.0, 1.0), (1, 1, 1), 1, "tetrahedron")


@dataclass(frozen=True)
class Refused:
    """A call that has to be refused.

    name: what is wrong with it.
    call: makes it, given an empty folder.
    words: regular expressions that the message has to match.
    error: the class that it has to raise.
    """

    name: str
    call: Callable[[Path], Any]
    words: tuple[str, ...]
    error: type[EvolventError] = InputError


@dataclass(frozen=True)
class Exact:
    """A call that is unusual but correct.

    name: what is unusual about it.
    call: makes it, given an empty folder, and returns a number or an array.
    wanted: its exact value.
    accuracy: relative to the largest of `wanted`.
    """

    name: str
    call: Callable[[Path], Any]
    wanted: Any
    accuracy: float = 1e-8


def steel(**changes: Any) -> Material:
    """Steel, with other constants where given."""
    return Material(**{"youngs_modulus": 210e3, "poissons_ratio": 0.3, **changes})


def upper(mesh: Any = UPPER, **changes: Any) -> Body:
    """The upper block, pressed from above, on rollers at its left side."""
    usual = {"supports": (Fixed("left", "x"),), "loads": (Traction("top", (0.0, -PRESSURE)),), "name": "upper"}
    return Body(mesh, **{**usual, **changes})


def lower(mesh: Any = LOWER, **changes: Any) -> Body:
    """The lower block, on rollers at its bottom and its left side."""
    return Body(mesh, **{"supports": (Fixed("left", "x"), Fixed("bottom", "y")), "name": "lower", **changes})


def problem(bodies: Any = None, contacts: Any = None, **changes: Any) -> Problem:
    """The upper block on the lower one, with other bodies or contacts where given."""
    bodies = (upper(), lower()) if bodies is None else bodies
    return Problem(bodies, (contact(),) if contacts is None else contacts, **changes)


def contact(first: Any = (0, "bottom"), second: Any = (1, "top"), **changes: Any) -> Contact:
    """The contact between the blocks."""
    return Contact(first, second, **{"reach": 0.1, **changes})


def pressures(given: Problem, step: Step | None = None) -> Any:
    """Pressures (q,) at the points of the only contact [MPa]."""
    return solve(given, step).contacts[0].pressure


def force(given: Problem, step: Step | None = None) -> Any:
    """Force (d,) of the only contact [N/mm; N in 3D]."""
    return solve(given, step).contacts[0].force


def mesh(base: MeshData = UPPER, **changes: Any) -> Callable[[Path], Body]:
    """Makes a body on a mesh with some fields replaced."""
    return lambda _: Body(replace(base, **changes), name="upper")


def moved(base: MeshData, node: int, position: tuple[float, ...]) -> MeshData:
    """The mesh with one node at another position."""
    points = base.points.copy()
    points[node, : len(position)] = position
    return replace(base, points=points)


def numbered(base: MeshData, row: int, *nodes: int) -> MeshData:
    """The mesh with other nodes in one cell."""
    cells = base.cells.copy()
    cells[row] = nodes
    return replace(base, cells=cells)


def group(base: MeshData, name: str, facets: Any) -> MeshData:
    """The mesh with one more facet group."""
    return replace(base, facets={**base.facets, name: np.asarray(facets, dtype=np.int64)})


def file(content: bytes, name: str = "mesh.msh") -> Callable[[Path], MeshData]:
    """Reads a file of this content."""

    def read(folder: Path) -> MeshData:
        (folder / name).write_bytes(content)
        return read_msh(folder / name)

    return read


def cut_file(share: float) -> Callable[[Path], MeshData]:
    """Reads a mesh file of which only the first part has been written."""

    def read(folder: Path) -> MeshData:
        write_msh(UPPER, folder / "whole.msh")
        whole = (folder / "whole.msh").read_bytes()
        return file(whole[: int(share * len(whole))])(folder)

    return read


def gmsh_file(order: int = 1, names: tuple[str, str] = ("body", "top"), **options: float) -> Callable[[Path], MeshData]:
    """Reads two squares meshed by gmsh with some options; recombine: how many of them in quadrilaterals."""

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
    """The blocks with a gap [mm] between them."""
    return problem((upper(moved_all(UPPER, distance)), lower()))


def moved_all(base: MeshData, up: float) -> MeshData:
    """The mesh, higher by `up` [mm]."""
    return replace(base, points=base.points + np.array([0.0, up, 0.0]))


def doubled(base: MeshData) -> MeshData:
    """The same cells twice, side by side and not connected."""
    n = len(base.points)
    facets = {name: np.concatenate([rows, rows + n]) for name, rows in base.facets.items()}
    points = np.concatenate([base.points, base.points + np.array([3.0, 0.0, 0.0])])
    return replace(base, points=points, cells=np.concatenate([base.cells, base.cells + n]), facets=facets, volumes={})


def hard(between: Contact) -> Problem:
    """The upper block held at all of its nodes, the lower one pushed against it from below."""
    supports = (ROLLS, Fixed("bottom", "y", PUSH))
    return problem((upper(supports=(Fixed("top"), Fixed("bottom")), loads=()), lower(supports=supports)), (between,))
