"""Gears that cannot run together: each rule of the check, by the key that its error names."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from evolvent_meshes.gears.errors import GeometryError
from evolvent_meshes.gears.pair import GearPair
from tests.support.paper_pairs import he, he_gear, yang

PAIR_ERRORS: list[tuple[str, dict[str, Any], str]] = [
    ("no line of action", {"centre_distance": 140.0}, "centre_distance"),
    ("flanks jam", {"centre_distance": 149.9}, "centre_distance"),
    ("tips apart", {"centre_distance": 157.0}, "centre_distance"),
    ("gap between teeth", {"centre_distance": 153.5}, "contact ratio"),
    ("not a number", {"centre_distance": math.nan}, "centre_distance"),
    ("module", {"wheel": replace(he_gear(), normal_module=2.99)}, "normal_module"),
    ("pressure angle", {"wheel": replace(he_gear(), normal_pressure_angle_deg=19.9)}, "normal_pressure_angle_deg"),
    ("tip in root", {"wheel": he_gear(157.6), "centre_distance": 150.0}, "wheel.tip_diameter"),
    (
        "tip on fillet",
        {"pinion": replace(he_gear(), rack_tip_radius=1.2), "wheel": he_gear(157.0)},
        "wheel.tip_diameter",
    ),
]


@pytest.mark.parametrize(("change", "key"), [e[1:] for e in PAIR_ERRORS], ids=[e[0] for e in PAIR_ERRORS])
def test_impossible_pairs(change: dict[str, Any], key: str) -> None:
    """He's pair with one thing broken: the error names the key."""
    with pytest.raises(GeometryError) as caught:
        replace(he(), **change)
    assert caught.value.key == key


def test_allowed_value_in_the_message_is_allowed() -> None:
    """The largest tip diameter that an error prints is the limit: 1 µm less passes, 1 µm more fails."""
    round_root = replace(he_gear(), rack_tip_radius=1.2)
    with pytest.raises(GeometryError) as caught:
        GearPair(round_root, he_gear(157.0), 150.0)
    limit = float(caught.value.allowed.split()[2])
    assert GearPair(round_root, he_gear(limit - 1e-3), 150.0).transverse_contact_ratio > 1.75
    with pytest.raises(GeometryError, match=r"wheel\.tip_diameter"):
        GearPair(round_root, he_gear(limit + 1e-3), 150.0)


def test_hands_and_helix_angles_of_a_pair() -> None:
    """Helical gears on parallel axes: opposite hands, equal helix angles; a spur pair's hands don't matter."""
    pair = yang()
    with pytest.raises(GeometryError, match=r"hand: found 1, allowed -1\..* opposite hands: give one gear hand = -1\."):
        replace(pair, wheel=replace(pair.wheel, hand=1))
    with pytest.raises(GeometryError, match="helix_angle_deg"):
        replace(pair, wheel=replace(pair.wheel, helix_angle_deg=28.5, tip_diameter=148.6, root_diameter=136.3))
    assert replace(he(), wheel=replace(he_gear(), hand=-1)).overlap_ratio == 0.0
