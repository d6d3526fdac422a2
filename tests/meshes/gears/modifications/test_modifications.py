"""Amounts of modifications: which there are, and what follows from them."""

from __future__ import annotations

from typing import Any

import pytest

from evolvent_meshes.gears.modifications.modifications import AMOUNTS, OVER_FACE, SIGNED, Modifications


def test_a_flank_without_amounts_is_unmodified() -> None:
    """Places alone modify nothing."""
    assert Modifications().is_empty
    assert Modifications(tip_relief_start_diameter=50.0, end_relief_length=2.0, profile_control_diameter=40.0).is_empty


@pytest.mark.parametrize("name", AMOUNTS)
def test_every_amount_modifies_the_flank(name: str) -> None:
    """One amount alone: it is there, it is the largest, and it varies over the face or not. Negative ones, too."""
    for amount in (3.0, -3.0) if name in SIGNED else (3.0,):
        own: dict[str, Any] = {name: amount}
        given = Modifications(**own)
        assert given.amounts == {name: amount} and not given.is_empty
        assert given.largest == name
        assert given.varies_over_the_face == (name in OVER_FACE)


def test_only_keeps_one_amount_and_all_places() -> None:
    """Others are 0; a name that is none leaves none."""
    given = Modifications(tip_relief_um=5.0, tip_relief_start_diameter=50.0, twist_um=-3.0)
    assert given.only("tip_relief_um") == Modifications(tip_relief_um=5.0, tip_relief_start_diameter=50.0)
    assert given.only("misalignment_um") == Modifications(tip_relief_start_diameter=50.0)
