"""Conversion of gmsh files and models to MeshData and back; no other file uses gmsh."""

from __future__ import annotations

import errno
import os
import re
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import gmsh
import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.files import atomic_file, plain_name
from evolvent_meshes.input_checks import shown
from evolvent_meshes.mesh.distinct_elements import distinct, each_once, unique_cells
from evolvent_meshes.mesh.mesh_data import CELL_DIMENSION, FACET_SHAPE, REVERSED_CELL, MeshData, MeshError

ELEMENT_TYPES: dict[int, tuple[str, int]] = {
    1: ("interval", 1), 2: ("triangle", 1), 3: ("quadrilateral", 1), 4: ("tetrahedron", 1), 5: ("hexahedron", 1),
    8: ("interval", 2), 9: ("triangle", 2), 10: ("quadrilateral", 2), 11: ("tetrahedron", 2), 12: ("hexahedron", 2),
}
"""Element type of gmsh -> (shape, order)."""
_TYPE_NUMBERS = {shape: number for number, shape in ELEMENT_TYPES.items()}
_SERENDIPITY = (16, 17)
MSH_HEADERS = (b"$MeshFormat", b"$Comments")


class NoMeshFile(MeshError, FileNotFoundError):
    """There is no mesh file at the given path."""


@contextmanager
def gmsh_model(name: str) -> Iterator[None]:
    """Context with a new gmsh model without messages, removed at its end; also inside a gmsh session of the caller."""
    owns_session = not gmsh.isInitialized()
    if owns_session:
        closed_pipe = signal.getsignal(signal.SIGPIPE)
        gmsh.initialize(["gmsh"], readConfigFiles=False, interruptible=False)
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGPIPE, closed_pipe)  # gmsh has a closed pipe end the process, without a word
    terminal = gmsh.option.getNumber("General.Terminal")
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add(name)
    try:
        yield
    finally:
        if owns_session:
            gmsh.finalize()
        else:
            gmsh.model.remove()
            gmsh.option.setNumber("General.Terminal", terminal)


def read_msh(path: Path | str) -> MeshData:
    """Read a gmsh file (MSH 4.1 or 2.2): one cell shape of order 1 or 2, in named physical volumes, in 2D surfaces.

    Lengths are in mm. Named physical groups of facets become the mesh's facet groups. Elements of no physical group and
    nodes of no cell are left out; plane surfaces that are numbered clockwise are turned over. Elements with the same
    nodes are one: MSH 2.2 writes an element once for each of its groups.

    Raises MeshError for an unusable mesh, NoMeshFile where there is no file.

    >>> from tempfile import TemporaryDirectory
    >>> from evolvent_meshes.shapes.blocks import rectangle
    >>> with TemporaryDirectory() as folder:
    ...     write_msh(rectangle(40.0, 20.0, nx=4, ny=2), f"{folder}/block.msh")
    ...     mesh = read_msh(f"{folder}/block.msh")
    >>> len(mesh.cells), sorted(mesh.facets), list(mesh.volumes)
    (8, ['bottom', 'left', 'right', 'top'], ['body'])
    """
    if not isinstance(path, str | os.PathLike):
        raise MeshError(f"mesh file: wanted the path of a gmsh file, found {shown(path)}; write read_msh('block.msh')")
    _refuse_scripts(Path(path))
    with gmsh_model("read"), plain_name(Path(path), ".msh") as alias:  # away from a .opt file, which gmsh would execute
        try:
            gmsh.merge(str(alias))
        except Exception as error:
            raise MeshError(
                f"mesh file {path}: wanted a complete mesh in gmsh's format, found one that gmsh cannot read; "
                "write it by gmsh.write, or export it as MSH 4.1 or 2.2"
            ) from error
        try:
            return from_gmsh()
        except MeshError as error:
            raise MeshError(f"mesh file {path}: {error}") from error


def _refuse_scripts(path: Path) -> None:
    """Raises MeshError for a file that is no mesh: gmsh would execute it as a .geo script, with its shell commands."""
    try:
        if not path.is_file():
            found = "a folder" if path.is_dir() else "what is no file" if path.exists() else "nothing"
            raise NoMeshFile(f"mesh file: wanted a gmsh file, found {found} at {path}; check the path")
        with open(path, "rb") as file:
            head = file.read(64).lstrip()
    except NoMeshFile:
        raise
    except OSError as error:
        found = f"{path}: {error.strerror}"
        raise NoMeshFile(f"mesh file: wanted a file that can be read, found {found}; check its rights") from error
    if not head.startswith(MSH_HEADERS):
        found = "an empty file" if not head else f"one that begins with {head[:16]!r}"
        raise MeshError(
            f'mesh file {path}: wanted a mesh in gmsh\'s MSH format, which begins with "$MeshFormat", found {found}; '
            "open it in gmsh, mesh it and save it as .msh"
        )


