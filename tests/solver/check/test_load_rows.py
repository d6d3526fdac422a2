"""What `evolvent check` tells of [[load_case]]."""

from __future__ import annotations

from evolvent.check.load_rows import load_rows, load_warnings
from tests.support.gear_cases import spur_scene

TWO = 'load_case=[{name="fast",torque_Nm=60.0,speed_rpm=3000.0},{name="slow",torque_Nm=40.0%s}]'


def test_a_row_for_each_load_case() -> None:
    """The lightest first: torque, speed, share of the life, misalignment; empty where it is not given."""
    rows = load_rows(spur_scene(TWO % ",misalignment_um=5.0"))
    assert [(row.name, *row.values) for row in rows] == [("slow", "40", "", "", "5"), ("fast", "60", "3000", "", "0")]


def test_what_other_figures_are_for() -> None:
    """Figures of the check are for the torque of the scene, 170 N·m; load cases of one misalignment are all taken."""
    assert list(load_warnings(spur_scene())) == []
    (said,) = load_warnings(spur_scene(TWO % ""))
    assert "load.torque_Nm, 170 N·m" in said and "up to 60 N·m" in said


def test_misaligned_load_cases() -> None:
    """Others are in space with one that is misaligned; commands whose loads have one mesh refuse them."""
    _, space, refused = load_warnings(spur_scene(TWO % ",misalignment_um=5.0"))
    assert space.startswith("In space under all loads") and "`evolvent excitation` and `design` would refuse" in refused
