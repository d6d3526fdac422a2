"""A position of a line contact in the form of a resolved one, in which results are stored, certified and evaluated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from evolvent.gears.kinematics import PairRotation
from evolvent.gears.line.line_compliance import carried_arcs, nodal_loads
from evolvent.gears.line.line_gears import LineGears
from evolvent.gears.line.line_points import line_points
from evolvent.gears.line.line_result import LineResult
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.rotation import turn


@dataclass(frozen=True, eq=False)
class LoadedNodes:
    """Nodes of the flanks of a gear that bear load in line contact."""

    rows: Ints
    """(k, 2) tooth and flank node."""
    forces: Floats
    """(k, d) forces on them in the gear's own frame [N; per mm of width in the plane]."""


def position_of(
    gears: LineGears, result: LineResult, smooth: LineResult, force: float, seconds: float = 0.0
) -> PositionResult:
    """The position under a torque and a friction coefficient.

    smooth: the same without friction, whose tangent stiffness is that of the mesh.
    force: torque over base radius that was given [N; N/mm in the plane].
    seconds: wall time.
    """
    pair, nowhere = gears.pair, np.zeros(0, dtype=int)
    stand = PairRotation(pair, result.position.stations.angle)
    turned = stand.turned(gears.free, result.equilibrium.approach / pair.gears[gears.free].base_radius)
    pinion, wheel = (each * gear.base_radius for each, gear in zip(result.forces, pair.gears))
    heights = None if gears.spacing is None else gears.gears[0].heights[::2]
    contact = line_points(pair, result, heights, gears.driving)
    loaded = [loaded_nodes(gears, member, result) for member in Member]
    return PositionResult(
        stand=turned,
        friction=result.friction,
        torques=(pinion, wheel),
        contact=contact,
        tooth=nowhere,
        node=nowhere,
        weights=np.zeros(0),
        traction=np.zeros((0, contact.traction.shape[1])),
        iterations=result.equilibrium.iterations,
        residual=abs(result.forces[gears.free] / force - 1.0),
        stiffness=smooth.equilibrium.stiffness,
        pinion_rows=loaded[0].rows,
        wheel_rows=loaded[1].rows,
        pinion_forces=loaded[0].forces,
        wheel_forces=loaded[1].forces,
        seconds=seconds,
        driving=gears.driving,
    )


def loaded_nodes(gears: LineGears, member: Member, result: LineResult) -> LoadedNodes:
    """Forces on the nodes of the pinion or the wheel, under which it deflects: normal and tangential ones."""
    gear, position, load = gears.gears[member], result.position, result.equilibrium.load
    stations = position.stations
    arc = carried_arcs(gears.pair, member, stations, position.place)
    normal, along = nodal_loads(gear, stations, arc, position.width, stations.hats), None
    if result.friction:
        assert position.friction is not None
        signed = sp.csr_matrix(sp.diags(position.friction.direction) @ stations.hats)
        along = nodal_loads(gear, stations, arc, position.width, signed)
    rows, forces = [], []
    for tooth in result.teeth:
        q = np.where(stations.tooth == tooth, load, 0.0)
        vectors = (normal @ q)[:, None] * gear.inwards
        if along is not None:
            vectors += result.friction * (along @ q)[:, None] * gear.towards_tip
        bears, number = vectors.any(axis=1), gear.sign * tooth
        R = turn(2.0 * np.pi * number / gear.gear.z, vectors.shape[1])
        rows.append(np.column_stack([np.full(bears.sum(), number), gear.nodes[bears]]))
        forces.append(vectors[bears] @ R.T)
    return LoadedNodes(np.concatenate(rows), np.concatenate(forces))
