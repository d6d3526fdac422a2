"""Chamfered and rounded tips of a scene: what check says, what the standard takes."""

from __future__ import annotations

import math
import re

import pytest

from evolvent.check.check_report import overview
from evolvent.scene.scene import scene_from_text
from evolvent.strength.standard.virtual_gear import virtual_contact_ratio, virtual_gear
from tests.support.scene_texts import HE

CHAMFERED = "pinion.tip_chamfer_um=300", "wheel.tip_chamfer_um=300"


def test_check_tells_of_the_edge_alone() -> None:
    """d_Fa = 156 − 0.6 mm on the chamfered pinion, d_a on the sharp wheel; no such rows where both are sharp."""
    text = overview(scene_from_text(HE, CHAMFERED[:1]))
    assert re.search(r"tip chamfer, radial +h_K +µm +300\.0 +0\.0", text)
    assert re.search(r"tip form diameter +d_Fa +mm +155\.400 +156\.000", text)
    assert not re.search("h_K|ρ_K|d_Fa|land", overview(scene_from_text(HE)))


def test_land_that_is_left() -> None:
    """Of the chamfered pinion, whose flanks lean by acos(r_b/r_Fa) there, each chamfer at 45° to the radius takes off
    the tip circle what it takes less than the flank goes on by; of the sharp wheel nothing, s_an is left."""
    text, pair = overview(scene_from_text(HE, CHAMFERED[:1])), scene_from_text(HE, CHAMFERED[:1]).gear_pair()
    found = re.search(r"normal land between chamfers or roundings +mm +(\S+) +(\S+)", text)
    assert found is not None
    edge = pair.pinion.tip_edge
    assert edge is not None
    assert float(found[1]) == pytest.approx(pair.pinion.tip_diameter * edge.end[1], abs=1e-4)
    assert float(found[2]) == pytest.approx(pair.wheel.normal_thickness(pair.wheel.tip_diameter), abs=1e-4)
    cut = pair.pinion.normal_thickness(pair.pinion.tip_diameter) - float(found[1])
    lean = math.acos(pair.pinion.base_diameter / pair.pinion.tip_form_diameter)
    assert cut == pytest.approx(2.0 * 0.3 * (1.0 - math.tan(lean)), rel=0.1)


def test_standard_takes_the_tip_form_circle() -> None:
    """Loads act up to d_Fa: the virtual gear of a chamfered one is that of a gear with this tip diameter."""
    chamfered, shorter = (
        scene_from_text(HE.replace("tip_diameter_mm = 156.0", f"tip_diameter_mm = {tip}"), settings).gear_pair()
        for tip, settings in ((156.0, CHAMFERED), (155.4, ()))
    )
    assert virtual_gear(chamfered.pinion) == virtual_gear(shorter.pinion)
    assert virtual_contact_ratio(chamfered) == pytest.approx(virtual_contact_ratio(shorter), rel=1e-12)
