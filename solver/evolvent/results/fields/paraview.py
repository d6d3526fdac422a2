"""Fields for ParaView: a time series of the loaded flanks with their pressures, and of the teeth around them.

    OUT/fields/contact.pvd      to open in ParaView or with pyvista.get_reader; time is the pinion rotation in °
    OUT/fields/flanks_0003.vtp  loaded flanks of pinion and wheel in contact, at their place
    OUT/fields/gears_0003.vtp   the modelled teeth around them, without these flanks

Arrays of the flanks for each friction coefficient, with names such as "pressure_MPa (mu=0.07)":

    pressure_MPa       contact pressure; NaN in layers of cells that bear on a tip edge, or whose contact covers the
                       start of a linear relief of a spur pair
    edge_pressure_MPa  contact pressure in layers that bear on a tip edge, 0 elsewhere
    kink_pressure_MPa  contact pressure in layers whose contact covers the start of a relief, 0 elsewhere
    traction_MPa       contact traction on the pinion, pressure and friction, as a vector in space; NaN as pressure_MPa
    slip_mm_per_rad    velocity of the pinion's flank relative to the wheel's per rad/s of pinion speed
    sticks             1 at sticking nodes, else 0

Arrays for all friction coefficients: gear (0 pinion, 1 wheel), tooth (index of the pair), roll_distance_mm. Pressures
are nodal averages that preserve the force; peaks are in summary.json. On a tip edge the pressure is singular, ten times
that of the flanks. Flanks of the wheel have pressures only.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from scipy.spatial import cKDTree

from evolvent.gears.pressure.contact_slices import on_tip_edge, over_kink
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.fields.flank_field import flank_field, line_distance
from evolvent.results.fields.polygons import (
    Polygons,
    flank_surface,
    joined,
    nodal,
    on_flank,
    place,
    placed_teeth,
    sliding,
    space_vectors,
)
from evolvent.results.run_data import RunData, SolvedPosition, flank_nodes
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.vtk_xml import xml_bytes

Arrays = dict[str, Floats]
"""Name -> values (n,) or (n, 3) at the nodes of a surface."""

SAME_LEVEL = 1e-6
"""Heights closer than this are one level of nodes [mm]."""


def write_fields(run: RunData, folder: RunFolder) -> Path:
    """Writes the series of a run to OUT/fields; returns the .pvd file. Raises WriteError, FolderError."""
    files = []
    for k, each in enumerate(run.positions):
        flanks, arrays = flank_fields(run, each)
        gears = surrounding(run, each[0].result)
        for part, (name, surface, values) in enumerate((("flanks", flanks, arrays), ("gears", gears, {}))):
            file = f"{name}_{k:04d}.vtp"
            folder.write(f"fields/{file}", vtp_bytes(surface, values))
            files.append((run.angles[k], {"part": str(part), "name": name, "file": file}))
    return folder.write_text("fields/contact.pvd", series_text(files))


def series_text(files: Sequence[tuple[float, dict[str, str]]]) -> str:
    """Text of a .pvd file. files: pinion rotation [rad] and attributes of each file of the series."""
    collection = ElementTree.Element("VTKFile", type="Collection", version="0.1", byte_order="LittleEndian")
    series = ElementTree.SubElement(collection, "Collection")
    for angle, attributes in files:
        ElementTree.SubElement(series, "DataSet", {"timestep": f"{np.degrees(angle):.6f}", "group": "", **attributes})
    ElementTree.indent(collection)
    return f'<?xml version="1.0"?>\n{ElementTree.tostring(collection, encoding="unicode")}\n'


def flank_fields(run: RunData, solved: tuple[SolvedPosition, ...]) -> tuple[Polygons, Arrays]:
    """Loaded flanks of the teeth in contact at a position, and their arrays. solved: the results at all friction
    coefficients; flanks are placed as for the first."""
    first = solved[0].result
    parts, columns = [], []
    for gear in Member:
        surface = flank_surface(run.shapes[gear], run.pair.face_width)
        for tooth in sorted({tooth.tooth for each in solved for tooth in each.teeth}):
            parts.append(place(first, gear, tooth, surface))
            columns.append(_tooth_arrays(run, solved, gear, tooth))
    return joined(parts), {name: np.concatenate([each[name] for each in columns]) for name in columns[0]}


def _tooth_arrays(run: RunData, solved: tuple[SolvedPosition, ...], gear: Member, tooth: int) -> Arrays:
    """The arrays of the flank of one tooth."""
    shape, nodes = run.shapes[gear], flank_nodes(run.pair.gears[gear], run.shapes[gear])
    ξ = gear.sign * (nodes.roll_length - run.pair.pitch_point_roll_lengths[gear])
    arrays = {
        "gear": np.full(len(nodes.points), float(gear)),
        "tooth": np.full(len(nodes.points), float(tooth)),
        "roll_distance_mm": ξ,
    }
    below, above = _around(nodes.z, np.unique(run.flank.z))
    for each in solved:
        values_of = _pinion_values if gear == Member.PINION else _wheel_values
        edge, kink = (
            layers(each.cut, tooth, below) | layers(each.cut, tooth, above) for layers in (on_tip_edge, over_kink)
        )
        values = _apart(values_of(run, each.result, tooth), edge, kink & ~edge)
        arrays |= {f"{name} (mu={each.result.friction:g})": value for name, value in values.items()}
    return {name: on_flank(shape, value) for name, value in arrays.items()}


def _around(z: Floats, levels: Floats) -> tuple[Floats, Floats]:
    """The pinion's `levels` of nodes (k,) next to heights z (n,), below and above: nodes of the wheel lie between them
    and have pressures of both."""
    above = np.minimum(np.searchsorted(levels, z - SAME_LEVEL), len(levels) - 1)
    below = np.maximum(np.searchsorted(levels, z + SAME_LEVEL) - 1, 0)
    return levels[below], levels[above]


def _apart(values: Arrays, edge: Bools, kink: Bools) -> Arrays:
    """The arrays with the pressures on tip edges and over relief starts in arrays of their own. edge, kink: (n,) bool,
    nodes in layers that bear on a tip edge, or whose contact covers the start of a relief."""
    pressure = values["pressure_MPa"]
    apart = (edge | kink) & (pressure > 0.0)
    return values | {
        "pressure_MPa": np.where(apart, np.nan, pressure),
        "traction_MPa": np.where(apart[:, None], np.nan, values["traction_MPa"]),
        "edge_pressure_MPa": np.where(apart & edge, pressure, 0.0),
        "kink_pressure_MPa": np.where(apart & kink, pressure, 0.0),
    }


def _pinion_values(run: RunData, result: PositionResult, tooth: int) -> Arrays:
    """Pressure, traction, slip and state of friction at the flank nodes of a pinion tooth."""
    pressure = nodal(run, result, tooth, result.pressure)
    touching = pressure > 0.0
    return {
        "pressure_MPa": pressure,
        "traction_MPa": -nodal(run, result, tooth, space_vectors(run, result, result.traction)),
        "slip_mm_per_rad": np.where(touching[:, None], sliding(run, result, tooth), 0.0),
        "sticks": np.where(touching, _sticking(run, result, tooth), 0.0),
    }


def _sticking(run: RunData, result: PositionResult, tooth: int) -> Floats:
    """State of friction at the flank nodes (n,): 1 where the nearest contact point sticks, else 0."""
    points, nodes = result.contact, run.flank
    here = points.tooth == tooth
    if not np.any(points.sticks[here]):
        return np.zeros(len(nodes.points))
    s = line_distance(run.pair, result, tooth, Member.PINION, nodes.roll_length, nodes.z)
    _, nearest = cKDTree(np.column_stack([points.across, points.z])[here]).query(np.column_stack([s, nodes.z]))
    return points.sticks[here][nearest].astype(float)


def _wheel_values(run: RunData, result: PositionResult, tooth: int) -> Arrays:
    """The pinion's pressure at the flank nodes of the mating wheel tooth; zero vectors, which are given on the
    pinion."""
    nodes = flank_nodes(run.pair.wheel, run.shapes[1])
    n = len(nodes.points)
    pressure = np.zeros(n)
    if np.any(result.tooth == tooth):
        s = line_distance(run.pair, result, tooth, Member.WHEEL, nodes.roll_length, nodes.z)
        field = flank_field(run, result, tooth)
        for z in np.unique(nodes.z):
            row = nodes.z == z
            pressure[row] = field.at(s[row][:, None], np.array([z]))[:, 0]
    zero = np.zeros((n, 3))
    return {"pressure_MPa": pressure, "traction_MPa": zero, "slip_mm_per_rad": zero, "sticks": np.zeros(n)}


def surrounding(run: RunData, result: PositionResult) -> Polygons:
    """Teeth of both gears: those in contact without their loaded flanks, and one more on either side."""
    bare = {int(tooth) for tooth in np.unique(result.tooth)}
    teeth = list(range(min(bare) - 1, max(bare) + 2))
    placed = [placed_teeth(run, result, gear, teeth, bare) for gear in Member]
    return joined([surface for surface in placed if surface is not None])


def vtp_bytes(surface: Polygons, arrays: Arrays) -> bytes:
    """The content of a .vtp file in single precision."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    mesh: Any = poly_data(Polygons(surface.points.astype(np.float32), surface.faces))
    for name, values in arrays.items():
        mesh.point_data[name] = np.ascontiguousarray(values, dtype=np.float32)
    return xml_bytes(vtkXMLPolyDataWriter(), mesh)


def poly_data(surface: Polygons) -> Any:
    """The surface as pyvista's PolyData. pyvista is imported here because its import is slow."""
    import pyvista

    faces = [np.column_stack([np.full(len(face), face.shape[1]), face]).ravel() for face in surface.faces]
    return pyvista.PolyData(np.ascontiguousarray(surface.points), np.concatenate(faces))
