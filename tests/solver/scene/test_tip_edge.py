"""Chamfered and rounded tips of a scene: what check says, what the standard takes."""

from __future__ import annotations

import re

import pytest

from evolvent.scene.checking.check_report import overview
from evolvent.scene.scene import scene_from_text
from evolvent.strength.standard.virtual_gear import virtual_contact_ratio, virtual_gear
from tests.support.scene_texts import HE

CHAMFERED = "pinion.tip_chamfer_um=300", "wheel.tip_chamfer_um=300"


def test_check_tells_of_the_edge_alone() -> None:
    """d_Fa = 156 − 0.6 mm on the chamfered pinion, d_a on the sharp wheel; no such rows where both are sharp."""
    text = overview(scene_from_text(HE, CHAMFERED[:1]))
    assert re.search(r"tip chamfer, radial +h_K +µm +300\.0 +0\.0", text)
    assert re.search(r"tip form diameter +d_Fa +mm +155\.400 +156\.000", text)
    assert not re.search("h_K|ρ_K|d_Fa", overview(scene_from_text(HE)))


def test_standard_takes_the_tip_form_circle() -> None:
    """Loads act up to d_Fa: the virtual gear of a chamfered one is that of a gear with this tip diameter."""
    chamfered, shorter = (
        scene_from_text(HE.replace("tip_diameter_mm = 156.0", f"tip_diameter_mm = {tip}"), settings).gear_pair()
        for tip, settings in ((156.0, CHAMFERED), (155.4, ()))
    )
    assert virtual_gear(chamfered.pinion) == virtual_gear(shorter.pinion)
    assert virtual_contact_ratio(chamfered) == pytest.approx(virtual_contact_ratio(shorter), rel=1e-12)
