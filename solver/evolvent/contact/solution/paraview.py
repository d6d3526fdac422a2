"""ParaView output of contact problems: bodies with displacements and stresses, contact surfaces with pressures.

    FOLDER/series.pvd           the file to open in ParaView, or with pyvista.get_reader; time is the number of the step
    FOLDER/body_0_0001.vtu      a body's cells as the step places them: displacement_mm at the nodes; stress_MPa
                                (xx, yy, zz, xy, yz, xz) and von_mises_MPa at the centres of the cells
    FOLDER/contact_0_0001.vtu   the surface of a contact that carries the pressure: displacement_mm, pressure_MPa,
                                traction_MPa of the first body on the second and slip_mm since the step before, at the
                                nodes

Vectors and stresses are in the common frame. Warp By Vector by displacement_mm shows the deformed bodies. Values at
the quadrature points of a contact are averaged about the nodes, which keeps the force; the peaks are in
`ContactResult.pressure`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from evolvent.contact.problem.definition import Placement
from evolvent.contact.step.contact_result import ContactResult
from evolvent.contact.step.step_solution import Solution
from evolvent.fem.lagrange import gmsh_permutation
from evolvent.fem.stress import cell_stress, von_mises
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.errors import InputError
from evolvent_meshes.files import write_bytes
from evolvent_meshes.input_checks import refuse
from evolvent_meshes.mesh.mesh_data import FACET_SHAPE
from evolvent_meshes.mesh.reference_cells import node_positions
from evolvent_meshes.mesh.vtk_xml import xml_bytes

VTK_CELLS = {
    ("interval", 1): 3, ("interval", 2): 21,
    ("triangle", 1): 5, ("triangle", 2): 22,
    ("quadrilateral", 1): 9, ("quadrilateral", 2): 28,
    ("tetrahedron", 1): 10, ("tetrahedron", 2): 24,
    ("hexahedron", 1): 12, ("hexahedron", 2): 29,
}
"""(shape, order) -> VTK's number of the Lagrange cell."""

Arrays = dict[str, Floats]


def write_paraview(solutions: Solution | Iterable[Solution], folder: Path | str) -> Path:
    """Writes solutions as a time series and returns the path of its .pvd file.

    solutions: one, several, or the iterator of a sweep; the .pvd file is up to date after each step.
    Raises InputError where the folder cannot be made, WriteError where a file cannot be written.
    """
    if isinstance(solutions, str) or not isinstance(solutions, Solution | Iterable):
        refuse("paraview", "a Solution, or several of them", solutions, "write write_paraview(solve(problem), folder)")
    target = _folder(folder)
    path, series = target / "series.pvd", ElementTree.Element("Collection")
    write_bytes(path, _collection(series))
    for step, solution in enumerate([solutions] if isinstance(solutions, Solution) else solutions, start=1):
        if not isinstance(solution, Solution):
            refuse("paraview", "Solutions only", solution, "give what solve and sweep return")
        for part, (name, file, data) in enumerate(_data_sets(solution)):
            write_bytes(target / f"{file}_{step:04d}.vtu", vtu_bytes(*data))
            entry = {"timestep": f"{step}", "group": "", "part": f"{part}", "name": name}
            ElementTree.SubElement(series, "DataSet", entry | {"file": f"{file}_{step:04d}.vtu"})
        write_bytes(path, _collection(series))
    return path


def _folder(folder: Path | str) -> Path:
    if not isinstance(folder, str | os.PathLike) or not str(folder):
        refuse("paraview", "a folder to write into", folder, 'write write_paraview(solutions, "out")')
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"paraview: wanted a folder to write into, found {folder}: {reason}; take another") from error
    return Path(folder)


def _collection(series: ElementTree.Element) -> bytes:
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1", byte_order="LittleEndian")
    root.append(series)
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True))


Data = tuple[Floats, Ints, tuple[str, int], Arrays, Arrays]


