"""What the mesh does to the shafts: force on each gear and its tilting moment, from the nodal forces of the contact.

Of a gear, at the pitch point: tangential = T/r_w, radial = tangential · tan α_wt, axial = tangential · tan β_w, without
friction and with all flanks' normals as designed (ISO 21771).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.gears.kinematics import turn
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.run_data import RunData
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class ShaftForces:
    """What the mesh does to a gear, friction included: mean over the pitch, and largest less smallest value.

    The forces act on the gear; bearings react with the opposite. x: along the line of centres, from pinion to wheel; z:
    along the axes; seen from +z the pinion turns counter-clockwise; y = z × x.
    """

    tangential_N: float
    """Along y: on the pinion positive along −y, against its rotation; on the wheel along +y, with its rotation."""
    tangential_peak_to_peak_N: float
    """Of the tangential force."""
    radial_N: float
    """Along x, positive where it pushes the gears apart: on the pinion along −x, on the wheel along +x."""
    radial_peak_to_peak_N: float
    """Of the radial force."""
    axial_N: float
    """Along +z: positive on a right-hand pinion, negative on its wheel."""
    axial_peak_to_peak_N: float
    """Of the axial force."""
    moment_x_Nm: float
    """Tilting moment about x, at mid-face on the gear's axis: where along the face the load lies."""
    moment_x_peak_to_peak_Nm: float
    """Of that moment."""
    moment_y_Nm: float
    """Tilting moment about y, at mid-face on the gear's axis: mostly the axial force times the pitch radius."""
    moment_y_peak_to_peak_Nm: float
    """Of that moment."""


def shaft_forces(run: RunData, gear: Member, index: int) -> ShaftForces:
    """On the pinion or the wheel, at friction coefficient number `index`."""
    shape, apart = run.shapes[gear], -gear.sign
    nodes = shape.points[shape.flank_nodes]
    loads = run.width * np.array([_load(each[index].result, gear, nodes) for each in run.positions])
    signed = loads[:, [1, 0, 2, 3, 4]] * [apart, apart, 1.0, 1e-3, 1e-3]
    return ShaftForces(*np.column_stack([signed.mean(axis=0), np.ptp(signed, axis=0)]).ravel().tolist())


def _load(result: PositionResult, gear: Member, nodes: Floats) -> Floats:
    """Force (x, y, z) [N] on a gear and its moments about x and y [N·mm], per mm of width in 2D, in the common frame;
    nodes: (n, d) of its flank in its own frame [mm]."""
    rows, forces = (result.pinion_rows, result.wheel_rows)[gear], (result.pinion_forces, result.wheel_forces)[gear]
    d, pitch = forces.shape[1], 2.0 * np.pi / result.stand.pair.gears[gear].z
    R = result.stand.rotation(gear, d)
    f = forces @ R.T
    if d == 2:
        return np.append(f.sum(axis=0), [0.0, 0.0, 0.0])
    moment = np.zeros(d)
    for tooth in np.unique(rows[:, 0]):
        own = rows[:, 0] == tooth
        points = nodes[rows[own, 1]] @ (R @ turn(float(tooth) * pitch, d)).T
        moment += np.cross(points, f[own]).sum(axis=0)
    return np.concatenate([f.sum(axis=0), moment[:2]])
