"""The sections [pair], [pinion] and [wheel]: the geometry of the gears. Every key with a unit has it in its name."""

from __future__ import annotations

from typing import Any, Literal, Self

from pydantic import field_validator, model_validator

from evolvent.scene.schema.errors import InputProblem, shown, validation_error
from evolvent.scene.schema.flank import DERIVED, LONGEST, FlankKeys, length
from evolvent.scene.schema.section import SceneSection, key

LEAST_HELIX = 1e-3
"""Smallest helix angle [°]: 0.3 µm over a face of 20 mm. A gear with less is a spur gear."""
LEAST_ALLOWANCE = 1.0
"""Smallest amount of a tooth thickness allowance [µm]; a smaller number is likely to be in mm."""
ALLOWANCE = f"0, or a number from -15000 to -{LEAST_ALLOWANCE:g}, at most 0.3 m_n, in µm"
EDGE = "0, or a number from 0.03 to 0.3 m_n, in µm"


class PairSection(SceneSection):
    """[pair]: the data that both gears share."""

    normal_module_mm: float = key(
        "normal module m_n",
        "a number from 0.05 to 50, in mm",
        "give the normal (not the transverse) module",
        ge=0.05,
        le=50,
    )
    normal_pressure_angle_deg: float = key(
        "normal pressure angle α_n of the rack", "a number from 10 to 32, in degrees", default=20.0, ge=10, le=32
    )
    helix_angle_deg: float = key(
        "helix angle β at the reference circle, 0 for spur gears",
        f"0, or a number from {LEAST_HELIX:g} to 45, in degrees",
        "give it without a sign and say the direction with pinion.hand",
        default=0.0,
        ge=0,
        le=45,
    )
    centre_distance_mm: float | None = length(
        "centre distance a; by default that of zero backlash", "delete the key for the centre distance without backlash"
    )
    misalignment_um: float = key(
        "opening of the flanks over the face width by misalignment in the plane of action, positive: open at z > 0",
        "a number from -1000 to 1000, in µm over the face width",
        default=0.0,
        ge=-1000,
        le=1000,
    )

    @field_validator("helix_angle_deg")
    @classmethod
    def _helical_or_spur(cls, value: float) -> float:
        if 0.0 < value < LEAST_HELIX:
            allowed = f"0, or a number from {LEAST_HELIX:g} to 45, in degrees"
            raise validation_error(InputProblem("", shown(value), allowed, "give 0 for spur gears"))
        return value


ALTERNATIVES = {
    "tip_diameter_mm": "addendum_coefficient",
    "root_diameter_mm": "dedendum_coefficient",
    "bore_diameter_mm": "rim_thickness_mm",
}
"""Key of a diameter -> key that may be given instead; a rim with a web has a bore, too."""


def _edge(meaning: str) -> Any:
    """Declares the key of a tip edge's chamfer or rounding."""
    return key(meaning, EDGE, default=0.0, ge=0, le=15000)


def _of_rack(meaning: str) -> Any:
    """Declares the key of a coefficient of the basic rack."""
    return key(meaning, "a number from 0.1 to 3, times m_n", default=None, ge=0.1, le=3)


def _offset(meaning: str, width: str) -> Any:
    """Declares the key of an axial position. width: key of the part that lies there."""
    allowed = "a number from -500 to 500, in mm"
    return key(f"{meaning}, from mid-face towards z > 0", allowed, needs=(width,), default=0.0, ge=-500, le=500)


