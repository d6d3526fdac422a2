"""The contact points of a gear position: their places on both flanks, tractions and sliding velocities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from evolvent.gears.contact.contact_geometry import ContactGeometry, relative_velocity
from evolvent.gears.kinematics import line_of_action
from evolvent_meshes.arrays import Bools, Floats, Ints


@dataclass(frozen=True)
class ContactPoints:
    """The contact of a position at its q quadrature points under pressure, on the pinion's flanks.

    tooth: (q,), tooth pair.
    z: (q,), height [mm].
    roll_distance: (q,), ξ of the point's slice [mm].
    across: (q,), signed distance from the nominal contact line on the pinion [mm of profile arc], positive towards its
        tip.
    opposite: (q,), the same on the wheel, positive towards the wheel's tip.
    weights: (q,), of the quadrature [mm²; mm in 2D].
    traction: (q, d), λ, τ in local frames [MPa].
    rate: (q, d), relative velocity of pinion over wheel per radian of pinion rotation, local [mm/rad].
    sliding: (q,), its part along e_z × n of `line_of_action`, between flanks as searched; in a wear study with what
        deflection adds (elastic_sliding.py) [mm/rad].
    sticks: (q,) bool, tangential traction below the friction bound.
    edge: (q,) bool, in the last row of facets before a tip edge.
    """

    tooth: Ints
    z: Floats
    roll_distance: Floats
    across: Floats
    opposite: Floats
    weights: Floats
    traction: Floats
    rate: Floats
    sliding: Floats
    sticks: Bools
    edge: Bools

    @staticmethod
    def joined(positions: Sequence[ContactPoints]) -> ContactPoints:
        """All points of one or more positions, in their order."""
        names = [field.name for field in fields(ContactPoints)]
        return ContactPoints(*(np.concatenate([getattr(points, name) for points in positions]) for name in names))

    @property
    def pressure(self) -> Floats:
        """Contact pressure λ (q,) [MPa]."""
        return self.traction[:, 0]

    def normal_force(self, tooth: int) -> float:
        """Normal force of a tooth pair [N; N/mm in 2D]."""
        return float(np.sum((self.weights * self.pressure)[self.tooth == tooth]))


def contact_points(
    geometry: ContactGeometry, traction: Floats, friction: float, beyond_nominal: tuple[float, float]
) -> ContactPoints:
    """The points under pressure, from tractions (q, k) [MPa] at all points.

    beyond_nominal: rotations of both gears beyond the nominal ones in this equilibrium, near those of the search [rad].
    """
    pair, searched, operator = geometry.stand.pair, geometry.stand.beyond_nominal, geometry.operator
    radius = pair.pinion.base_radius
    shift = radius * (beyond_nominal[0] - searched[0]) - radius * (beyond_nominal[1] - searched[1])  # r_b2/u is r_b1
    rate, along = relative_velocity(geometry), line_of_action(pair, geometry.d)[1]
    sliding = np.einsum("ji,jia,a->j", rate, operator.frames, along)
    pressed = np.flatnonzero(traction[:, 0] > 0.0)
    shape, t = operator.shape[pressed], traction[pressed]
    bound = friction * t[:, 0]
    size = np.linalg.norm(t[:, 1:], axis=1)
    return ContactPoints(
        tooth=geometry.point_tooth[pressed],
        z=shape @ geometry.z,
        roll_distance=shape @ geometry.roll_distance,
        across=geometry.across[pressed],
        opposite=geometry.opposite[pressed],
        weights=operator.weights[pressed],
        traction=t,
        rate=shape @ rate,
        sliding=shape @ sliding + shift,
        sticks=size < bound * (1.0 - 1e-9),
        edge=geometry.at_tip_edge[pressed],
    )
