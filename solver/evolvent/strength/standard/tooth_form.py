"""Form factor and stress correction factor of a tooth for any point of load: ISO 6336-3:2006, 6.2 and 7.2."""

from __future__ import annotations

import math
from dataclasses import dataclass

from evolvent.strength.standard.critical_section import CriticalSection
from evolvent.strength.standard.virtual_gear import VirtualGear
from evolvent_meshes.errors import InputError

NOTCH = 1.0, 8.0
"""Range of the notch parameter q_s for which Y_S was fitted."""


@dataclass(frozen=True)
class LoadPoint:
    """Point at which the normal force acts on a virtual gear."""

    diameter: float
    """Diameter d_e of the point [mm]."""
    load_angle: float
    """Load angle α_Fe between the force and the normal of the tooth's axis [rad]."""
    half_angle: float
    """Half angle γ_e that the tooth covers at the point [rad]."""

    @property
    def height(self) -> float:
        """Distance from the gear's axis at which the force meets the tooth's axis [mm]."""
        γ = self.half_angle
        return 0.5 * self.diameter * (math.cos(γ) - math.sin(γ) * math.tan(self.load_angle))


def load_point(gear: VirtualGear, below_tip: float) -> LoadPoint:
    """The point that lies `below_tip` [mm] from the tip along the line of action. Raises InputError below the base
    circle."""
    roll = gear.tip_roll_length - below_tip
    if not 0.0 <= roll <= gear.tip_roll_length:
        raise InputError(
            f"load on a tooth with z_n = {gear.teeth:.4g}: wanted a point from 0 to {gear.tip_roll_length:.4g} mm "
            f"below the tip along the line of action, found {below_tip:.4g} mm"
        )
    angle = math.atan(2.0 * roll / gear.base_diameter)
    γ = gear.half_angle(angle)
    return LoadPoint(gear.base_diameter / math.cos(angle), angle - γ, γ)


@dataclass(frozen=True)
class ToothForm:
    """The tooth as a beam from the critical section to the point of load."""

    section: CriticalSection
    """Critical section of the root."""
    point: LoadPoint
    """Point of load."""

    @property
    def arm(self) -> float:
        """Bending moment arm h_Fe [mm]."""
        return self.point.height - self.section.height

    @property
    def form_factor(self) -> float:
        """Form factor Y_F = 6 (h_Fe/m_n) cos α_Fe / ((s_Fn/m_n)² cos α_n)."""
        m, α = self.section.gear.module, self.section.gear.pressure_angle
        return 6.0 * self.arm / m * math.cos(self.point.load_angle) / ((self.section.chord / m) ** 2 * math.cos(α))

    @property
    def notch_parameter(self) -> float:
        """Notch parameter q_s = s_Fn/(2 ρ_F)."""
        return self.section.chord / (2.0 * self.section.radius)

    @property
    def is_in_range(self) -> bool:
        """Whether Y_S was fitted for this notch parameter."""
        return NOTCH[0] <= self.notch_parameter < NOTCH[1]

    @property
    def stress_correction_factor(self) -> float:
        """Stress correction factor Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)), L = s_Fn/h_Fe."""
        L = self.section.chord / self.arm
        return float((1.2 + 0.13 * L) * self.notch_parameter ** (1.0 / (1.21 + 2.3 / L)))
