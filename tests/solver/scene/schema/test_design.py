"""The section [design]: what it refuses, and what it says then."""

from __future__ import annotations

import pytest

from evolvent.scene.scene import SceneError
from evolvent.scene.schema.design import expanded
from tests.support.gear_cases import spur_scene

VARY = 'design.vary=[["both.tip_relief_um",0.0,60.0,5.0]]'


def refused(*settings: str) -> str:
    with pytest.raises(SceneError) as caught:
        spur_scene(*settings)
    return "; ".join(map(str, caught.value.problems))


@pytest.mark.parametrize(("row", "said"), [
    ('["both.tip_relief_um",0.0,60.0]', "write each row as [key, lowest, highest, step]"),
    ('["both.tip_relief",0.0,60.0,5.0]', "and one of tip_relief_um"),
    ('["pinion.teeth",17,20,1]', "and one of tip_relief_um"),
    ('["pair.misalignment_um",0.0,20.0,5.0]', "and one of tip_relief_um"),
    ('["both.tip_relief_um",-3.0,60.0,9.0]', "-3 of both.tip_relief_um; allowed: a number from 0 to 500"),
    ('["both.tip_relief_um",60.0,0.0,5.0]', "a lowest value below the highest"),
    ('["both.tip_relief_um",0.0,60.0,0.0]', "a step above 0"),
    ('["both.tip_relief_um",0.0,60.0,61.0]', "not larger than their distance"),
    ('["both.tip_relief_um",0.0,60.0,7.0]', "end the range at 56 or at 63"),
    ('["both.tip_relief_um",0.0,60.0,5.0],["wheel.tip_relief_um",0.0,60.0,5.0]', "wheel.tip_relief_um more than once"),
])
def test_rows_that_cannot_vary(row: str, said: str) -> None:
    """A row of another length, of another key, of values that are not allowed, or of a key that another row has."""
    assert said in refused(f"design.vary=[{row}]")


@pytest.mark.parametrize(("setting", "said"), [
    ('design.limits=[["face_load_factor",0.0]]', "a number above 0"),
    ('design.tolerances=[["both.tip_relief_um",501.0]]', "a number above 0 up to 500"),
    ('design.tolerances=[["load.torque_Nm",5.0]]', "or pair.misalignment_um"),
    ('design.targets=["loss"]', "transmission_error_peak_to_peak_um"),
    ('design.targets=["face_load_factor","face_load_factor"]', "face_load_factor more than once"),
    ('design.limits=[["Pressure",1000.0]]', "largest_pressure_MPa"),
])
def test_other_rows_that_are_refused(setting: str, said: str) -> None:
    """Limits and tolerances are above 0; what may deviate is a modification or the misalignment."""
    assert said in refused(VARY, setting)


def test_a_design_without_what_varies_is_refused() -> None:
    """`vary` is required."""
    assert "design.vary" in refused("design.samples=10")


def test_both_stands_for_two_keys() -> None:
    """A key of both gears is one of each."""
    section = spur_scene(VARY, 'design.tolerances=[["pair.misalignment_um",5.0]]').design
    assert section is not None
    assert expanded(section.vary) == ["pinion.tip_relief_um", "wheel.tip_relief_um"]
    assert expanded(section.tolerances) == ["pair.misalignment_um"]
