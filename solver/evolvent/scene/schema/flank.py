"""Keys of [pinion] and [wheel] for the loaded flank: modifications and a chart.

Amounts are material that is taken off; where one may be negative, its sign says at which end.
"""

from __future__ import annotations

from typing import Any, Literal

from evolvent.scene.schema.section import SceneSection, key
from evolvent_meshes.gears.modifications.modifications import FROM_CONTROL_DIAMETER

LONGEST = 1e6
"""Largest diameter and distance [mm]: a gear with 1000 teeth of module 50 has 71 m."""
LENGTH = "a number above 0 up to 1e6, in mm"
MOST = 500
"""Largest modification [µm]."""
LEAST, LEAST_MODULES = 0.1, 5e-5
"""Smallest relief or crowning but 0 [µm], and [normal modules] where that is less; a smaller number is likely to be in
mm."""
AMOUNT = f"a number from 0 to {MOST}, in µm, but none between 0 and {LEAST:g}, or 5e-5 m_n if that is less"
SIGNED = f"a number from -{MOST} to {MOST}, in µm"
DERIVED = "delete the key for the default"
Form = Literal["linear", "parabolic"]


def length(meaning: str, remedy: str = "", needs: tuple[str, ...] = ()) -> Any:
    """Declares the key of a diameter or a distance that has a default."""
    return key(meaning, LENGTH, remedy, needs=needs, default=None, gt=0, le=LONGEST)


def _amount(meaning: str) -> Any:
    """Declares the key of an amount that is taken off."""
    return key(meaning, AMOUNT, default=0.0, ge=0, le=MOST)


def _signed(meaning: str) -> Any:
    """Declares the key of an amount whose sign says at which end it is taken off."""
    return key(meaning, SIGNED, default=0.0, ge=-MOST, le=MOST)


def _form(meaning: str, amount: str) -> Any:
    """Declares the key of how a relief grows. amount: key of the relief."""
    return key(meaning, '"linear" or "parabolic"', needs=(amount,), default="linear")


class FlankKeys(SceneSection):
    """Modifications of the loaded flank, and its chart."""

    tip_relief_um: float = _amount("tip relief: material taken off the flank at the tip")
    tip_relief_start_diameter_mm: float | None = length(
        "diameter at which the tip relief starts; d_a − m_n by default", DERIVED, ("tip_relief_um",)
    )
    tip_relief_form: Form = _form("how the tip relief grows with the roll distance", "tip_relief_um")
    root_relief_um: float = _amount(
        "root relief C_αf: material taken off the flank at the profile control diameter"
    )
    root_relief_end_diameter_mm: float | None = length(
        "diameter at which the root relief ends, above which there is none; m_n/2 above the profile control diameter "
        "by default",
        DERIVED, ("root_relief_um",),
    )
    root_relief_form: Form = _form("how the root relief grows with the roll distance from there", "root_relief_um")
    profile_crowning_um: float = _amount(
        "profile crowning (barrelling) C_α: material taken off the flank at the tip and at the profile control "
        "diameter, a parabola of the roll distance"
    )
    profile_slope_um: float = _signed(
        "profile slope (pressure angle) C_Hα: material taken off the flank at the tip or, if negative, at the profile "
        "control diameter, linear in the roll distance; a measured f_Hα of ISO 1328-1 times −cos β_b"
    )
    profile_control_diameter_mm: float | None = length(
        "profile control diameter d_Cf: root relief, profile crowning, profile slope and twist are measured from there "
        "to the tip; the diameter d_Nf at the start of the active profile by default",
        DERIVED, FROM_CONTROL_DIAMETER,
    )
    lead_crowning_um: float = _amount("lead crowning: material taken off the flank at its ends")
    helix_slope_um: float = _signed(
        "helix slope (lead slope) C_Hβ: material taken off the flank at its end z > 0 or, if negative, at z < 0, "
        "linear in z; a measured f_Hβ of ISO 1328-1 times −cos β_b on right-hand gears, times cos β_b on left-hand "
        "ones"
    )
    end_relief_um: float = _amount("end relief C_βI = C_βII: material taken off the flank at both ends of the face")
    end_relief_length_mm: float | None = length(
        "length of the end relief at either end of the face; a tenth of the face width by default",
        DERIVED, ("end_relief_um",),
    )
    end_relief_form: Form = _form("how the end relief grows with z", "end_relief_um")
    twist_um: float = _signed(
        "twist (bias) S_α: profile slope C_Hα at the end z > 0 of the face less that at z < 0, in between linear in z"
    )
    flank_csv: str | None = key(
        "chart of the loaded flank, measured or worn: material that is missing from the designed flank; a path "
        "relative to the scene's folder, or, given by --set, to the current folder",
        "the name of a CSV file with diameter_mm, depth_um and perhaps z_mm",
        "delete the key for flanks as designed",
        default=None,
        min_length=1,
        max_length=1000,
    )
