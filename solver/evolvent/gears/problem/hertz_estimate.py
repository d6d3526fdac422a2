"""Estimates of a gear pair before it is solved: Hertz contact on the nominal contact lines.

The estimates are frictionless and spread the load evenly over the contact lines of rigid flanks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from evolvent.contact.hertz import contact_modulus, line_half_width, line_peak_pressure
from evolvent.fem.material import Material
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair

TOOTH_STIFFNESS = 14.0
"""Single stiffness c' of a steel tooth pair [N/(mm µm)], ISO 6336-1; each tooth has twice that, in proportion to its
modulus."""
STEEL_MODULUS = 206e3
"""Young's modulus of that steel [MPa]."""


@dataclass(frozen=True)
class HertzEstimate:
    """Hertz contact along the path of contact, frictionless, the load spread evenly over the contact lines.

    Examples:
        >>> from evolvent.gears import GearPair, GearParameters, Material
        >>> gear = GearParameters.from_rack(z=50, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0,
        ...                                 bore_diameter=70.0)
        >>> steel = Material(210e3, 0.3)
        >>> estimate = HertzEstimate.of(GearPair(gear, gear, centre_distance=150.0), (steel, steel), 170e3)
        >>> print(f"{estimate.normal_force:.0f} N, {float(estimate.half_width(0.0)):.3f} mm")
        2412 N, 0.099 mm
    """

    pair: GearPair
    """The gears' geometry."""
    modulus: float
    """Contact modulus E* [MPa]."""
    pinion_torque: float
    """Torque on the pinion [N·mm]."""

    @classmethod
    def of(cls, pair: GearPair, materials: tuple[Material, Material], pinion_torque: float) -> HertzEstimate:
        """The estimate for gears of these materials (pinion, wheel) under the torque on the pinion [N·mm]."""
        pinion, wheel = materials
        constants = pinion.youngs_modulus, pinion.poissons_ratio, wheel.youngs_modulus, wheel.poissons_ratio
        return cls(pair, contact_modulus(*constants), pinion_torque)

    @property
    def normal_force(self) -> float:
        """F_bn = T1/(r_b1 cos β_b) [N], normal to the flanks."""
        return self.pinion_torque / (self.pair.pinion.base_radius * math.cos(self.pair.pinion.base_helix_angle))

    @property
    def line_lengths(self) -> tuple[float, float, float]:
        """Shortest, mean and longest total contact line over a pitch [mm]."""
        lengths = [self.pair.contact_line_length(rotation) for rotation in self._extreme_rotations()]
        mean = self.pair.transverse_contact_ratio * self.pair.face_width / math.cos(self.pair.pinion.base_helix_angle)
        return min(lengths), mean, max(lengths)

    def _extreme_rotations(self) -> Floats:
        """Pinion rotations between which the line length is linear (helical) or constant (spur)."""
        pinion, pitch = self.pair.pinion, self.pair.pinion.transverse_base_pitch
        reach = self.pair.face_width / 2 * math.tan(pinion.base_helix_angle)
        corners = np.sort([(end + side * reach) % pitch for end in self.pair.path_of_contact for side in (-1, 1)])
        between = (corners + np.append(corners[1:], corners[0] + pitch)) / 2
        return (between if reach == 0 else np.append(corners, between)) / pinion.base_radius

    def half_width(self, roll_distance: float | Floats, line_length: float | None = None) -> Floats:
        """Half-width b_H [mm] of the contact at roll distances ξ [mm], with the given or the mean line length [mm]."""
        load = np.asarray(self.normal_force / (line_length or self.line_lengths[1]))
        return line_half_width(load, self.pair.relative_curvature_radius(roll_distance), self.modulus)

    def peak_pressure(self, roll_distance: float | Floats, line_length: float | None = None) -> Floats:
        """Peak pressure p0 [MPa] at roll distances ξ [mm], with the given or the mean line length [mm]."""
        load = np.asarray(self.normal_force / (line_length or self.line_lengths[1]))
        return line_peak_pressure(load, self.pair.relative_curvature_radius(roll_distance), self.modulus)

    def wear_per_cycle(self, pinion: float, wheel: float) -> tuple[float, float]:
        """Largest worn depth of pinion and wheel per revolution of the pinion [mm], from the K/H of both [mm²/N].

        (K/H)(F/L)|1 − v_2/v_1| (He et al. 2022, Eq. 24 without its 4/π) at the ends of the path of contact, with the
        mean line length.
        """
        load = self.normal_force / self.line_lengths[1]
        slides = [float(np.abs(ζ).max()) for ζ in self.pair.specific_sliding(self.pair.path_of_contact)]
        return pinion * load * slides[0], wheel * load * slides[1] / self.pair.ratio

    def tooth_deflection(self, pinion: Material, wheel: Material) -> float:
        """Deflection [mm] of one tooth pair that carries the whole load over the whole face."""
        compliance = sum(STEEL_MODULUS / material.youngs_modulus for material in (pinion, wheel)) / 2
        return self.normal_force / self.pair.face_width * compliance / (1e3 * TOOTH_STIFFNESS)
