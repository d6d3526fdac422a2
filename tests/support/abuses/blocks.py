"""The blocks that abuses of the public API are made with, `UPPER` stands on `LOWER`, and what a row of a table says."""

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


def hard(between: Contact) -> Problem:
    """The upper block held at each of its nodes, the lower one pushed against it from below."""
    supports = (ROLLS, Fixed("bottom", "y", PUSH))
    return problem((upper(supports=(Fixed("top"), Fixed("bottom")), loads=()), lower(supports=supports)), (between,))
