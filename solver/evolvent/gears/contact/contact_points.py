"""The contact points of a gear position: where they lie on both flanks, what they carry, how they slide."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from evolvent.gears.contact.pair_contact import GearContact, relative_velocity
from evolvent.gears.kinematics import line_of_action
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class ContactPoints:
    """The contact of a position at its q quadrature points on the pinion's flanks.

    tooth (q,). z: height [mm]. ξ: roll distance of the point's slice [mm]. across: signed distance from the nominal
    contact line on the pinion, opposite: on the wheel [mm of profile arc, positive towards each gear's tip]. weights
    [mm²; mm in 2D]. traction: (q, d) λ, τ in local frames [MPa]. rate: (q, d) relative velocity of pinion over wheel
    per radian of pinion rotation, local [mm/rad]; sliding: (q,) its part along e_z × n of `line_of_action`, between
    flanks as searched; in a wear study with what deflection adds (elastic_sliding.py). sticks, edge: (q,) bool;
    edge: in the last row of facets before a tip edge.
    """

    tooth: Ints
    z: Floats
    ξ: Floats
    across: Floats
    opposite: Floats
    weights: Floats
    traction: Floats
    rate: Floats
    sliding: Floats
    sticks: np.ndarray
    edge: np.ndarray

    @staticmethod
    def joined(positions: Sequence[ContactPoints]) -> ContactPoints:
        """All points of one or more positions, in their order."""
        names = [field.name for field in fields(ContactPoints)]
        return ContactPoints(*(np.concatenate([getattr(own, name) for own in positions]) for name in names))

    @property
    def pressure(self) -> Floats:
        """λ (q,) [MPa]."""
        return self.traction[:, 0]


def contact_points(
    contact: GearContact, traction: Floats, friction: float, extra: tuple[float, float]
) -> ContactPoints:  # fmt: skip
    """Of tractions (q, k): what is kept of the points, those under pressure. extra: the rotations [rad] beyond the
    nominal ones with which they were found, near those of the search."""
    radius, searched = contact.stand.pair.pinion.base_radius, contact.stand.extra
    shift = radius * (extra[0] - searched[0]) - radius * (extra[1] - searched[1])  # r_b2/u is r_b1
    rate, along = relative_velocity(contact), line_of_action(contact.stand.pair, contact.d)[1]
    sliding = np.einsum("ji,jia,a->j", rate, contact.operator.frames, along)
    pressed = np.flatnonzero(traction[:, 0] > 0.0)
    shape, t = contact.operator.shape[pressed], traction[pressed]
    bound = friction * t[:, 0]
    size = np.linalg.norm(t[:, 1:], axis=1)
    return ContactPoints(
        tooth=contact.point_tooth[pressed],
        z=shape @ contact.bodies[0].z[contact.node],
        ξ=shape @ contact.ξ,
        across=contact.across[pressed],
        opposite=contact.opposite[pressed],
        weights=contact.operator.weights[pressed],
        traction=t,
        rate=shape @ rate,
        sliding=shape @ sliding + shift,
        sticks=size < bound * (1.0 - 1e-9),
        edge=contact.at_edge[pressed],
    )
