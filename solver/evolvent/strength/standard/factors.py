"""Factors of the root stress by ISO 6336-3 in its editions of 2006 and 2019."""

from __future__ import annotations

import math
from typing import Literal, get_args

from evolvent_meshes.errors import InputError

Edition = Literal[2006, 2019]
EDITIONS: tuple[Edition, ...] = get_args(Edition)
"""Editions of ISO 6336-3."""
STEEPEST_HELIX = math.radians(30.0)
"""Largest helix angle that counts in Y_β [rad]."""
ONE_CONTACT, DEEP = 2.05, 2.5
"""Contact ratios ε_αn between which Y_DT falls."""
DEEP_TOOTH = -0.666, 2.366, 0.7
"""Slope and offset of Y_DT between them, and its value above."""
DEEP_GRADE = 4
"""Tolerance class up to which teeth share the load so that Y_DT counts."""
THIN_RIM, THINNEST_RIM = 1.2, 0.5
"""Rim thickness over tooth height below which Y_B counts, and down to which it is given."""
TWO_PAIRS = 0.7
"""f_ε of spur gears with ε_αn of 2 and more."""


def helix_angle_factor(helix_angle: float, overlap_ratio: float, edition: Edition) -> float:
    """Y_β = 1 − ε_β β/120°, with ε_β at most 1 and β [rad] at most 30°; in 2019 over cos³ β (clause 8)."""
    β = min(helix_angle, STEEPEST_HELIX)
    factor = 1.0 - min(overlap_ratio, 1.0) * math.degrees(β) / 120.0
    return factor if edition == 2006 else factor / math.cos(β) ** 3


def rim_thickness_factor(rim: float, tooth_height: float, gear: str = "gear") -> float:
    """Y_B = 1.6 ln(2.242 h_t/s_R) of external gears, 1 from s_R = 1.2 h_t on (clause 9).

    rim, tooth_height: s_R and h_t [mm]. gear: name in the message.

    Raises InputError for rims that the standard does not cover.
    """
    backup = rim / tooth_height
    if backup <= THINNEST_RIM:
        raise InputError(
            f"{gear}.rim_thickness_mm: found {rim:.4g} mm, {backup:.3g} tooth heights; allowed: above "
            f"{THINNEST_RIM * tooth_height:.4g} mm, half a tooth height, below which the standard has no factor, and "
            "finite elements hold the inside of a rim without a web rigidly; remedy: give a thicker rim"
        )
    return 1.0 if backup >= THIN_RIM else 1.6 * math.log(2.242 / backup)


def deep_tooth_factor(contact_ratio: float, tolerance_class: int) -> float:
    """Y_DT = 2.366 − 0.666 ε_αn between 2.05 and 2.5, 0.7 above, of tolerance classes up to 4; else 1 (clause 10).

    contact_ratio: ε_αn.
    """
    if tolerance_class > DEEP_GRADE or contact_ratio <= ONE_CONTACT:
        return 1.0
    slope, offset, least = DEEP_TOOTH
    return slope * contact_ratio + offset if contact_ratio <= DEEP else least


def load_distribution_factor(contact_ratio: float, overlap_ratio: float, edition: Edition) -> float:
    """f_ε of Y_F, the load distribution between teeth (2019, clause 6); 1 in 2006.

    Between ε_β = 0 and 1 the squares are linear in ε_β. At ε_αn = 2 it falls, as the standard has it, from 1 to 0.7 for
    spur gears and by less with overlap, not at all from ε_β = 1 on.

    contact_ratio: ε_αn.
    """
    if edition == 2006:
        return 1.0
    if overlap_ratio == 0.0:
        return 1.0 if contact_ratio < 2.0 else TWO_PAIRS
    overlap = min(overlap_ratio, 1.0)
    alone = 1.0 if contact_ratio < 2.0 else 0.5
    return math.sqrt((1.0 - overlap) * alone + overlap / contact_ratio)
