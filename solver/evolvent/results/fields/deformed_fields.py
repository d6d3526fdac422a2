"""Displacement and stress of the teeth in contact for ParaView.

    OUT/fields/deformed.pvd       to open in ParaView; time is the pinion rotation in °
    OUT/fields/deformed_0003.vtu  the loaded sectors of both gears, undeformed, at their place

Values are for the first friction coefficient. Nodes have displacement_mm ("Warp By Vector" shows the deformed teeth).
Cells have stress_MPa (nine components, in space) and von_mises_MPa at their centres, gear (0 pinion, 1 wheel) and tooth
(index of the pair). Near the contact the stress is as coarse as the cells; contact pressures are in contact.pvd.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

from evolvent.fem.stress import von_mises
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.fields.deformation import Deformation, DeformedTooth
from evolvent.results.run_data import RunData
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.reference_cells import corner_count
from evolvent_meshes.mesh.vtk_xml import xml_bytes

VTK_CELLS = {"triangle": 5, "quadrilateral": 9, "tetrahedron": 10, "hexahedron": 12}
"""Shape of a cell -> number of VTK's cell with corners only, whose order is that of gmsh."""


def write_deformed(run: RunData, deformation: Deformation, folder: RunFolder) -> Path:
    """Writes the series to OUT/fields; returns the .pvd file. Raises WriteError, FolderError."""
    collection = ElementTree.Element("VTKFile", type="Collection", version="0.1", byte_order="LittleEndian")
    series = ElementTree.SubElement(collection, "Collection")
    for k, each in enumerate(run.positions):
        file = f"deformed_{k:04d}.vtu"
        folder.write(f"fields/{file}", vtu_bytes(deformation.teeth(k), each[0].result))
        degrees = f"{np.degrees(run.angles[k]):.6f}"
        ElementTree.SubElement(series, "DataSet", timestep=degrees, group="", part="0", file=file)
    ElementTree.indent(collection)
    text = ElementTree.tostring(collection, encoding="unicode")
    return folder.write_text("fields/deformed.pvd", f'<?xml version="1.0"?>\n{text}\n')


def vtu_bytes(teeth: Sequence[DeformedTooth], result: PositionResult) -> bytes:
    """The content of a .vtu file with these teeth at a position, as cells with corners only."""
    placed = [_placed(tooth, result) for tooth in teeth]
    starts = np.cumsum([0] + [len(points) for points, *_ in placed[:-1]])
    grid = vtkUnstructuredGrid()
    nodes = vtkPoints()
    nodes.SetData(numpy_to_vtk(np.concatenate([points for points, *_ in placed]).astype(np.float32), deep=True))
    grid.SetPoints(nodes)
    corners = np.concatenate([cells + start for (_, cells, *_), start in zip(placed, starts)])
    rows = np.column_stack([np.full(len(corners), corners.shape[1]), corners]).astype(np.int64)
    cells = vtkCellArray()
    cells.SetCells(len(corners), numpy_to_vtkIdTypeArray(rows.ravel(), deep=True))
    grid.SetCells(VTK_CELLS[teeth[0].mesh.shape], cells)
    _add(grid.GetPointData(), "displacement_mm", np.concatenate([u for _, _, u, _ in placed]))
    stress = np.concatenate([σ for *_, σ in placed])
    _add(grid.GetCellData(), "stress_MPa", stress.reshape(-1, 9))
    _add(grid.GetCellData(), "von_mises_MPa", von_mises(stress))
    for name in ("gear", "tooth"):
        _add(grid.GetCellData(), name, np.repeat([getattr(t, name) for t in teeth], [len(t.mesh.cells) for t in teeth]))
    return xml_bytes(vtkXMLUnstructuredGridWriter(), grid)


def _placed(tooth: DeformedTooth, result: PositionResult) -> tuple[Floats, Ints, Floats, Floats]:
    """Corner points (n, 3) [mm], cells (cells, corners), displacement (n, 3) [mm] and stress (cells, 3, 3) [MPa] of a
    tooth at its place in space."""
    mesh, R = tooth.mesh, result.stand.rotation(tooth.gear, 3, tooth.tooth)
    used, cells = np.unique(mesh.cells[:, : corner_count(mesh.shape)], return_inverse=True)
    u = np.zeros((len(used), 3))
    u[:, : tooth.displacement.shape[1]] = tooth.displacement[used]
    points = mesh.points[used] @ R.T + result.stand.centre(tooth.gear, 3)
    return points, cells.reshape(len(mesh.cells), -1), u @ R.T, R @ tooth.stress @ R.T


def _add(data: object, name: str, values: NDArray[Any]) -> None:
    """Adds an array in single precision to VTK's point or cell data."""
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=np.float32), deep=True)
    array.SetName(name)
    data.AddArray(array)  # type: ignore[attr-defined]
