"""The unloaded transmission error of modified flanks, whose closed forms it has to find.

Problem: a pair 30/45, modified as in a scene. The exact flank along the normals is followed, the closed forms are of
first order in the flank's slopes; with amounts of 1 µm what they leave out is below a nanometre.
"""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent.scene.scene import scene_from_text
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair

NANOMETRE = 1e-6
PAIR = """
[pair]
normal_module_mm = 3.0
[pinion]
teeth = 30
face_width_mm = 16
[wheel]
teeth = 45
face_width_mm = 16
[load]
torque_Nm = 100
"""


def pair(*settings: str, helix: float = 0.0) -> GearPair:
    return scene_from_text(PAIR, [f"pair.helix_angle_deg={helix}", *settings]).gear_pair()


def angles(one: GearPair, count: int = 9) -> Floats:
    return 2.0 * np.pi / one.pinion.z * (np.arange(count) + 0.3) / count


def error(one: GearPair) -> Floats:
    return unloaded_error(RigidFlanks(one), angles(one))


@pytest.mark.parametrize("helix", [0.0, 18.0])
@pytest.mark.parametrize(("settings", "constant"), [
    (("pinion.profile_slope_um=1", "wheel.profile_slope_um=1"), 1.0),
    (("pinion.profile_slope_um=-1", "wheel.profile_slope_um=-1"), 1.0),
    (("pinion.helix_slope_um=1", "wheel.helix_slope_um=-1"), 1.0),
    (("pinion.twist_um=1", "wheel.twist_um=1"), 0.5),
])
def test_modifications_that_cancel_leave_a_rotation(settings: tuple[str, ...], constant: float, helix: float) -> None:
    """Exact: tip meets root, so that equal profile slopes of both gears are those of another pressure angle, opposite
    helix slopes those of another helix angle, and equal twists cancel. What is missing is even: a rotation."""
    one = pair(*settings, helix=helix)
    exact = 1e-3 * constant / np.cos(one.pinion.base_helix_angle)
    assert error(one) == pytest.approx(np.full(9, exact), abs=NANOMETRE)
    assert np.abs(error(pair(settings[0], helix=helix)) - exact).max() > 50.0 * NANOMETRE


def test_profile_crowning_makes_parabolas() -> None:
    """Exact, spur pair: e = C_α (2 (ξ − ξ_m)/g_α)², ξ_m the middle of the path of contact of length g_α, of the tooth
    pair that is nearest to it."""
    one = pair("pinion.profile_crowning_um=1")
    start, end = one.path_of_contact
    teeth = np.arange(-3, 4)[:, None]
    ξ = one.roll_distance(angles(one), teeth, 0.0)
    exact = 1e-3 * (2.0 * (ξ - 0.5 * (start + end)) / (end - start)) ** 2
    assert error(one) == pytest.approx(exact.min(axis=0), abs=NANOMETRE)
    assert np.ptp(error(one)) > 300.0 * NANOMETRE


@pytest.mark.parametrize("form", ["linear", "parabolic"])
def test_root_relief_is_the_tip_relief_of_the_mate(form: str) -> None:
    """Exact: root relief of the pinion from its start of the active profile, and tip relief of the wheel that begins
    where it ends, take the same off the same part of the path of contact; here single contact lies on it."""
    relieved = pair(
        "pinion.root_relief_um=1", "pinion.root_relief_end_diameter_mm=92", f'pinion.root_relief_form="{form}"'
    )
    ξ = relieved.pinion.roll_length(92.0) - relieved.pitch_point_roll_lengths[0]
    start = 2.0 * np.hypot(relieved.wheel.base_radius, relieved.pitch_point_roll_lengths[1] - ξ)
    tip = pair(
        "wheel.tip_relief_um=1", f"wheel.tip_relief_start_diameter_mm={start}", f'wheel.tip_relief_form="{form}"'
    )
    assert error(relieved) == pytest.approx(error(tip), abs=NANOMETRE)
    assert np.ptp(error(tip)) > 50.0 * NANOMETRE


def test_helix_slope_takes_half_of_what_misalignment_takes() -> None:
    """Exact: flanks that open by 1 µm over the face touch at its other end. There the slope has taken nothing off, and
    the tilt about mid-face has closed half of it."""
    tilted, slope = pair("pair.misalignment_um=1"), pair("wheel.helix_slope_um=1")
    assert error(slope) == pytest.approx(np.zeros(9), abs=NANOMETRE)
    assert error(slope) - error(tilted) == pytest.approx(np.full(9, 0.5e-3), abs=NANOMETRE)


def test_end_relief_leaves_the_middle() -> None:
    """Exact: spur flanks touch where nothing is missing, whatever is taken off their ends."""
    assert error(pair("pinion.end_relief_um=30", "wheel.end_relief_um=20")) == pytest.approx(np.zeros(9), abs=NANOMETRE)
