"""The pair of Zhang et al., Processes 2023, 11, 1807, Table 1."""

from __future__ import annotations

from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair

MODULE, TORQUE = 2.3, 500e3
"""[mm], [N·mm]."""


def zhang_pair(rack_tip_radius: float = 0.20) -> GearPair:
    """rack_tip_radius: ρ_fP over m_n, which the paper does not give."""
    pinion, wheel = (
        GearParameters(
            z=z, normal_module=MODULE, normal_pressure_angle_deg=18.0, profile_shift=x, face_width=b,
            tip_diameter=z * MODULE + 2.0 * addendum, root_diameter=z * MODULE + 2.0 * (addendum - 6.465),
            rack_tip_radius=rack_tip_radius * MODULE, bore_diameter=30.0,
        )
        for z, x, addendum, b in ((33, 0.3, 3.544, 29.0), (46, -0.008, 2.996, 25.0))
    )  # fmt: skip
    return GearPair(pinion, wheel, centre_distance=91.5)
