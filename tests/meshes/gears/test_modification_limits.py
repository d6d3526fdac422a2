"""Modifications that a gear cannot have: each rule, by the key that its error names."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from evolvent_meshes.gears.errors import GeometryError
from evolvent_meshes.gears.modifications.modifications import AMOUNTS, SIGNED, Modifications
from tests.support.paper_pairs import he_gear

ROOT = {"root_relief_um": 5.0, "root_relief_end_diameter": 148.0}
WRONG: list[tuple[str, dict[str, Any], str, float | None]] = [
    ("root relief without an end", {"root_relief_um": 5.0}, "root_relief_end_diameter", None),
    ("root relief beyond the tip", ROOT | {"root_relief_end_diameter": 156.1}, "root_relief_end_diameter", 156.1),
    ("root relief below its full depth", ROOT | {"profile_control_diameter": 148.5}, "root_relief_end_diameter", 148.0),
    ("control diameter in the root", ROOT | {"profile_control_diameter": 143.0}, "profile_control_diameter", 143.0),
    (
        "control diameter at the tip", {"profile_crowning_um": 5.0, "profile_control_diameter": 156.0},
        "profile_control_diameter", 156.0,
    ),
    ("end relief without a length", {"end_relief_um": 5.0}, "end_relief_length", None),
    ("end relief beyond mid-face", {"end_relief_um": 5.0, "end_relief_length": 10.1}, "end_relief_length", 10.1),
    ("end relief of no length", {"end_relief_um": 5.0, "end_relief_length": 0.0}, "end_relief_length", 0.0),
    ("a number as text", {"twist_um": "5"}, "twist_um", None),
    ("a place as text", ROOT | {"root_relief_end_diameter": "148"}, "root_relief_end_diameter", None),
    ("not a number", {"helix_slope_um": float("nan")}, "helix_slope_um", None),
]


@pytest.mark.parametrize(("given", "key", "found"), [each[1:] for each in WRONG], ids=[each[0] for each in WRONG])
def test_modifications_off_the_flank_are_refused(given: dict[str, Any], key: str, found: float | None) -> None:
    """He's gear, d_Ff = 143.9 mm, d_a = 156 mm, b = 20 mm: the error names the key, what was found and the remedy."""
    with pytest.raises(GeometryError) as caught:
        replace(he_gear(), modifications=Modifications(**given))
    assert caught.value.key == key and caught.value.allowed and caught.value.remedy
    assert found is None or caught.value.found == f"{found:g}"


@pytest.mark.parametrize("name", AMOUNTS)
def test_amounts_have_a_range(name: str) -> None:
    """From 0 µm, slopes and twist from −1000 µm, up to 1000 µm: beyond it the amount is named."""
    for beyond in (1000.1, -1000.1 if name in SIGNED else -0.1):
        own: dict[str, Any] = {name: beyond}
        with pytest.raises(GeometryError) as caught:
            replace(he_gear(), modifications=Modifications(**own))
        assert caught.value.key == name


@pytest.mark.parametrize(("name", "share"), [("profile_slope_um", 1.0), ("helix_slope_um", 1.0), ("twist_um", 2.0)])
def test_something_is_left_of_the_tip(name: str, share: float) -> None:
    """A tip of 336 µm: what takes it whole at one end of the face is refused, of twist twice as much; less is not."""
    thin = he_gear(160.0)
    taken = share * 1e3 * thin.normal_thickness(160.0)
    own: dict[str, Any] = {name: 0.99 * taken}
    assert replace(thin, modifications=Modifications(**own)).modifications.largest == name
    own = {name: 1.01 * taken}
    with pytest.raises(GeometryError, match=r"below the tooth's thickness at its tip") as caught:
        replace(thin, modifications=Modifications(**own))
    assert caught.value.key == name


def test_places_without_amounts_are_not_looked_at() -> None:
    """A scene derives them whether they are used or not."""
    given = Modifications(root_relief_end_diameter=1.0, profile_control_diameter=1.0, end_relief_length=1e3)
    assert replace(he_gear(), modifications=given).modifications.is_empty
