"""Displacement and stress of the teeth in contact for ParaView.

    OUT/fields/deformed.pvd       open this one; time is the pinion rotation in °
    OUT/fields/deformed_0003.vtu  the sectors of both gears that carry load, undeformed where they stand

displacement_mm at the nodes ("Warp By Vector" bends the teeth), at the first friction coefficient; in the cells
stress_MPa (nine components, in space) and von_mises_MPa at their centres, gear (0 pinion, 1 wheel) and tooth (pair).
Next to the contact the stress is as coarse as the cells; contact pressure is in contact.pvd.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
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
"""VTK's number of a cell with corners only, whose order is gmsh's."""


def write_deformed(run: RunData, deformation: Deformation, folder: RunFolder) -> Path:
    """Writes the series into OUT/fields; gives the .pvd file. Raises WriteError, FolderError."""
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
    """The content of a .vtu of some teeth at a position, cells by their corners."""
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
    """Points (n, 3), cells by their corners, displacement (n, 3) and stress (cells, 3, 3) where the tooth stands."""
    mesh, R = tooth.mesh, result.stand.rotation(tooth.gear, 3, tooth.tooth)
    used, cells = np.unique(mesh.cells[:, : corner_count(mesh.shape)], return_inverse=True)
    u = np.zeros((len(used), 3))
    u[:, : tooth.displacement.shape[1]] = tooth.displacement[used]
    points = mesh.points[used] @ R.T + result.stand.centre(tooth.gear, 3)
    return points, cells.reshape(len(mesh.cells), -1), u @ R.T, R @ tooth.stress @ R.T


def _add(data: object, name: str, values: np.ndarray) -> None:
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=np.float32), deep=True)
    array.SetName(name)
    data.AddArray(array)  # type: ignore[attr-defined]
