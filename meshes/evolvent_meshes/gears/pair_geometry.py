"""Geometry of a gear pair: two gears and the position of their axes, and the quantities that follow from them.

Symbols are those of ISO 21771:2007 (external cylindrical involute gears, parallel axes), whose clause is in brackets
after each quantity. Lengths are in mm and angles in rad, unless a name says otherwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.errors import require
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.gear_geometry import involute_function


def tip_alteration(shifts: float, spread: float, normal_module: float) -> float:
    """Tip alteration coefficient k = (a − a_0)/m_n − (x_1 + x_2) that keeps the tip clearance of the basic racks; 0
    where that is positive: the clearance is larger there, and tips are not made longer.

    shifts: x_1 + x_2.
    spread: a − a_0, centre distance less that of the reference circles [mm].
    normal_module: m_n [mm].
    """
    return min(0.0, spread / normal_module - shifts)


@dataclass(frozen=True)
class PairGeometry:
    """Data of a pinion that drives a wheel, not checked; `pair.GearPair` is a pair that can run.

    pinion: the driving gear.
    wheel: the driven gear.
    centre_distance: a, of the axes [mm].
    misalignment_um: deviation of the wheel's axis in the plane of action over the common face width [µm]; a positive
        one opens the gap of the loaded flanks towards +z.
    """

    pinion: GearParameters
    wheel: GearParameters
    centre_distance: float
    misalignment_um: float = 0.0

    @property
    def gears(self) -> tuple[GearParameters, GearParameters]:
        """Both gears (pinion, wheel)."""
        return self.pinion, self.wheel

    @property
    def ratio(self) -> float:
        """Gear ratio u = z_2 / z_1 [5.2.1]."""
        return self.wheel.z / self.pinion.z

    @property
    def face_width(self) -> float:
        """Common face width b_w; the wider gear projects equally on both sides."""
        return min(self.pinion.face_width, self.wheel.face_width)

    @cached_property
    def working_pressure_angle(self) -> float:
        """Working transverse pressure angle α_wt, cos α_wt = (r_b1 + r_b2) / a [5.2.4]."""
        return math.acos((self.pinion.base_radius + self.wheel.base_radius) / self.centre_distance)

    @property
    def tight_pressure_angle(self) -> float:
        """Working pressure angle α_wt without backlash, inv α_wt = inv α_t + 2 tan α_n (x_1 + x_2)/(z_1 + z_2) [5.2.4].

        Raises GeometryError if the profile shifts are so negative that there is none.
        """
        gear, shift = self.pinion, self.pinion.profile_shift + self.wheel.profile_shift
        rise = 2.0 * math.tan(gear.normal_pressure_angle) * shift / (self.pinion.z + self.wheel.z)
        target = involute_function(gear.transverse_pressure_angle) + rise
        require(target >= 0.0, "profile_shift", shift, "a sum that leaves a tight mesh", "Raise the profile shifts.")
        return float(brentq(lambda angle: involute_function(angle) - target, 0.0, 1.5, xtol=1e-15))

    @property
    def tight_centre_distance(self) -> float:
        """Centre distance without backlash, (r_b1 + r_b2) / cos α_wt [5.2.4]. Raises GeometryError if there is none."""
        return (self.pinion.base_radius + self.wheel.base_radius) / math.cos(self.tight_pressure_angle)

    @property
    def working_pitch_diameters(self) -> tuple[float, float]:
        """Working pitch diameters (d_w1, d_w2) = d_b / cos α_wt [5.2.5]."""
        cosine = math.cos(self.working_pressure_angle)
        return self.pinion.base_diameter / cosine, self.wheel.base_diameter / cosine

    @cached_property
    def pitch_point_roll_lengths(self) -> tuple[float, float]:
        """Transverse radii of curvature (ρ_C1, ρ_C2) = r_b tan α_wt at the pitch point [5.4.5.3]."""
        tangent = math.tan(self.working_pressure_angle)
        return self.pinion.base_radius * tangent, self.wheel.base_radius * tangent

    @cached_property
    def path_of_contact(self) -> tuple[float, float]:
        """Roll distances (ξ_A, ξ_E) at the start (wheel tip) and end (pinion tip) of the path of contact [5.4.5.2]."""
        pitch_1, pitch_2 = self.pitch_point_roll_lengths
        start = pitch_2 - self.wheel.roll_length(self.wheel.tip_form_diameter)
        return start, self.pinion.roll_length(self.pinion.tip_form_diameter) - pitch_1

    @property
    def transverse_contact_ratio(self) -> float:
        """Transverse contact ratio ε_α = g_α / p_et [5.4.7.1]."""
        start, end = self.path_of_contact
        return (end - start) / self.pinion.transverse_base_pitch

    @property
    def overlap_ratio(self) -> float:
        """Overlap ratio ε_β = b_w sin β / π m_n [5.4.7.3]."""
        return self.face_width * math.sin(self.pinion.helix_angle) / (math.pi * self.pinion.normal_module)

    @property
    def total_contact_ratio(self) -> float:
        """Total contact ratio ε_γ = ε_α + ε_β [5.4.7.5]."""
        return self.transverse_contact_ratio + self.overlap_ratio

    @property
    def engagement_angle(self) -> float:
        """Total angle of transmission of the pinion: its rotation during the engagement of one tooth, ε_γ 2π/z_1."""
        return self.total_contact_ratio * 2.0 * math.pi / self.pinion.z

    @property
    def active_start_diameters(self) -> tuple[float, float]:
        """Start of active profile diameters (d_Nf1, d_Nf2): the mate's tip reaches no deeper [5.4.1]."""
        start, end = self.path_of_contact
        pitch_1, pitch_2 = self.pitch_point_roll_lengths
        pinion, wheel = self.pinion.base_radius, self.wheel.base_radius
        return 2.0 * math.hypot(pinion, pitch_1 + start), 2.0 * math.hypot(wheel, pitch_2 - end)

    @property
    def tip_alteration_coefficient(self) -> float:
        """Tip alteration coefficient k ≤ 0 that keeps the tip clearance of the basic racks [4.5.2]."""
        reference = (self.pinion.reference_diameter + self.wheel.reference_diameter) / 2.0
        shifts = self.pinion.profile_shift + self.wheel.profile_shift
        return tip_alteration(shifts, self.centre_distance - reference, self.pinion.normal_module)

    @property
    def addendum_coefficients(self) -> tuple[float, float]:
        """Addendum coefficients (h_aP1*, h_aP2*) of the basic racks, from d_a = d + 2 m_n (h_aP* + x + k)."""
        k = self.tip_alteration_coefficient
        return self.pinion.tip_coefficient - k, self.wheel.tip_coefficient - k

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Tip clearances of pinion tip to wheel root and wheel tip to pinion root [5.2.7]."""
        first = self.centre_distance - (self.pinion.tip_diameter + self.wheel.root_diameter) / 2.0
        return first, self.centre_distance - (self.wheel.tip_diameter + self.pinion.root_diameter) / 2.0

    @property
    def circumferential_backlash(self) -> float:
        """Circumferential backlash j_wt = p_wt − s_w1 − s_w2 on the working pitch circles."""
        pitch_1, pitch_2 = self.working_pitch_diameters
        thickness = self.pinion.transverse_thickness(pitch_1) + self.wheel.transverse_thickness(pitch_2)
        return math.pi * pitch_1 / self.pinion.z - thickness

    @property
    def normal_backlash(self) -> float:
        """Normal backlash j_bn = j_wt cos α_wt cos β_b."""
        cosines = math.cos(self.working_pressure_angle) * math.cos(self.pinion.base_helix_angle)
        return self.circumferential_backlash * cosines

    def curvature_radii(self, roll_distance: ArrayLike) -> tuple[Floats, Floats]:
        """Transverse radii of curvature (ρ_1, ρ_2) (…) [mm] of the flanks at roll distances ξ (…) [mm] [5.4.5.3]."""
        xi = np.asarray(roll_distance, dtype=float)
        pitch_1, pitch_2 = self.pitch_point_roll_lengths
        return pitch_1 + xi, pitch_2 - xi

    def specific_sliding(self, roll_distance: ArrayLike) -> tuple[Floats, Floats]:
        """Specific sliding ζ_1 = 1 − v_2/v_1 and ζ_2 = 1 − v_1/v_2 (…) at roll distances ξ (…) [mm], with v = ωρ."""
        rho_1, rho_2 = self.curvature_radii(roll_distance)
        v_1, v_2 = self.ratio * rho_1, rho_2
        return 1.0 - v_2 / v_1, 1.0 - v_1 / v_2

    def normal_curvature_radii(self, roll_distance: ArrayLike) -> tuple[Floats, Floats]:
        """Radii of curvature across the contact line, ρ / cos β_b (…) [mm], at roll distances ξ (…) [mm]."""
        rho_1, rho_2 = self.curvature_radii(roll_distance)
        cosine = math.cos(self.pinion.base_helix_angle)
        return rho_1 / cosine, rho_2 / cosine

    def relative_curvature_radius(self, roll_distance: ArrayLike) -> Floats:
        """Relative radius of curvature ρ_n1 ρ_n2 / (ρ_n1 + ρ_n2) (…) [mm] across the contact line, at ξ (…) [mm]."""
        rho_1, rho_2 = self.normal_curvature_radii(roll_distance)
        return np.asarray(rho_1 * rho_2 / (rho_1 + rho_2))

    def roll_distance(self, rotation: ArrayLike, tooth: ArrayLike = 0, z: ArrayLike = 0.0) -> Floats:
        """Roll distance ξ = r_b1(φ + 2πi/z_1) + hand_1 z tan β_b (…) [mm] of tooth pair i at z [mm] and pinion rotation
        φ [rad]."""
        angle = np.asarray(rotation, dtype=float) + 2.0 * math.pi * np.asarray(tooth) / self.pinion.z
        return np.asarray(self.pinion.base_radius * (angle + self.pinion.twist * np.asarray(z, dtype=float)))

    def teeth_in_contact(self, rotation: float) -> list[int]:
        """Indices i, ascending, of the tooth pairs with a contact line at pinion rotation φ [rad]."""
        start, end = self.path_of_contact
        reach = self.face_width / 2.0 * math.tan(self.pinion.base_helix_angle)
        pitch = self.pinion.transverse_base_pitch
        here = self.pinion.base_radius * rotation
        return list(range(math.ceil((start - reach - here) / pitch), math.floor((end + reach - here) / pitch) + 1))

    def contact_line_length(self, rotation: float) -> float:
        """Total length [mm] of the contact lines at pinion rotation φ [rad], for rigid flanks without modifications.

        Its mean over a pitch is ε_α b_w / cos β_b.
        """
        start, end = self.path_of_contact
        half_width, angle = self.face_width / 2.0, self.pinion.base_helix_angle
        xi = self.roll_distance(rotation, np.array(self.teeth_in_contact(rotation)))
        if angle == 0.0:
            return self.face_width * xi.size
        low = np.maximum((start - xi) / math.tan(angle), -half_width)
        high = np.minimum((end - xi) / math.tan(angle), half_width)
        return float((high - low).sum()) / math.cos(angle)
