"""Mesh force on a gear's flanks, averaged over a pitch, with the same force per length on all contact lines of a
position."""

from __future__ import annotations

import numpy as np

from evolvent.fem.lagrange import tabulate
from evolvent.fem.reference_facets import subcell_rule
from evolvent.fem.surface import Surface
from evolvent.gears.kinematics import spin
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

DEGREE = 4
"""Polynomial degree of the quadrature rule on each part of a facet."""
BEYOND = 2
"""Tooth pairs before and behind those in contact at rotation 0 that may touch within half a pitch of it."""


def mean_load(pair: GearPair, member: Member, flank: Surface) -> dict[int, Floats]:
    """Forces (n, d) on the nodes of the flank (n) of each tooth, in that tooth's frame, of a unit mesh force along the
    line of action: tooth number -> forces. Teeth stand as within half a pitch of rotation 0.

    flank: of tooth 0.
    """
    gear, d = pair.gears[member], flank.points.shape[1]
    xi, w = subcell_rule(flank.shape, flank.order, DEGREE)
    every = np.arange(len(flank.facets))
    at = np.broadcast_to(xi, (len(every), *xi.shape))
    points = flank.positions(every, at)
    area = np.linalg.norm(flank.area_vectors(every, at), axis=-1) * w
    z = points[..., 2] if d == 3 else np.zeros(area.shape)
    roll = Flank(gear).roll_length(np.hypot(points[..., 0], points[..., 1]))
    distance = member.sign * (roll - pair.pitch_point_roll_lengths[member])
    begin, end = pair.path_of_contact
    faces = (distance >= begin) & (distance <= end) & (np.abs(z) <= 0.5 * pair.face_width)
    pushed = -Flank(gear).helicoid_normal(roll, z)[..., :d]
    shape = tabulate(flank.shape, flank.order, xi)[0]
    loads, touching = {}, pair.teeth_in_contact(0.0)
    for tooth in range(min(touching) - BEYOND, max(touching) + BEYOND + 1):
        rotation = (distance - pair.roll_distance(0.0, tooth, z)) / pair.pinion.base_radius
        on = faces & (np.abs(rotation) <= np.pi / pair.pinion.z)
        if on.any():
            share = np.zeros(area.shape)
            share[on] = area[on] * gear.base_radius / roll[on] / _line_length(pair, rotation[on])
            forces = np.zeros_like(flank.points)
            np.add.at(forces, flank.facets, np.einsum("mq,qk,mqd->mkd", share, shape, pushed))
            loads[member.sign * tooth] = forces
    arm = spin(flank.points, np.zeros(d))
    torque = abs(sum(float(np.sum(forces * arm)) for forces in loads.values()))
    return {tooth: forces * (gear.base_radius / torque) for tooth, forces in loads.items()}


def _line_length(pair: GearPair, rotations: Floats) -> Floats:
    """Length (n,) of all contact lines together at pinion rotations (n,) [mm]."""
    return np.array([pair.contact_line_length(float(rotation)) for rotation in rotations])
