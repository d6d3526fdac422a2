"""What holds a gear's bores, summed over all sectors, against the forces on its teeth."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from evolvent.fem.body import assemble
from evolvent.gears.condensed_gear import GearBody, sector_body
from evolvent.gears.sweep.position_result import NodalForces
from evolvent.results.fields.deformation import GearField
from evolvent_meshes.arrays import Floats
from evolvent_meshes.rotation import turn


def reaction_imbalance(body: GearBody) -> Floats:
    """Sum of forces (d) and moment about the axis of random forces on two neighbouring teeth and of the reactions K u
    at the bores of all sectors, over the sum of the forces' components and, of the moment, the tip diameter too.

    body: with all teeth condensed.
    """
    mesh, gear, d = body.mesh, body.gear, body.d
    nodes = np.arange(len(body.flank.points))
    numbers = sorted([0, body.member.sign])
    rows = np.concatenate([np.column_stack([np.full(len(nodes), number), nodes]) for number in numbers])
    loads = NodalForces(rows, np.random.default_rng(3).normal(size=(1, len(rows), d)))
    field, held = GearField(body, loads), np.unique(mesh.facets["bore"])
    K = sp.csr_matrix(assemble(sector_body(mesh, body.material, body.member)).stiffness)
    rotations = {number: turn(number * 2.0 * np.pi / gear.z, d) for number in
                 (body.member.sign * tooth for tooth in range(gear.z))}
    places = np.array([rotations[number] @ body.flank.points[node, :d] for number, node in rows])
    total = _resultant(places, loads.forces[0])
    for number, R in rotations.items():
        reaction = (K @ field.displacement(0, number).ravel()).reshape(-1, d)[held]
        total += _resultant(mesh.points[held, :d] @ R.T, reaction @ R.T)
    lengths = np.array([*[1.0] * d, gear.tip_diameter])
    return np.abs(total) / (np.abs(loads.forces).sum() * lengths)


def _resultant(places: Floats, forces: Floats) -> Floats:
    """Force (d) and moment about the axis."""
    moment = np.sum(places[:, 0] * forces[:, 1] - places[:, 1] * forces[:, 0])
    return np.array([*forces.sum(axis=0), moment])