def from_gmsh() -> MeshData:
    """The mesh of the current gmsh model, by its physical groups; see `read_msh`. Raises MeshError."""
    dimension = max((d for d, _ in gmsh.model.getPhysicalGroups()), default=0)
    if dimension < 2:
        raise MeshError(
            "gmsh model: wanted a named physical volume (a physical surface in 2D), found no such group; add one with "
            "gmsh.model.addPhysicalGroup and a name, or 'Physical Volume(\"name\") = {...};' in the .geo file"
        )
    volumes = _groups(dimension, plane=dimension == 2)
    shape, order = _single_type(volumes, dimension)
    facet_groups = {k: v for k, v in _groups(dimension - 1).items() if any(len(t) for t, _ in v.values())}
    _check_facets(facet_groups, (FACET_SHAPE[shape], order))
    cell_nodes, indices = unique_cells({k: v[_TYPE_NUMBERS[shape, order]] for k, v in volumes.items()})
    if not len(cell_nodes):
        raise MeshError("gmsh model: wanted cells in the physical groups, found none; generate the mesh first")
    used, cells = np.unique(cell_nodes, return_inverse=True)
    facet_type = _TYPE_NUMBERS[FACET_SHAPE[shape], order]
    facets = {
        name: _renumbered(used, each_once(group[facet_type][1]), name) for name, group in facet_groups.items()
    }
    points = _points(used)
    if dimension == 2 and np.ptp(points[:, 2]) > 1e-9 * np.ptp(points[:, :2]):
        raise MeshError(
            f"gmsh model: wanted a 2D mesh in the plane z = 0 or a physical volume, found surfaces with z from "
            f"{points[:, 2].min():g} to {points[:, 2].max():g}; name the volume, or flatten the mesh"
        )
    return MeshData(points, shape, order, cells.reshape(cell_nodes.shape).astype(np.int64), facets, indices)


ElementGroup = dict[int, tuple[Ints, Ints]]
"""Element type of gmsh -> element tags (n,), node tags (n, nodes)."""


def _groups(dimension: int, plane: bool = False) -> dict[str, ElementGroup]:
    """Physical groups of a dimension, by name. plane: number the cells of surfaces counter-clockwise."""
    groups: dict[str, ElementGroup] = {}
    for _, number in gmsh.model.getPhysicalGroups(dimension):
        name = gmsh.model.getPhysicalName(dimension, number)
        if not name:
            raise MeshError(
                f"gmsh model: wanted a name for every group, found none for physical {dimension}D {number}; give "
                "gmsh.model.addPhysicalGroup a name"
            )
        entities = gmsh.model.getEntitiesForPhysicalGroup(dimension, number)
        groups[name] = _elements(dimension, [int(e) for e in entities], plane)
    return groups


def _elements(dimension: int, entities: list[int], plane: bool) -> ElementGroup:
    tags: dict[int, list[Ints]] = {}
    nodes: dict[int, list[Ints]] = {}
    for entity in entities:
        for kind, element_tags, node_tags in zip(*gmsh.model.mesh.getElements(dimension, entity), strict=True):
            cells = node_tags.astype(np.int64).reshape(len(element_tags), -1)
            tags.setdefault(int(kind), []).append(element_tags.astype(np.int64))
            nodes.setdefault(int(kind), []).append(_counter_clockwise(int(kind), cells) if plane else cells)
    return {kind: (np.concatenate(tags[kind]), np.concatenate(nodes[kind])) for kind in tags}


def _counter_clockwise(kind: int, cells: Ints) -> Ints:
    """The cells of one surface, reversed where their signed area is negative, so that their normal is −z."""
    permutation = REVERSED_CELL.get(ELEMENT_TYPES.get(kind, ("", 0)))
    if permutation is None or not len(cells):
        return cells
    tags, local = np.unique(cells[:, : 3 if len(permutation) in (3, 6) else 4], return_inverse=True)
    x, y = np.moveaxis(_points(tags)[local.reshape(len(cells), -1), :2], -1, 0)
    area = np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1))
    return cells[:, permutation] if area < 0.0 else cells


def _single_type(volumes: dict[str, ElementGroup], dimension: int) -> tuple[str, int]:
    kinds = {kind for group in volumes.values() for kind in group}
    names = [gmsh.model.mesh.getElementProperties(kind)[0] for kind in sorted(kinds)]
    if kinds & set(_SERENDIPITY):
        raise MeshError(
            f"gmsh model: wanted complete second-order cells, found {', '.join(names)}; set "
            "Mesh.SecondOrderIncomplete = 0"
        )
    if len(kinds) != 1 or not kinds <= set(ELEMENT_TYPES):
        raise MeshError(
            f"gmsh model: wanted one cell shape of order 1 or 2 in the physical {dimension}D groups (triangles, "
            f"quadrilaterals, tetrahedra or hexahedra), found {', '.join(names) or 'none'}; set Mesh.ElementOrder, and "
            "recombine everywhere or nowhere"
        )
    return ELEMENT_TYPES[kinds.pop()]