class BodyKeys(SceneSection):
    """Tooth form and body of one gear."""

    teeth: int = key(
        "number of teeth z",
        "a whole number from 5 to 1000",
        "count the teeth; external gears only",
        too_small="fewer than 5 teeth are not supported, nor internal gears, which some count as negative",
        too_large="more than 1000 teeth are not supported",
        ge=5,
        le=1000,
    )
    face_width_mm: float = key("face width b", "a number from 0.1 to 1000, in mm", ge=0.1, le=1000)
    profile_shift: float = key(
        "profile shift coefficient x, times m_n", "a number from -2 to 2", default=0.0, ge=-2, le=2
    )
    tooth_thickness_allowance_um: float = key(
        "tooth thickness allowance A_sn: normal tooth thickness at the reference circle less that of x; half of it is "
        "taken off either flank, the rack cuts at x_E = x + A_sn / (2 m_n tan α_n)",
        ALLOWANCE,
        "give it negative, it makes the tooth thinner",
        default=0.0,
        ge=-15000,
        le=0,
    )
    tip_diameter_mm: float | None = length("tip diameter d_a; else from addendum_coefficient")
    addendum_coefficient: float | None = _of_rack(
        "addendum h_aP* of the basic rack, d_a = d + 2 m_n (h_aP* + x + k), k ≤ 0 the tip alteration coefficient; 1 if "
        "there is no tip_diameter_mm"
    )
    tip_chamfer_um: float = _edge(
        "tip chamfer: its radial height h_K, d_Fa = d_a − 2 h_K is the tip form diameter; at 45° to the radius there, "
        "in the transverse section"
    )
    tip_rounding_um: float = _edge(
        "tip rounding: radius of the arc between involute and tip circle in the transverse section; the involute ends "
        "at the tip form diameter d_Fa where it begins"
    )
    root_diameter_mm: float | None = length("root diameter d_f; else from dedendum_coefficient")
    dedendum_coefficient: float | None = _of_rack(
        "dedendum h_fP* of the basic rack, d_f = d − 2 m_n (h_fP* − x_E); 1.25 if there is no root_diameter_mm"
    )
    rack_tip_radius_mm: float | None = key(
        "root fillet radius ρ_fP of the basic rack: tip radius of the generating rack in its normal section; 0.38 m_n, "
        "or the full round if that is less",
        "a number from 0 to 1e6, in mm",
        "delete the key for the default",
        default=None,
        ge=0,
        le=LONGEST,
    )
    protuberance_um: float = key(
        "residual protuberance s_pr = pr − q of the generating rack: by how much its tip cuts deeper than its flank, "
        "less the machining allowance q that is taken off later",
        "a number from 0 to 5000, at most 0.1 m_n, in µm",
        default=0.0,
        ge=0,
        le=5000,
    )
    hand: Literal["right", "left"] | None = key(
        "direction of the helix; the pinion's is right by default, the wheel's the other one",
        '"right" or "left"',
        "delete the key for the default",
        needs=("pair.helix_angle_deg",),
        default=None,
    )
    bore_diameter_mm: float | None = length(
        "diameter of the bore, where the gear sits rigidly on its shaft; half of the root diameter by default", DERIVED
    )
    rim_thickness_mm: float | None = length(
        "thickness s_R of a rim below the root circle, on a web; without web_thickness_mm it is in place of the bore, "
        "held rigidly at its inside, web and hub are left out",
        "delete the key for a gear with a bore",
    )
    web_thickness_mm: float | None = length(
        "axial thickness b_s of the web, a disc from the rim, rim_thickness_mm, to the hub or the bore; by default the "
        "body is as wide as the face",
        "delete the key for a full ring", ("rim_thickness_mm",),
    )
    web_offset_mm: float = _offset("axial position of the web's middle", "web_thickness_mm")
    hub_diameter_mm: float | None = length(
        "outer diameter of the hub, which is as wide as the face; by default the web reaches the bore, which is held "
        "over its thickness",
        "delete the key for a web that reaches the bore", ("web_thickness_mm",),
    )
    support_width_mm: float | None = length(
        "axial length over which the bore is held, for a shaft through a part of the face; by default the whole face",
        DERIVED,
    )
    support_offset_mm: float = _offset("axial position of the middle of that length", "support_width_mm")

    @field_validator("tooth_thickness_allowance_um")
    @classmethod
    def _in_micrometres(cls, value: float) -> float:
        if -LEAST_ALLOWANCE < value < 0.0:
            remedy = f"give it in µm: {1e3 * value:g} where {value:g} mm is meant"
            raise validation_error(InputProblem("", shown(value), ALLOWANCE, remedy))
        return value

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        for first, second in ALTERNATIVES.items():
            one, two = getattr(self, first), getattr(self, second)
            has_both = second == "rim_thickness_mm" and self.web_thickness_mm is not None
            if one is not None and two is not None and not has_both:
                found = f"{shown(one)} and also {second} = {shown(two)}"
                raise validation_error(InputProblem(first, found, "one of the two", f"delete {first} or {second}"))
        return self


class GearSection(FlankKeys, BodyKeys):
    """[pinion] and [wheel]: one gear."""
