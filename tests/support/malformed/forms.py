"""Scenes whose tooth forms or gear bodies cannot be."""

from __future__ import annotations

from tests.support.scene_texts import HE, YANG

WRONG_FORMS: dict[str, tuple[str, list[str], str, str, str]] = {
    "thicker teeth": (
        YANG, ["pinion.tooth_thickness_allowance_um=50"], "pinion.tooth_thickness_allowance_um", "50",
        "give it negative",
    ),
    "allowance in mm·10⁻⁴": (
        YANG, ["wheel.tooth_thickness_allowance_um=-700"], "wheel.tooth_thickness_allowance_um", "-700", "in µm",
    ),
    "backlash that is not the teeth's": (
        HE, ["dynamics.backlash_um=50", "pinion.tooth_thickness_allowance_um=-80"], "dynamics.backlash_um", "50",
        "delete the key",
    ),
}  # fmt: skip
"""Case -> scene, overrides; key, what was found and a part of the remedy that the message must have."""
