"""The spur gear in the normal section of a helical one, on which ISO 6336-3 bases its tooth form: ISO 6336-3:2006, 6.2.

A spur gear is its own virtual gear. Lengths are in mm and angles in rad, unless a name says otherwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.gear_geometry import involute_function
from evolvent_meshes.gears.pair import GearPair


@dataclass(frozen=True)
class VirtualGear:
    """A spur gear, whose number of teeth need not be whole."""

    teeth: float
    """Number of teeth z_n."""
    module: float
    """Normal module m_n [mm]."""
    pressure_angle: float
    """Normal pressure angle α_n [rad]."""
    profile_shift: float
    """Profile shift coefficient x_E of the tooth with its thickness allowance."""
    tip_diameter: float
    """Tip diameter d_an [mm]."""

    @property
    def reference_diameter(self) -> float:
        """Reference diameter d_n = m_n z_n [mm]."""
        return self.module * self.teeth

    @property
    def base_diameter(self) -> float:
        """Base diameter d_bn = d_n cos α_n [mm]."""
        return self.reference_diameter * math.cos(self.pressure_angle)

    @property
    def base_pitch(self) -> float:
        """Base pitch p_bn = π m_n cos α_n [mm]."""
        return math.pi * self.module * math.cos(self.pressure_angle)

    @property
    def tip_roll_length(self) -> float:
        """Radius of curvature of the involute at the tip [mm]."""
        return 0.5 * math.sqrt(self.tip_diameter**2 - self.base_diameter**2)

    def half_angle(self, pressure_angle: float) -> float:
        """Half angle γ [rad] that the tooth covers where the involute has this pressure angle [rad]."""
        shift = 2.0 * self.profile_shift * math.tan(self.pressure_angle)
        return (
            (0.5 * math.pi + shift) / self.teeth
            + involute_function(self.pressure_angle) - involute_function(pressure_angle)
        )


def virtual_gear(gear: GearParameters) -> VirtualGear:
    """Virtual gear of z_n teeth, d_an = d_n + d_Fa − d: loads act up to the tip form circle."""
    tip = gear.virtual_teeth * gear.normal_module + gear.tip_form_diameter - gear.reference_diameter
    return VirtualGear(gear.virtual_teeth, gear.normal_module, gear.normal_pressure_angle, gear.generating_shift, tip)


def virtual_contact_ratio(pair: GearPair) -> float:
    """Contact ratio ε_αn = ε_α/cos² β_b of the virtual gears."""
    return pair.transverse_contact_ratio / math.cos(pair.pinion.base_helix_angle) ** 2
