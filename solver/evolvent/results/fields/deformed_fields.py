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

import numpy as np
import pyvista
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

from evolvent.fem.stress import von_mises
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.fields.deformation import Deformation, DeformedTooth
from evolvent.results.fields.paraview import series_text
from evolvent.results.run_data import RunData
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.mesh.reference_cells import corner_count
from evolvent_meshes.mesh.vtk_xml import xml_bytes

VTK_CELLS = {"triangle": 5, "quadrilateral": 9, "tetrahedron": 10, "hexahedron": 12}
"""Shape of a cell -> number of VTK's cell with corners only, whose order is that of gmsh."""


def write_deformed(run: RunData, deformation: Deformation, folder: RunFolder) -> Path:
    """Writes the series to OUT/fields; returns the .pvd file. Raises WriteError, FolderError."""
    files = []
    for k, each in enumerate(run.positions):
        file = f"deformed_{k:04d}.vtu"
        folder.write(f"fields/{file}", vtu_bytes(deformation.teeth(k), each[0].result))
        files.append((run.angles[k], {"part": "0", "file": file}))
    return folder.write_text("fields/deformed.pvd", series_text(files))


def vtu_bytes(teeth: Sequence[DeformedTooth], result: PositionResult) -> bytes:
    """The content of a .vtu file with these teeth at a position, as cells with corners only."""
    placed = [_placed(tooth, result) for tooth in teeth]
    starts = np.cumsum([0] + [len(points) for points, *_ in placed[:-1]])
    nodes = np.concatenate([points for points, *_ in placed]).astype(np.float32)
    corners = np.concatenate([cells + start for (_, cells, *_), start in zip(placed, starts)])
    grid = pyvista.UnstructuredGrid({VTK_CELLS[teeth[0].mesh.shape]: corners}, nodes)
    grid.point_data["displacement_mm"] = np.concatenate([u for _, _, u, _ in placed]).astype(np.float32)
    stress = np.concatenate([σ for *_, σ in placed])
    arrays = {"stress_MPa": stress.reshape(-1, 9), "von_mises_MPa": von_mises(stress)}
    for name in ("gear", "tooth"):
        arrays[name] = np.repeat([getattr(t, name) for t in teeth], [len(t.mesh.cells) for t in teeth])
    for name, values in arrays.items():
        grid.cell_data[name] = values.astype(np.float32)
    grid.point_data.active_scalars_name = grid.cell_data.active_scalars_name = None  # no field is shown unasked
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