def _data_sets(solution: Solution) -> Iterable[tuple[str, str, Data]]:
    """Name, beginning of the file's name and content of each body and each contact."""
    for index, condensed in enumerate(solution.condensed):
        yield condensed.assembled.body.name, f"body_{index}", _body(solution, index)
    for index, contact in enumerate(solution.contacts):
        yield f"contact {index}", f"contact_{index}", _contact(solution, contact)


def _placement(solution: Solution, body: int) -> Placement:
    d = solution.condensed[body].assembled.d
    return solution.step.placements[body] if solution.step.placements else Placement.at_rest(d)


def _body(solution: Solution, index: int) -> Data:
    body, placement = solution.condensed[index].assembled.body, _placement(solution, index)
    mesh, u = body.mesh, solution.displacement(index)
    R = np.eye(3)
    R[: mesh.dimension, : mesh.dimension] = placement.rotation
    stress = R @ cell_stress(mesh, body.material, u) @ R.T
    x = mesh.points[:, : mesh.dimension] @ placement.rotation.T + placement.translation
    cells = {
        "stress_MPa": np.stack([stress[:, a, b] for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))], axis=1),
        "von_mises_MPa": von_mises(stress),
    }
    return x, mesh.cells, (mesh.shape, mesh.order), {"displacement_mm": _space(u @ placement.rotation.T)}, cells


def _contact(solution: Solution, contact: ContactResult) -> Data:
    index, group = contact.carrier
    surface, placement = solution.condensed[index].surfaces[group], _placement(solution, index)
    hats = surface.hat_matrix(contact.facets, contact.local)

    def about_nodes(values: Floats) -> Floats:
        total = hats.T @ (contact.weights[:, None] * values.reshape(len(values), -1))
        return np.asarray(total / surface.weights()[:, None])

    shape = FACET_SHAPE[solution.condensed[index].assembled.body.mesh.shape]
    arrays = {
        "displacement_mm": _space(solution.displacement(index)[surface.nodes] @ placement.rotation.T),
        "pressure_MPa": about_nodes(contact.pressure)[:, 0],
        "traction_MPa": _space(about_nodes(contact.traction)),
        "slip_mm": _space(about_nodes(contact.slip)),
    }
    facets = np.empty_like(surface.facets)
    facets[:, gmsh_permutation(shape, surface.order)] = surface.facets
    placed = surface.points @ placement.rotation.T + placement.translation
    return placed, facets, (shape, surface.order), arrays, {}


def _space(vectors: Floats) -> Floats:
    """Vectors (n, d) with zeros up to three components, (n, 3)."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def vtu_bytes(points: Floats, cells: Ints, kind: tuple[str, int], at_nodes: Arrays, in_cells: Arrays) -> bytes:
    """A .vtu file in double precision; VTK is imported here because it is slow to load.

    points: (n, d) [mm]. cells: (m, k) in gmsh's node order. kind: shape and order. at_nodes: (n, ...) and in_cells:
    (m, ...) fields by name.
    """
    import pyvista
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    number = VTK_CELLS[kind]
    rows = cells[:, _vtk_order(kind, number)]
    table = np.column_stack([np.full(len(rows), rows.shape[1]), rows]).ravel()
    grid: Any = pyvista.UnstructuredGrid(table, np.full(len(rows), number), _space(points))
    for name, values in at_nodes.items():
        grid.point_data[name] = np.ascontiguousarray(values)
    for name, values in in_cells.items():
        grid.cell_data[name] = np.ascontiguousarray(values)
    return xml_bytes(vtkXMLUnstructuredGridWriter(), grid)


@cache
def _vtk_order(kind: tuple[str, int], number: int) -> Ints:
    """Permutation (k,) with which cells[:, permutation] is in VTK's node order if cells is in gmsh's; from the
    positions of the nodes in both reference cells."""
    from vtkmodules.vtkCommonDataModel import vtkGenericCell

    cell = vtkGenericCell()
    cell.SetCellType(number)
    positions = np.array(cell.GetParametricCoords()).reshape(cell.GetNumberOfPoints(), 3)
    nodes = _space(node_positions(*kind) / 2.0)
    nearest = [int(np.argmin(np.linalg.norm(nodes - position, axis=1))) for position in positions]
    return np.array(nearest, dtype=np.int64)
