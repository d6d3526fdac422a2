"""Scenes with undercut gears and with protuberance."""

from __future__ import annotations

import re

import pytest

from evolvent.check.check_report import overview
from evolvent.scene.scene import scene_from_text
from evolvent.strength.standard.critical_section import rack_of, root_section
from tests.support.scene_texts import HE, without

FEW = [
    "pinion.teeth=15", "wheel.teeth=40", "pinion.tip_diameter_mm=50.4", "pinion.bore_diameter_mm=20",
    "wheel.tip_diameter_mm=123.6", "wheel.bore_diameter_mm=50",
]


def test_mild_undercut_is_a_warning() -> None:
    """15 teeth without profile shift, m_n = 3 mm: a rack with ρ_fP = 0.38 m_n undercuts by a little, the involute
    begins above the base circle of 45 mm · cos 20°. Check warns with the diameter; no warning for more teeth."""
    scene = scene_from_text(without(HE, "centre_distance_mm"), FEW)
    gear = scene.gear_pair().pinion
    assert gear.is_undercut
    assert 0.0 < gear.root_form_diameter - gear.base_diameter < 0.1
    assert re.search(f"undercuts the pinion: .* {gear.root_form_diameter:.4f} mm", overview(scene))
    assert "undercuts" not in overview(scene_from_text(HE))


def test_protuberance_reaches_mesh_and_standard() -> None:
    """s_pr = 50 µm: the rack of the standard has it, and its 30° tangent touches the fillet of the mesh: the chord lies
    within that of a gear without it by twice s_pr within a fifth."""
    deeper = HE.replace("dedendum_coefficient = 1.25", "dedendum_coefficient = 1.4\nrack_tip_radius_mm = 0.9")
    plain, deep = (
        scene_from_text(deeper, settings).gear_pair().pinion for settings in ((), ("pinion.protuberance_um=50",))
    )
    assert rack_of(deep).undercut == pytest.approx(0.05)
    lost = root_section(plain).chord - root_section(deep).chord
    assert lost == pytest.approx(0.1, rel=0.2)
    assert deep.root_form_diameter > plain.root_form_diameter
