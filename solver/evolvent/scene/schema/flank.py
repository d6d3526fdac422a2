"""Keys of [pinion] and [wheel] for the loaded flank: modifications and a chart. Amounts are removed material; where one
may be negative, its sign tells the end.

Amounts are material that is taken off; where one may be negative, its sign says at which end.
"""

from __future__ import annotations

from typing import Literal

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


class FlankKeys(SceneSection):
    """Modifications of the loaded flank, and its chart."""

    tip_relief_um: float = key(
        "tip relief: material taken off the flank at the tip", AMOUNT, default=0.0, ge=0, le=MOST
    )
    tip_relief_start_diameter_mm: float | None = key(
        "diameter at which the tip relief starts; d_a − m_n by default",
        LENGTH,
        DERIVED,
        needs=("tip_relief_um",),
        default=None,
        gt=0,
        le=LONGEST,
    )
    tip_relief_form: Literal["linear", "parabolic"] = key(
        "how the tip relief grows with the roll distance", '"linear" or "parabolic"',
        needs=("tip_relief_um",), default="linear",
    )
    root_relief_um: float = key(
        "root relief C_αf: material taken off the flank at the profile control diameter", AMOUNT, default=0.0, ge=0,
        le=MOST,
    )
    root_relief_end_diameter_mm: float | None = key(
        "diameter at which the root relief ends, above which there is none; m_n/2 above the profile control diameter "
        "by default",
        LENGTH,
        DERIVED,
        needs=("root_relief_um",),
        default=None,
        gt=0,
        le=LONGEST,
    )
    root_relief_form: Literal["linear", "parabolic"] = key(
        "how the root relief grows with the roll distance from there", '"linear" or "parabolic"',
        needs=("root_relief_um",), default="linear",
    )
    profile_crowning_um: float = key(
        "profile crowning (barrelling) C_α: material taken off the flank at the tip and at the profile control "
        "diameter, a parabola of the roll distance",
        AMOUNT,
        default=0.0,
        ge=0,
        le=MOST,
    )
    profile_slope_um: float = key(
        "profile slope (pressure angle) C_Hα: material taken off the flank at the tip or, if negative, at the profile "
        "control diameter, linear in the roll distance; a measured f_Hα of ISO 1328-1 times −cos β_b",
        SIGNED,
        default=0.0,
        ge=-MOST,
        le=MOST,
    )
    profile_control_diameter_mm: float | None = key(
        "profile control diameter d_Cf: root relief, profile crowning, profile slope and twist are measured from there "
        "to the tip; the diameter d_Nf at the start of the active profile by default",
        LENGTH,
        DERIVED,
        needs=FROM_CONTROL_DIAMETER,
        default=None,
        gt=0,
        le=LONGEST,
    )
    lead_crowning_um: float = key(
        "lead crowning: material taken off the flank at its ends", AMOUNT, default=0.0, ge=0, le=MOST
    )
    helix_slope_um: float = key(
        "helix slope (lead slope) C_Hβ: material taken off the flank at its end z > 0 or, if negative, at z < 0, "
        "linear in z; a measured f_Hβ of ISO 1328-1 times −cos β_b on right-hand gears, times cos β_b on left-hand "
        "ones",
        SIGNED,
        default=0.0,
        ge=-MOST,
        le=MOST,
    )
    end_relief_um: float = key(
        "end relief C_βI = C_βII: material taken off the flank at both ends of the face", AMOUNT, default=0.0, ge=0,
        le=MOST,
    )
    end_relief_length_mm: float | None = key(
        "length of the end relief at either end of the face; a tenth of the face width by default",
        LENGTH,
        DERIVED,
        needs=("end_relief_um",),
        default=None,
        gt=0,
        le=LONGEST,
    )
    end_relief_form: Literal["linear", "parabolic"] = key(
        "how the end relief grows with z", '"linear" or "parabolic"',
        needs=("end_relief_um",), default="linear",
    )
    twist_um: float = key(
        "twist (bias) S_α: profile slope C_Hα at the end z > 0 of the face less that at z < 0, in between linear in z",
        SIGNED,
        default=0.0,
        ge=-MOST,
        le=MOST,
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
