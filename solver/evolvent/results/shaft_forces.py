"""Loads of the mesh on the shafts: force and tilting moment on each gear, from the nodal contact forces.

Without friction and with the flanks' nominal normals they are, at the pitch point (ISO 21771:2007): tangential force
T/r_w, radial force F_t tan α_wt, axial force F_t tan β_w.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.run_data import RunData
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.rotation import turn


@dataclass(frozen=True)
class ShaftForces:
    """Loads of the mesh on a gear with friction: mean over the pitch, and peak-to-peak value.

    The forces act on the gear; the bearing reactions are opposite. x points along the line of centres from pinion to
    wheel, z along the axes, and y = z × x. Seen from +z the pinion turns counter-clockwise where it drives.
    """

    tangential_N: float
    """Tangential force: on the pinion positive along −y, on the wheel along +y; against the rotation of the gear that
    drives, with that of the other one."""
    tangential_peak_to_peak_N: float
    """Largest less smallest tangential force of the pitch."""
    radial_N: float
    """Radial force, positive where it separates the gears: on the pinion along −x, on the wheel along +x."""
    radial_peak_to_peak_N: float
    """Largest less smallest radial force of the pitch."""
    axial_N: float
    """Axial force along +z: positive on a right-hand pinion, negative on its wheel."""
    axial_peak_to_peak_N: float
    """Largest less smallest axial force of the pitch."""
    moment_x_Nm: float
    """Tilting moment about x, at mid-face on the gear's axis: it shows where along the face the load lies."""
    moment_x_peak_to_peak_Nm: float
    """Largest less smallest tilting moment about x of the pitch."""
    moment_y_Nm: float
    """Tilting moment about y, at mid-face on the gear's axis: mostly the axial force times the pitch radius."""
    moment_y_peak_to_peak_Nm: float
    """Largest less smallest tilting moment about y of the pitch."""


def shaft_forces(run: RunData, gear: Member, index: int) -> ShaftForces:
    """Loads on the pinion or the wheel at the friction coefficient with this index."""
    shape, separating = run.shapes[gear], -gear.sign
    nodes = shape.points[shape.flank_nodes]
    loads = run.width * np.array([_load(each[index].result, gear, nodes) for each in run.positions])
    signed = loads[:, [1, 0, 2, 3, 4]] * [separating, separating, 1.0, 1e-3, 1e-3]
    return ShaftForces(*np.column_stack([signed.mean(axis=0), np.ptp(signed, axis=0)]).ravel().tolist())


def _load(result: PositionResult, gear: Member, nodes: Floats) -> Floats:
    """(5,): force (x, y, z) on a gear [N] and its moments about x and y [N·mm] in the common frame; per mm of width in
    2D. nodes: (n, d) of the gear's flank in its own frame [mm]."""
    rows, forces = (result.pinion_rows, result.wheel_rows)[gear], (result.pinion_forces, result.wheel_forces)[gear]
    d, pitch = forces.shape[1], 2.0 * np.pi / result.stand.pair.gears[gear].z
    R = result.stand.rotation(gear, d)
    f = forces @ R.T
    if d == 2:
        return np.append(f.sum(axis=0), [0.0, 0.0, 0.0])
    moment = np.zeros(d)
    for tooth in np.unique(rows[:, 0]):
        here = rows[:, 0] == tooth
        points = nodes[rows[here, 1]] @ (R @ turn(float(tooth) * pitch, d)).T
        moment += np.cross(points, f[here]).sum(axis=0)
    return np.concatenate([f.sum(axis=0), moment[:2]])
