"""How a gear is held, and what it does to its compliance."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.condensed_gear import GearBody
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import scene_from_text
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of
from tests.support.scene_texts import HE, without


def softness(body: GearBody) -> float:
    """Displacement [mm/N] of tooth 0's flank along its mean normal, the same force on all its nodes."""
    rows = body.rows(0, np.arange(len(body.flank.points)))
    n = body.flank.normals.mean(axis=0)
    moved = body.chain.apply(rows, np.tile(n / len(rows), (len(rows), 1)), rows)
    return float((moved @ n).mean())


def test_gears_are_softer_the_less_of_the_bore_is_held() -> None:
    """A narrow helical wheel: a support is a constraint less where it is left out, so that by energy the compliance
    grows as the support shrinks; a support as wide as the face is the default to the last digit. By how much it grows
    is a matter of the body: here by 1 to 30 % for half of the face."""
    wide, whole, half, quarter = (
        softness(model_of(helical_scene(*settings)).bodies[Member.WHEEL])
        for settings in (
            [], ["wheel.support_width_mm=8"], ["wheel.support_width_mm=4"],
            ["wheel.support_width_mm=2", "wheel.support_offset_mm=1"],
        )
    )
    assert whole == wide
    assert 1.01 * wide < half < 1.3 * wide
    assert half < quarter


def test_rim_is_a_bore_at_its_inside() -> None:
    """He's wheel, d_f = 142.5 mm: a rim of 11.25 mm is the gear with a bore of 120 mm, held over its face."""
    text = without(HE, "bore_diameter_mm")
    rim = scene_from_text(text, ["pinion.rim_thickness_mm=11.25"]).gear_pair().pinion
    bore = scene_from_text(text, ["pinion.bore_diameter_mm=120"]).gear_pair().pinion
    assert rim.bore_diameter == pytest.approx(bore.bore_diameter, abs=1e-12)
    assert (rim.rim_thickness, rim.support.is_rim, bore.support.is_rim) == (pytest.approx(11.25), True, False)


def test_pair_held_on_a_part_of_its_face_is_solved_in_space() -> None:
    """He's spur pair is plane, but where a bore is held on a part of it."""
    assert gear_problem(scene_from_text(HE)).is_plane
    assert not gear_problem(scene_from_text(HE, ["wheel.support_width_mm=10"])).is_plane
