"""Words of users for values that a scene knows by another name."""

from __future__ import annotations

from typing import Any

VALUE_WORDS: tuple[tuple[str, Any], ...] = (
    ("driven output gear2 gear_2 large_gear bull_gear", "wheel"),
    ("driving driver input gear1 gear_1 small_gear", "pinion"),
    ("medium normal default middle", "standard"), ("coarse low draft rough", "quick"),
    ("high finest very_fine extra_fine", "fine"),
    ("line_contact lines thin_slice strip slices", "line"),
    ("hex hexa hex8 hex20 hex27 hexahedra hexahedral brick c3d8 c3d20", "hexahedron"),
    ("tet tetra tet4 tet10 tetrahedra tetrahedral c3d4 c3d10", "tetrahedron"),
    ("rh r right_hand right_handed righthand", "right"), ("lh l left_hand left_handed lefthand", "left"),
    ("quadratic parabola square", "parabolic"), ("lin straight", "linear"),
    ("nonlinear non_linear", "force_surface"),
    ("case_hardened carburised carburized nitrided surface_hardened induction_hardened", "hardened"),
    ("soft normalised normalized quenched tempered quenched_and_tempered", "through_hardened"),
    ("iron grey_iron gray_iron grey_cast_iron", "cast_iron"),
    ("up increasing rising runup accelerating", "run_up"), ("down decreasing falling coast_down", "run_down"),
    ("static quasi_static quasistatic", "statics"), ("impact blow standstill", "rest"),
    ("flywheel prescribed constant", "constant_speed"), ("front drive_side", "loaded"), ("coast_side rear", "back"),
    ("yes on", True), ("no off", False),
)
"""Words, separated by spaces, in lower case with underscores, and the value; it counts where a key may have it."""


def values_meant(text: str) -> list[Any]:
    """Values that a word may stand for."""
    word = "_".join(text.lower().replace("-", " ").split())
    return [value for words, value in VALUE_WORDS if word in words.split()]
