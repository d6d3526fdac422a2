"""The gear pairs of the three papers as printed, for the geometry tests (bores and tool radii are not printed)."""

from typing import Any

from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.gears.pair import GearPair


def yang(
    pinion: Modifications | None = None, wheel: Modifications | None = None, misalignment_um: float = 0.0
) -> GearPair:
    """Helical pair 17/60, tool tip radius 0.25 m_n; right-hand pinion."""
    common: dict[str, Any] = {
        "normal_module": 2.1,
        "normal_pressure_angle_deg": 17.5,
        "helix_angle_deg": 29.0,
        "face_width": 16.9,
    }
    small = GearParameters(
        z=17,
        profile_shift=0.3721,
        tip_diameter=47.8,
        root_diameter=35.66,
        rack_tip_radius=0.525,
        hand=1,
        bore_diameter=20.0,
        modifications=pinion or Modifications(),
        **common,
    )
    large = GearParameters(
        z=60,
        profile_shift=-0.0994,
        tip_diameter=149.3,
        root_diameter=136.93,
        rack_tip_radius=0.525,
        hand=-1,
        bore_diameter=60.0,
        modifications=wheel or Modifications(),
        **common,
    )
    return GearPair(small, large, 93.0, misalignment_um)


def he_gear(tip_diameter: float = 156.0) -> GearParameters:
    """One of the two equal spur gears; root and tool of the standard rack 1.25/0.25."""
    return GearParameters(
        z=50,
        normal_module=3.0,
        normal_pressure_angle_deg=20.0,
        face_width=20.0,
        tip_diameter=tip_diameter,
        root_diameter=142.5,
        rack_tip_radius=0.75,
        bore_diameter=70.0,
    )


def he(tip_diameter: float = 156.0) -> GearPair:
    """Spur pair 50/50."""
    return GearPair(he_gear(tip_diameter), he_gear(tip_diameter), 150.0)


def zhang(rack_tip_radius_coefficient: float = 0.2) -> GearPair:
    """Spur pair 33/46 of high contact ratio: tip from the printed addenda, root from the printed height 6.465."""
    common: dict[str, Any] = {
        "normal_module": 2.3,
        "normal_pressure_angle_deg": 18.0,
        "rack_tip_radius": 2.3 * rack_tip_radius_coefficient,
        "bore_diameter": 40.0,
    }
    small = GearParameters(
        z=33,
        profile_shift=0.300,
        face_width=29.0,
        tip_diameter=75.9 + 2 * 3.544,
        root_diameter=75.9 + 2 * (3.544 - 6.465),
        **common,
    )
    large = GearParameters(
        z=46,
        profile_shift=-0.008,
        face_width=25.0,
        tip_diameter=105.8 + 2 * 2.996,
        root_diameter=105.8 + 2 * (2.996 - 6.465),
        **common,
    )
    return GearPair(small, large, 91.5)
