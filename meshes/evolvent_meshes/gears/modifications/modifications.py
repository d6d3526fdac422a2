"""Amounts of the modifications of a loaded flank.

Names and symbols are those of ISO 21771:2007 (flank modifications). Every amount is material that is taken off. A slope
or twist with a negative sign takes it off at the opposite end or corners; nothing is ever added to the evaluated flank.
That fixes how far the flank lies behind the involute helicoid as a whole, which is only a rotation of the gear.

A measured slope deviation of ISO 1328-1:2013 has the sign of the angle, and is measured in the transverse plane: f_Hα
is positive where material increases towards the tip, C_Hα = −f_Hα cos β_b; f_Hβ is positive where the helix angle is
larger, C_Hβ = −f_Hβ cos β_b on the loaded flank of a right-hand gear and +f_Hβ cos β_b on that of a left-hand one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

AMOUNTS: Mapping[str, tuple[str, str]] = {
    "tip_relief_um": ("tip relief", "C_αa"),
    "root_relief_um": ("root relief", "C_αf"),
    "profile_crowning_um": ("profile crowning", "C_α"),
    "profile_slope_um": ("profile slope", "C_Hα"),
    "lead_crowning_um": ("lead crowning", "C_β"),
    "helix_slope_um": ("helix slope", "C_Hβ"),
    "end_relief_um": ("end relief", "C_βI,II"),
    "twist_um": ("twist", "S_α"),
}
"""Fields of `Modifications` that are amounts [µm] -> term and symbol."""
SIGNED = ("profile_slope_um", "helix_slope_um", "twist_um")
"""Amounts of `Modifications` that may be negative."""
OVER_FACE = ("lead_crowning_um", "helix_slope_um", "end_relief_um", "twist_um")
"""Amounts of `Modifications` that vary over the face, so that transverse sections differ."""
FROM_CONTROL_DIAMETER = ("root_relief_um", "profile_crowning_um", "profile_slope_um", "twist_um")
"""Amounts of `Modifications` that are measured from the profile control diameter on."""


@dataclass(frozen=True)
class Modifications:
    """Modifications of the loaded flank: material removed, measured normal to the exact involute helicoid.

    tip_relief_um: C_αa, tip relief at the tip form circle [µm].
    tip_relief_start_diameter: diameter at which the tip relief starts [mm]; None without tip relief.
    tip_relief_parabolic: whether it grows with the square of the roll length from there, instead of linearly.
    lead_crowning_um: C_β, crowning at both ends of the face width [µm], a parabola of z that is 0 at mid-face.
    profile_crowning_um: C_α, crowning at the tip form circle and at the profile control diameter [µm], a parabola of
        the roll length that is 0 midway.
    profile_slope_um: C_Hα, at the tip form circle [µm], linear in the roll length from 0 at the profile control
        diameter; negative: there, from 0 at the tip form circle. Positive is a larger pressure angle.
    helix_slope_um: C_Hβ, at the end z = b/2 of the face [µm], linear in z from 0 at the other one; negative: at the end
        z = −b/2.
    end_relief_um: C_βI = C_βII, end relief at both ends of the face [µm].
    end_relief_length: length of either end relief [mm]; None without end relief.
    end_relief_parabolic: whether it grows with the square of z, instead of linearly.
    root_relief_um: C_αf, root relief at the profile control diameter [µm].
    root_relief_end_diameter: diameter at which the root relief ends, above which there is none [mm]; None without it.
    root_relief_parabolic: whether it grows with the square of the roll length from there, instead of linearly.
    twist_um: S_α, profile slope at z = b/2 less that at z = −b/2 [µm]. Half of it is removed at the tip's end z = b/2
        and where the profile control diameter ends at z = −b/2, 0 at the two other corners; negative: the other way.
    profile_control_diameter: d_Cf of ISO 1328-1, where the evaluated profile begins, which ends at the tip form circle
        [mm]; None: the root form circle. Below it all modifications go on as they are above.
    """

    tip_relief_um: float = 0.0
    tip_relief_start_diameter: float | None = None
    tip_relief_parabolic: bool = False
    lead_crowning_um: float = 0.0
    profile_crowning_um: float = 0.0
    profile_slope_um: float = 0.0
    helix_slope_um: float = 0.0
    end_relief_um: float = 0.0
    end_relief_length: float | None = None
    end_relief_parabolic: bool = False
    root_relief_um: float = 0.0
    root_relief_end_diameter: float | None = None
    root_relief_parabolic: bool = False
    twist_um: float = 0.0
    profile_control_diameter: float | None = None

    @property
    def amounts(self) -> dict[str, float]:
        """Field -> amount [µm], of those that are not 0."""
        given = {name: float(getattr(self, name)) for name in AMOUNTS}
        return {name: amount for name, amount in given.items() if amount}

    @property
    def is_empty(self) -> bool:
        """Whether the flank is the involute helicoid without modifications."""
        return not self.amounts

    @property
    def varies_over_the_face(self) -> bool:
        """Whether transverse sections differ in more than rotation."""
        return not self.amounts.keys().isdisjoint(OVER_FACE)

    def only(self, name: str) -> Modifications:
        """Modifications with this amount alone, or with none where it has another name."""
        return replace(self, **dict.fromkeys(self.amounts.keys() - {name}, 0.0))  # type: ignore[arg-type]

    @property
    def largest(self) -> str:
        """Field with the largest amount; of equal ones the first."""
        return max(AMOUNTS, key=lambda name: abs(getattr(self, name)))
