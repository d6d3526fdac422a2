"""A contact problem and its solution as files that every program reads and writes with NumPy alone.

Two bodies: the first one is driven, the second one is held. Node and cell numbers are those of `MeshData` (gmsh's).
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.mesh_data import MeshData


@dataclass(frozen=True)
class Push:
    """The driven group is moved along the last axis by this much [mm] and held otherwise."""

    displacement: float


@dataclass(frozen=True)
class Turn:
    """The driven group turns rigidly about the z axis by this small angle [rad].

    A given torque would be what an engineer has. It couples all nodes of the group to one unknown: that costs CalculiX
    four times the time and six times the memory, so the others get the easier question.
    """

    rotation: float


@dataclass(frozen=True)
class Task:
    """The problem that every program solves.

    bodies:    meshes as they stand in space [mm].
    materials: Young's modulus [MPa] and Poisson's ratio of each.
    driven:    facet group of body 0 that is moved.
    drive:     how it is moved.
    held:      supports at rest: body, facet group, directions of "xyz".
    contact:   facet groups that may touch, of body 0 and of body 1.
    friction:  coefficient of Coulomb's law.
    """

    bodies: tuple[MeshData, MeshData]
    materials: tuple[tuple[float, float], tuple[float, float]]
    driven: str
    drive: Push | Turn
    held: tuple[tuple[int, str, str], ...]
    contact: tuple[str, str]
    friction: float = 0.0

    @property
    def dimension(self) -> int:
        return self.bodies[0].dimension

    @property
    def dofs(self) -> int:
        """Displacement unknowns of both meshes, supported ones included."""
        return sum(len(mesh.points) for mesh in self.bodies) * self.dimension

    def write(self, path: Path) -> None:
        """As one .npz."""
        arrays: dict[str, NDArray[Any]] = {}
        for index, mesh in enumerate(self.bodies):
            arrays |= {f"{index}/points": mesh.points, f"{index}/cells": mesh.cells}
            arrays |= {f"{index}/facets/{name}": nodes for name, nodes in mesh.facets.items()}
        rest = {
            "shape": self.bodies[0].shape, "order": self.bodies[0].order, "materials": self.materials,
            "driven": self.driven, "drive": asdict(self.drive), "held": self.held, "contact": self.contact,
            "friction": self.friction,
        }
        np.savez(path, statement=json.dumps(rest), **arrays)  # type: ignore[arg-type]  # numpy's hints of **kwargs

    @staticmethod
    def read(path: Path) -> Task:
        with np.load(path) as file:
            rest = json.loads(str(file["statement"]))
            bodies = [_mesh(file, index, rest["shape"], rest["order"]) for index in (0, 1)]
        drive = rest["drive"]
        first, second = rest["materials"]
        return Task(
            (bodies[0], bodies[1]),
            ((first[0], first[1]), (second[0], second[1])),
            rest["driven"],
            Push(**drive) if "displacement" in drive else Turn(**drive),
            tuple((body, group, directions) for body, group, directions in rest["held"]),
            (rest["contact"][0], rest["contact"][1]),
            rest["friction"],
        )


def _mesh(file: np.lib.npyio.NpzFile, index: int, shape: str, order: int) -> MeshData:
    start = f"{index}/facets/"
    facets = {name[len(start) :]: file[name] for name in file.files if name.startswith(start)}
    cells = file[f"{index}/cells"]
    return MeshData(file[f"{index}/points"], shape, order, cells, facets, {"body": np.arange(len(cells))})


@dataclass(frozen=True)
class Answer:
    """The solution of a program: its pressure at nodes, a Lagrange field of the mesh's order, or at points.

    body:       whose contact surface carries the pressure.
    pressure:   (n,) [MPa].
    nodes:      (n,), or None where the pressure is known at points.
    points:     (n, 3) [mm], or None.
    weights:    (n,), of these points [mm or mm²], or None.
    torque:     that turns the driven body about z [N·mm].
    iterations: of Newton's method.
    dofs:       unknowns.
    seconds:    CPU time of the parts of the run, by their names.
    """

    body: int
    pressure: Floats
    nodes: Ints | None = None
    points: Floats | None = None
    weights: Floats | None = None
    torque: float = nan
    iterations: int = 0
    dofs: int = 0
    seconds: dict[str, float] = field(default_factory=dict)

    def write(self, path: Path) -> None:
        arrays = {name: getattr(self, name) for name in ("pressure", "nodes", "points", "weights")}
        numbers = {name: getattr(self, name) for name in _NUMBERS}
        given = {name: array for name, array in arrays.items() if array is not None}
        np.savez(path, numbers=json.dumps(numbers), **given)

    @staticmethod
    def read(path: Path) -> Answer:
        with np.load(path) as file:
            arrays = {name: file[name] for name in file.files if name != "numbers"}
            return Answer(**json.loads(str(file["numbers"])), **arrays)


_NUMBERS = ("body", "torque", "iterations", "dofs", "seconds")
