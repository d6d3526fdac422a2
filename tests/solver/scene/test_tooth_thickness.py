"""Tooth thickness allowances of a scene: the root that follows, the backlash of the vibration, what check says."""

from __future__ import annotations

import math
import re

import pytest

from evolvent.check.check_report import overview
from evolvent.dynamics.of_scene import drive_settings
from evolvent.scene.scene import scene_from_text
from tests.support.scene_texts import HE

THIN = "pinion.tooth_thickness_allowance_um=-80", "wheel.tooth_thickness_allowance_um=-20"


def test_backlash_of_the_vibration_follows() -> None:
    """He's pair with 100 µm less tooth thickness: 100 µm · cos 20° along the line of action. The same figure may be
    given, too."""
    wanted = 0.1 * math.cos(math.radians(20.0))
    scene = scene_from_text(HE, [*THIN, "dynamics.speeds=10"])
    assert scene.dynamics is not None
    assert drive_settings(scene.gear_pair(), scene.dynamics).backlash == pytest.approx(wanted, rel=1e-9)
    assert scene_from_text(HE, [*THIN, f"dynamics.backlash_um={1e3 * wanted:.1f}"]).dynamics is not None


def test_root_follows_or_stays() -> None:
    """The rack cuts deeper by A_sn/(2 tan α_n), unless the root diameter is given."""
    plain, thin = (scene_from_text(HE, each).gear_pair().pinion for each in ((), THIN))
    assert plain.root_diameter - thin.root_diameter == pytest.approx(0.08 / math.tan(math.radians(20.0)), abs=1e-12)
    text = HE.replace("dedendum_coefficient = 1.25", "root_diameter_mm = 142.5")
    assert scene_from_text(text, THIN).gear_pair().pinion.root_diameter == 142.5


def test_check_tells_of_thin_teeth_alone() -> None:
    """A_sn, x_E = −0.08/(2·3·tan 20°), s_n = 3π/2 − 0.08 and j_wt = 0.1 mm; no such rows without allowances."""
    text = overview(scene_from_text(HE, THIN))
    for row in (
        r"allowance +A_sn +µm +-80\.0 +-20\.0", r"coefficient +x_E +-0\.0366 +-0\.0092", r"s_n +mm +4\.6324 +4\.6924",
        r"circumferential backlash +j_wt +µm +100\.00", r"normal backlash +j_bn +µm +93\.97",
    ):
        assert re.search(row, text), row
    assert not re.search("A_sn|x_E|j_wt", overview(scene_from_text(HE)))