def _check_facets(groups: dict[str, ElementGroup], wanted: tuple[str, int]) -> None:
    for name, group in groups.items():
        if set(group) != {_TYPE_NUMBERS[wanted]}:
            found = ", ".join(gmsh.model.mesh.getElementProperties(kind)[0] for kind in sorted(group))
            raise MeshError(
                f"facet group {name!r}: wanted only facets of shape {wanted[0]}, order {wanted[1]}, found {found}; "
                "mesh the boundary together with the volume"
            )


def _renumbered(used: Ints, nodes: Ints, name: str) -> Ints:
    index = np.minimum(np.searchsorted(used, nodes), len(used) - 1)
    if not np.array_equal(used[index], nodes):
        raise MeshError(
            f"facet group {name!r}: wanted facets of the cells in the physical groups, found nodes that belong to no "
            "such cell; put the body behind these facets into a named physical group"
        )
    return index.astype(np.int64)


def _points(used: Ints) -> Floats:
    """Coordinates (n, 3) of node tags, without control points of curves that are nodes of no cell."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tags)
    return np.asarray(coordinates.reshape(-1, 3)[order[np.searchsorted(tags[order], used)]])


def write_msh(mesh: MeshData, path: Path | str) -> None:
    """Write a gmsh file (format by the suffix, .msh: MSH 4.1); the groups of the mesh become named physical groups.

    Raises MeshError for cells of no volume group, which gmsh would leave out; WriteError.
    """
    path = Path(path)
    size = 8 * mesh.points.size + 8 * mesh.cells.size
    with gmsh_model("write"), atomic_file(path, size) as part, plain_name(part, path.suffix) as alias:
        to_gmsh(mesh)
        binary = gmsh.option.getNumber("Mesh.Binary")
        gmsh.option.setNumber("Mesh.Binary", 1)  # a text file would round the coordinates
        try:
            gmsh.write(str(alias))
        except Exception as error:  # gmsh raises nothing narrower
            raise OSError(str(error)) from error
        finally:
            gmsh.option.setNumber("Mesh.Binary", binary)
        _require_end(part)


def _require_end(path: Path) -> None:
    """Raises OSError for a file without its last section: on a full disk gmsh writes part of it, without an error."""
    with open(path, "rb") as stream:
        stream.seek(max(0, path.stat().st_size - 64))
        if not re.search(rb"\$End\w+\s*$", stream.read()):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def to_gmsh(mesh: MeshData) -> None:
    """Add the mesh to the current gmsh model: discrete entities in named physical groups. Raises MeshError."""
    in_group = np.zeros(len(mesh.cells), dtype=bool)
    for index in mesh.volumes.values():
        in_group[index] = True
    if not in_group.all():
        raise MeshError(
            f"write mesh: wanted every cell in a named volume, found {np.count_nonzero(~in_group)} of {len(in_group)} "
            "cells in none; add them to a volume group"
        )
    dimension = CELL_DIMENSION[mesh.shape]
    _add_elements(dimension, mesh.shape, mesh.order, mesh.cells, mesh.volumes, mesh.points)
    facets, groups = _distinct_facets(mesh)
    _add_elements(dimension - 1, FACET_SHAPE[mesh.shape], mesh.order, facets, groups, None)


def _distinct_facets(mesh: MeshData) -> tuple[Ints, dict[str, Ints]]:
    """All facets of the groups, each once, and the indices of each group's facets."""
    if not mesh.facets:
        return np.empty((0, 1), dtype=np.int64), {}
    every = np.concatenate(list(mesh.facets.values()))
    kept, number = distinct(every)
    ends = np.cumsum([len(f) for f in mesh.facets.values()])[:-1]
    return every[kept], dict(zip(mesh.facets, np.split(number, ends), strict=True))


def _add_elements(
    dimension: int, shape: str, order: int, nodes: Ints, groups: dict[str, Ints], points: Floats | None
) -> None:
    """Add one discrete entity for each combination of groups, and one physical group for each name."""
    member = np.zeros((len(nodes), len(groups)), dtype=bool)
    for column, index in enumerate(groups.values()):
        member[index, column] = True
    combinations, which = np.unique(member, axis=0, return_inverse=True)
    entities = [gmsh.model.addDiscreteEntity(dimension) for _ in combinations]
    if points is not None:
        tags = np.arange(1, len(points) + 1)
        gmsh.model.mesh.addNodes(dimension, entities[0], tags, points.ravel())
    for number, entity in enumerate(entities):
        chosen = nodes[which.ravel() == number] + 1
        gmsh.model.mesh.addElementsByType(entity, _TYPE_NUMBERS[shape, order], [], chosen.ravel())
    for column, name in enumerate(groups):
        tagged = [e for e, combination in zip(entities, combinations, strict=True) if combination[column]]
        gmsh.model.addPhysicalGroup(dimension, tagged, name=name)
