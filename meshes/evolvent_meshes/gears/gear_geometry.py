"""Geometry of one gear: its data, and the quantities that follow from them.

Symbols are those of ISO 21771:2007 (external cylindrical involute gears, parallel axes), whose clause is in brackets
after each quantity. Lengths are in mm and angles in rad, unless a name says otherwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.form.rack_tip import PROTUBERANCE_ANGLE, RackTip
from evolvent_meshes.gears.form.support import Support
from evolvent_meshes.gears.form.tip_edge import TipEdge
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.modifications.flank_depth import FlankDepth
from evolvent_meshes.gears.modifications.modifications import Modifications


def involute_function(angle: float) -> float:
    """Involute function inv α = tan α − α [4.3.9], angle in rad."""
    return math.tan(angle) - angle


def thickness_shift(allowance_um: float, normal_module: float, normal_pressure_angle: float) -> float:
    """Profile shift x_E − x = A_sn / (2 m_n tan α_n) of a tooth thickness allowance [µm]; m_n [mm], α_n [rad]."""
    return 1e-3 * allowance_um / (2.0 * normal_module * math.tan(normal_pressure_angle))


@dataclass(frozen=True, kw_only=True)
class GearGeometry:
    """Data of one external involute gear, not checked; `gear.GearParameters` is a gear that can be cut.

    z: number of teeth.
    normal_module: m_n [mm].
    normal_pressure_angle_deg: α_n [°].
    helix_angle_deg: β at the reference cylinder, not negative [°].
    profile_shift: coefficient x.
    tooth_thickness_allowance_um: A_sn, normal tooth thickness at the reference circle less that of x, not positive;
        either flank lies half of it deeper [µm].
    face_width: b [mm].
    tip_diameter: d_a [mm].
    root_diameter: d_f [mm].
    tip_chamfer_um: radial height of a chamfer between flank and tip circle, transverse section; 0: none [µm].
    tip_rounding_um: radius of a rounding in its place; 0: none [µm].
    rack_tip_radius: ρ_fP, root fillet radius of the basic rack: tip radius of the generating rack, normal section [mm].
    protuberance_um: s_pr, by which a protuberance of the rack's tip cuts deeper than its flank, less the machining
        allowance that is left on the flank and taken off later [µm].
    hand: of the helix, +1 right, −1 left; without effect for a spur gear.
    bore_diameter: of the bore, at which the gear is held [mm].
    support: how it is held there.
    web: the disc between rim and hub; None: the body is a full ring.
    modifications: of the loaded flank.
    """

    z: int
    normal_module: float
    normal_pressure_angle_deg: float
    helix_angle_deg: float = 0.0
    profile_shift: float = 0.0
    tooth_thickness_allowance_um: float = 0.0
    face_width: float
    tip_diameter: float
    tip_chamfer_um: float = 0.0
    tip_rounding_um: float = 0.0
    root_diameter: float
    rack_tip_radius: float
    protuberance_um: float = 0.0
    hand: int = 1
    bore_diameter: float
    support: Support = field(default_factory=Support)
    web: Web | None = None
    modifications: Modifications = field(default_factory=Modifications)

    @property
    def helix_angle(self) -> float:
        """Helix angle β at the reference cylinder, not negative."""
        return math.radians(self.helix_angle_deg)

    @property
    def normal_pressure_angle(self) -> float:
        """Normal pressure angle α_n [4.3.6]."""
        return math.radians(self.normal_pressure_angle_deg)

    @property
    def transverse_module(self) -> float:
        """Transverse module m_t = m_n / cos β [4.2.7]."""
        return self.normal_module / math.cos(self.helix_angle)

    @cached_property
    def transverse_pressure_angle(self) -> float:
        """Transverse pressure angle α_t, tan α_t = tan α_n / cos β [4.3.6]."""
        return math.atan(math.tan(self.normal_pressure_angle) / math.cos(self.helix_angle))

    @property
    def reference_diameter(self) -> float:
        """Reference diameter d = z m_t [4.2.4]."""
        return self.z * self.transverse_module

    @property
    def base_diameter(self) -> float:
        """Base diameter d_b = d cos α_t [4.3.10]."""
        return self.reference_diameter * math.cos(self.transverse_pressure_angle)

    @cached_property
    def base_radius(self) -> float:
        """Base radius r_b = d_b / 2."""
        return self.base_diameter / 2.0

    @cached_property
    def base_helix_angle(self) -> float:
        """Base helix angle β_b ≥ 0, sin β_b = sin β cos α_n [4.3.3]."""
        return math.asin(math.sin(self.helix_angle) * math.cos(self.normal_pressure_angle))

    @property
    def virtual_teeth(self) -> float:
        """Virtual number of teeth z_n = z / (cos² β_b cos β) of the spur gear in the normal section (ISO 6336)."""
        return self.z / (math.cos(self.base_helix_angle) ** 2 * math.cos(self.helix_angle))

    @property
    def transverse_base_pitch(self) -> float:
        """Transverse base pitch p_bt = π m_t cos α_t [4.4.5]."""
        return math.pi * self.base_diameter / self.z

    @cached_property
    def twist(self) -> float:
        """Rotation of the transverse section about +z per mm of z [rad/mm], hand·tan β / (d/2) = hand·tan β_b / r_b."""
        return self.hand * math.tan(self.base_helix_angle) / self.base_radius

    @cached_property
    def tip_form_diameter(self) -> float:
        """Tip form diameter d_Fa, at which the involute ends: d_a, or where a chamfer or a rounding begins [4.5].

        A rounding of radius R touches the tip circle from within and the involute at its roll length ρ_Fa: its centre
        lies on the normal there, (ρ_Fa − R)² + r_b² = (r_a − R)². The base diameter where there is none.
        """
        if not self.tip_rounding_um:
            return self.tip_diameter - 2e-3 * self.tip_chamfer_um
        radius = 1e-3 * self.tip_rounding_um
        centre = max(self.tip_diameter / 2.0 - radius, self.base_radius)
        along = math.sqrt(centre**2 - self.base_radius**2)
        return 2.0 * math.hypot(self.base_radius, radius + along) if along else self.base_diameter

    @cached_property
    def tip_edge(self) -> TipEdge | None:
        """Chamfer or rounding of the tip at θ > 0; None of a sharp one."""
        form = self.tip_form_diameter / 2.0, self.half_angle(self.tip_form_diameter)
        if self.tip_rounding_um:
            return TipEdge.rounded(form, self.tip_diameter / 2.0, self.base_radius, 1e-3 * self.tip_rounding_um)
        return TipEdge.chamfered(form, self.tip_diameter / 2.0) if self.tip_chamfer_um else None

    @property
    def thin_web(self) -> Web | None:
        """The web where it is thinner than the face; None of a full ring."""
        return self.web if self.web is not None and self.web.is_thinner(self.face_width) else None

    @property
    def has_rim(self) -> bool:
        """Whether the teeth stand on a rim, held at its inside or carried by a web."""
        return self.support.is_rim or self.thin_web is not None

    @property
    def rim_thickness(self) -> float:
        """Rim thickness s_R: of the rim that a web carries, else from the bore to the root circle."""
        web = self.thin_web
        return (self.root_diameter - self.bore_diameter) / 2.0 if web is None else web.rim_thickness

    @property
    def web_diameters(self) -> tuple[float, float]:
        """Outer and inner diameter of the web, both the bore's of a full ring."""
        if (web := self.thin_web) is None:
            return self.bore_diameter, self.bore_diameter
        inner = self.bore_diameter if web.hub_diameter is None else web.hub_diameter
        return self.root_diameter - 2.0 * web.rim_thickness, inner

    @property
    def tip_coefficient(self) -> float:
        """Addendum plus tip alteration coefficient h_aP* + k = (d_a − d) / 2m_n − x; k is known in a pair [4.5.3]."""
        return (self.tip_diameter - self.reference_diameter) / (2.0 * self.normal_module) - self.profile_shift

    @property
    def dedendum_coefficient(self) -> float:
        """Dedendum coefficient of the basic rack h_fP* = (d − d_f) / 2m_n + x_E [4.5]."""
        return (self.reference_diameter - self.root_diameter) / (2.0 * self.normal_module) + self.generating_shift

    @property
    def generating_shift(self) -> float:
        """Generating profile shift coefficient x_E = x + A_sn / (2 m_n tan α_n): that of the rack which cuts the tooth
        with its thickness allowance [7.5]."""
        module, angle = self.normal_module, self.normal_pressure_angle
        return self.profile_shift + thickness_shift(self.tooth_thickness_allowance_um, module, angle)

    @property
    def tooth_half_angle(self) -> float:
        """Tooth thickness half angle ψ = (π + 4 x_E tan α_n) / 2z at the reference circle [4.7.2]."""
        return (math.pi + 4.0 * self.generating_shift * math.tan(self.normal_pressure_angle)) / (2.0 * self.z)

    @cached_property
    def base_half_angle(self) -> float:
        """Tooth thickness half angle ψ_b = ψ + inv α_t at the base circle [4.7.2]."""
        return self.tooth_half_angle + involute_function(self.transverse_pressure_angle)

    def half_angle(self, diameter: float) -> float:
        """Tooth thickness half angle ψ_y at a diameter d_y ≥ d_b: polar angle of the flank θ > 0 at mid-face [4.7.2].

        Negative beyond the diameter at which the tooth is pointed.
        """
        return self.base_half_angle - involute_function(math.acos(min(1.0, self.base_diameter / diameter)))

    def transverse_thickness(self, diameter: float) -> float:
        """Transverse tooth thickness s_yt = d_y ψ_y at a diameter d_y [4.7.1]."""
        return diameter * self.half_angle(diameter)

    def normal_thickness(self, diameter: float) -> float:
        """Normal tooth thickness s_yn = s_yt cos β_y at a diameter d_y; tan β_y = tan β d_y/d [4.7.5, 4.3.3]."""
        helix = math.atan(math.tan(self.helix_angle) * diameter / self.reference_diameter)
        return self.transverse_thickness(diameter) * math.cos(helix)

    def roll_length(self, diameter: float) -> float:
        """Roll length ρ_y = √(d_y² − d_b²) / 2: transverse radius of curvature at a diameter d_y [4.3.8]."""
        return math.sqrt(max(0.0, diameter**2 - self.base_diameter**2)) / 2.0

    @cached_property
    def flank_depth(self) -> FlankDepth:
        """Depth of the loaded flank's modifications."""
        control, tip = self.modifications.profile_control_diameter, self.roll_length(self.tip_form_diameter)
        start = self.rack_form_roll_length if control is None else self.roll_length(control)
        return FlankDepth(self.modifications, self.base_radius, start, tip, self.face_width)

    @property
    def rack_flank_roll_length(self) -> float:
        """Roll length at which the straight flank of a rack without protuberance ends; negative: it undercuts [7.6].

        The straight flank ends h = (d − d_f)/2 − ρ_fP(1 − sin α_n) below the pitch line; the line of action is there at
        the distance h / sin α_t before the pitch point.
        """
        depth = (self.reference_diameter - self.root_diameter) / 2.0
        depth -= self.rack_tip_radius * (1.0 - math.sin(self.normal_pressure_angle))
        angle = self.transverse_pressure_angle
        return self.reference_diameter / 2.0 * math.sin(angle) - depth / math.sin(angle)

    @property
    def is_undercut(self) -> bool:
        """Whether the rack takes a part of the involute away above the base circle."""
        return self.rack_flank_roll_length <= 0.0

    @property
    def rack_tip(self) -> RackTip:
        """The tip of the generating rack."""
        angle, share = self.normal_pressure_angle, PROTUBERANCE_ANGLE if self.protuberance_um else 1.0
        depth = (self.reference_diameter - self.root_diameter) / 2.0
        return RackTip(
            self.rack_tip_half_land, self.rack_tip_radius - depth, self.rack_tip_radius, share * angle,
            self.reference_diameter / 2.0, math.pi / self.z, math.cos(self.helix_angle),
        )

    @cached_property
    def form_direction(self) -> float | None:
        """Direction of the point of the rack's tip that cuts the end of the fillet, where the involute begins; None
        where they do not meet."""
        if not (self.protuberance_um or self.is_undercut):
            return self.normal_pressure_angle
        tip = self.rack_tip
        highest = tip.pitch_line if self.protuberance_um else tip.straight
        return tip.crossing(highest, self.base_radius, self._involute_angles)

    def _involute_angles(self, radius: Floats) -> Floats:
        """Polar angles θ (n,) at radii (n,) of the flank θ > 0 at mid-face."""
        tangent = np.sqrt(np.maximum(radius**2 - self.base_radius**2, 0.0)) / self.base_radius
        return np.asarray(self.base_half_angle - (tangent - np.arctan(tangent)))

    @cached_property
    def rack_form_roll_length(self) -> float:
        """Roll length ρ_Ff at the root form circle, where fillet and involute meet; NaN where they do not [7.6]."""
        if not (self.protuberance_um or self.is_undercut):
            return self.rack_flank_roll_length
        direction = self.form_direction
        return math.nan if direction is None else self.roll_length(2.0 * float(self.rack_tip.generated(direction)[0]))

    @property
    def root_form_diameter(self) -> float:
        """Root form diameter d_Ff, at which fillet and involute meet [7.6]."""
        return 2.0 * math.hypot(self.base_radius, self.rack_form_roll_length)

    @property
    def rack_tip_half_land(self) -> float:
        """Half the width of the flat land at the rack's tip, normal section; 0: the tip is a full round.

        The tip circle (radius ρ_fP, lowest point (d − d_f)/2 below the pitch line) is tangent to the straight flank of
        the rack, or with protuberance to a line s_pr outside it. The flank is half a space width from the centre line
        of the rack tooth at the pitch line.
        """
        angle, radius = self.normal_pressure_angle, self.rack_tip_radius
        half_space = self.normal_module * (math.pi / 4.0 - self.generating_shift * math.tan(angle))
        centre = radius - (self.reference_diameter - self.root_diameter) / 2.0
        return half_space + centre * math.tan(angle) - (radius - 1e-3 * self.protuberance_um) / math.cos(angle)
