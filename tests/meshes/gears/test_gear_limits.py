"""Gears that their rack cannot cut: each rule of the check, by the key that its error names."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from evolvent_meshes.gears.errors import GeometryError
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.modifications.modifications import Modifications
from tests.support.paper_pairs import he_gear

GEAR_ERRORS: list[tuple[str, dict[str, Any], str]] = [
    ("undercut", {"z": 12, "tip_diameter": 42.0, "root_diameter": 28.5, "bore_diameter": 10.0}, "profile_shift"),
    ("pointed tip", {"tip_diameter": 165.0}, "tip_diameter"),
    ("tip below root", {"tip_diameter": 140.0}, "tip_diameter"),
    ("no involute", {"tip_diameter": 144.0}, "tip_diameter"),
    ("thin rim", {"bore_diameter": 140.0}, "bore_diameter"),
    ("tool too round", {"rack_tip_radius": 1.5}, "rack_tip_radius"),
    ("pointed tool", {"root_diameter": 130.0}, "root_diameter"),
    ("not a number", {"face_width": math.nan}, "face_width"),
    ("infinite", {"tip_diameter": math.inf}, "tip_diameter"),
    ("no length", {"normal_module": 0.0}, "normal_module"),
    ("broken tooth count", {"z": 49.5}, "z"),
    ("hand", {"hand": 0}, "hand"),
    ("helix angle", {"helix_angle_deg": -15.0}, "helix_angle_deg"),
    ("pressure angle in rad", {"normal_pressure_angle_deg": 0.349}, "normal_pressure_angle_deg"),
    ("shift in mm", {"profile_shift": math.nan}, "profile_shift"),
    ("relief without start", {"modifications": Modifications(tip_relief_um=10.0)}, "tip_relief_start_diameter"),
    ("crowning above 1 mm", {"modifications": Modifications(lead_crowning_um=1001.0)}, "lead_crowning_um"),
    (  # whose thickness is 336 µm
        "crowning of the whole tip",
        {"tip_diameter": 160.0, "modifications": Modifications(lead_crowning_um=337.0)},
        "lead_crowning_um",
    ),
    (
        "relief and crowning of the whole tip",
        {"tip_diameter": 160.0, "modifications": Modifications(200.0, 155.0, lead_crowning_um=137.0)},
        "tip_relief_um",
    ),
    ("negative crowning", {"modifications": Modifications(lead_crowning_um=-5.0)}, "lead_crowning_um"),
]


@pytest.mark.parametrize(("change", "key"), [e[1:] for e in GEAR_ERRORS], ids=[e[0] for e in GEAR_ERRORS])
def test_impossible_gears(change: dict[str, Any], key: str) -> None:
    """He's gear with one thing broken: the error names the key, what was found, what is allowed and the remedy."""
    with pytest.raises(GeometryError) as caught:
        replace(he_gear(), **change)
    assert caught.value.key == key
    assert all([caught.value.found, caught.value.allowed, caught.value.remedy])


def test_undercut_limit() -> None:
    """Without shift, 20 degrees and h_aP* = 1 the sharp-cornered standard rack undercuts below 2/sin²α = 17.1 teeth.
    Where it should be withdrawn by more than 0.3 modules, it is refused: below 2 (1 − 0.3)/sin²α = 11.97 teeth."""

    def gear(z: int) -> GearParameters:
        return GearParameters.from_rack(
            z=z,
            normal_module=1.0,
            normal_pressure_angle_deg=20.0,
            dedendum_coefficient=1.0,
            rack_tip_radius_coefficient=0.0,
            face_width=1.0,
            bore_diameter=5.0,
        )

    assert not gear(18).is_undercut
    assert gear(17).is_undercut
    assert gear(12).root_form_diameter > gear(12).base_diameter
    with pytest.raises(GeometryError, match="undercut") as caught:
        gear(11)
    least = float(caught.value.allowed.split()[2])
    assert least == pytest.approx(1.0 - 0.3 - 11.0 / 2.0 * math.sin(math.radians(20.0)) ** 2, abs=1e-4)
