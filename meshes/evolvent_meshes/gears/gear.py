"""A gear whose data have been checked."""

from __future__ import annotations

import math
from dataclasses import dataclass

from evolvent_meshes.gears.errors import require_numbers
from evolvent_meshes.gears.form.support import Support
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.gear_geometry import GearGeometry, thickness_shift
from evolvent_meshes.gears.gear_limits import check_angles, check_gear, check_teeth
from evolvent_meshes.gears.modifications.modifications import Modifications

RACK_TIP_RADIUS = 0.38
"""Tip radius ρ_fP* of the basic rack of ISO 53, profile A."""


def usual_rack_tip_radius(normal_module: float, normal_pressure_angle: float, dedendum_coefficient: float) -> float:
    """Rack tip radius ρ_fP [mm] of ISO 53, profile A, or of a fully rounded rack tooth if that is less, for h_fP* and
    α_n [rad]."""
    half_tip = math.pi / 4.0 - dedendum_coefficient * math.tan(normal_pressure_angle)
    full_round = half_tip * math.cos(normal_pressure_angle) / (1.0 - math.sin(normal_pressure_angle))
    return normal_module * max(0.0, min(RACK_TIP_RADIUS, (1.0 - 1e-9) * full_round))


@dataclass(frozen=True, kw_only=True)
class GearParameters(GearGeometry):
    """An external involute gear that can be cut by its rack; fields and properties are those of `GearGeometry`,
    and where it is held.

    Raises GeometryError if no such gear can be cut.
    """

    def __post_init__(self) -> None:
        check_gear(self)

    @property
    def held_ends(self) -> tuple[float, float]:
        """Heights z [mm] of the ends of the part of the bore that is held: the support, or a web that reaches it."""
        if (web := self.thin_web) is not None and web.hub_diameter is None:
            return web.ends
        return self.support.ends(self.face_width)

    @classmethod
    def from_rack(
        cls,
        *,
        z: int,
        normal_module: float,
        normal_pressure_angle_deg: float,
        addendum_coefficient: float = 1.0,
        dedendum_coefficient: float = 1.25,
        rack_tip_radius_coefficient: float | None = None,
        protuberance_um: float = 0.0,
        tip_shortening_coefficient: float = 0.0,
        tip_chamfer_um: float = 0.0,
        tip_rounding_um: float = 0.0,
        face_width: float,
        bore_diameter: float,
        support: Support | None = None,
        web: Web | None = None,
        helix_angle_deg: float = 0.0,
        profile_shift: float = 0.0,
        tooth_thickness_allowance_um: float = 0.0,
        hand: int = 1,
        modifications: Modifications | None = None,
    ) -> GearParameters:
        """A gear from the coefficients of its basic rack, which are multiples of m_n: d_a = d + 2 m_n (h_aP* + x + k),
        d_f = d − 2 m_n (h_fP* − x_E), ISO 21771:2007, 4.5; x_E is x but for a tooth thickness allowance.

        addendum_coefficient: h_aP*.
        dedendum_coefficient: h_fP*.
        rack_tip_radius_coefficient: ρ_fP*; by default that of `usual_rack_tip_radius`.
        tip_shortening_coefficient: −k, the negative of the tip alteration coefficient.
        The other parameters are the fields of `GearGeometry`. Raises GeometryError if no such gear can be cut.

        >>> gear = GearParameters.from_rack(
        ...     z=30, normal_module=2.0, normal_pressure_angle_deg=20.0, profile_shift=0.2, face_width=10.0,
        ...     bore_diameter=20.0,
        ... )
        >>> print(f"tip {gear.tip_diameter:.1f} mm, root {gear.root_diameter:.1f} mm")
        tip 64.8 mm, root 55.8 mm
        """
        check_teeth(z)
        require_numbers(
            normal_module=normal_module, normal_pressure_angle_deg=normal_pressure_angle_deg,
            addendum_coefficient=addendum_coefficient, dedendum_coefficient=dedendum_coefficient,
            tip_shortening_coefficient=tip_shortening_coefficient, helix_angle_deg=helix_angle_deg,
            profile_shift=profile_shift, tooth_thickness_allowance_um=tooth_thickness_allowance_um,
        )
        if rack_tip_radius_coefficient is not None:
            require_numbers(rack_tip_radius_coefficient=rack_tip_radius_coefficient)
        check_angles(normal_pressure_angle_deg, helix_angle_deg)
        d = z * normal_module / math.cos(math.radians(helix_angle_deg))
        addendum = addendum_coefficient + profile_shift - tip_shortening_coefficient
        angle = math.radians(normal_pressure_angle_deg)
        rounded = (
            usual_rack_tip_radius(normal_module, angle, dedendum_coefficient)
            if rack_tip_radius_coefficient is None
            else rack_tip_radius_coefficient * normal_module
        )
        generating = profile_shift + thickness_shift(tooth_thickness_allowance_um, normal_module, angle)
        return cls(
            z=z,
            normal_module=normal_module,
            normal_pressure_angle_deg=normal_pressure_angle_deg,
            helix_angle_deg=helix_angle_deg,
            profile_shift=profile_shift,
            tooth_thickness_allowance_um=tooth_thickness_allowance_um,
            face_width=face_width,
            tip_diameter=d + 2.0 * normal_module * addendum,
            tip_chamfer_um=tip_chamfer_um,
            tip_rounding_um=tip_rounding_um,
            root_diameter=d - 2.0 * normal_module * (dedendum_coefficient - generating),
            rack_tip_radius=rounded,
            protuberance_um=protuberance_um,
            hand=hand,
            bore_diameter=bore_diameter,
            support=Support() if support is None else support,
            web=web,
            modifications=Modifications() if modifications is None else modifications,
        )
