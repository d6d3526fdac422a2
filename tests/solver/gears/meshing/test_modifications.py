"""What relief, crowning and misalignment do, as far as a scene tells.

Problem: He's spur pair on springs of stiffness c along its contact lines. Let δ0 = F/(ncb) be the approach of flanks as
designed where n pairs touch over the face width b. Exact, by integration of the overlap: under misalignment f over the
face the share √(2 δ0/f) of the lines bears, with crowning C_β of one gear (3 δ0/2C_β)^(1/3).
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evolvent.check.check_report import overview
from evolvent.check.scene_warnings import scene_warnings
from evolvent.commands.app import Exit, main
from evolvent.gears.meshing.modifications import POINTS, POSITIONS, bearing
from evolvent.scene.scene import SceneError, load_scene
from evolvent_meshes.gears.flank import contact_lines
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import spur_scene

FORCE, STIFFNESS = 2000.0, 14e3


def said(*settings: str, name: str = "he2022") -> str:
    return " ".join(scene_warnings(load_scene(f"demos/{name}.toml", settings)))


def mean_share(pair: GearPair, single: float, power: float) -> float:
    """Of a pitch, where a single pair bears on the share `single`, and n pairs on n^−power of that each."""
    angles = np.arange(POSITIONS) * 2.0 * np.pi / pair.pinion.z / POSITIONS
    pairs = np.array([len(contact_lines(pair, angle)) for angle in angles])
    assert {*pairs} == {1, 2}
    return single * float(np.sum(pairs ** (1.0 - power)) / np.sum(pairs))


def test_all_contact_lines_of_designed_flanks_bear() -> None:
    """Without modifications all lines bear, alike; half of them each where two pairs touch."""
    pair = spur_scene().gear_pair()
    found = bearing(pair, FORCE, STIFFNESS)
    assert found.share == 1.0
    assert found.deflection == pytest.approx(FORCE / STIFFNESS / pair.face_width, rel=1e-12)


@pytest.mark.parametrize("times", [20.0, 100.0])
def test_bearing_share_of_misaligned_flanks(times: float) -> None:
    """f = 20 δ0 and 100 δ0 of one pair: shares 0.316 and 0.141; the end of the face gives way by share times f."""
    pair = spur_scene().gear_pair()
    δ0 = FORCE / STIFFNESS / pair.face_width
    found = bearing(replace(pair, misalignment_um=1e3 * times * δ0), FORCE, STIFFNESS)
    share = math.sqrt(2.0 / times)
    assert found.share == pytest.approx(mean_share(pair, share, 0.5), abs=1.0 / POINTS)
    assert found.deflection == pytest.approx(share * times * δ0, abs=times * δ0 / POINTS)


@pytest.mark.parametrize("times", [12.0, 100.0])
def test_bearing_share_of_crowned_flanks(times: float) -> None:
    """C_β = 12 δ0 and 100 δ0 of one pair: shares 0.5 and 0.247."""
    pair = spur_scene().gear_pair()
    δ0 = FORCE / STIFFNESS / pair.face_width
    crowned = replace(pair.pinion, modifications=replace(pair.pinion.modifications, lead_crowning_um=1e3 * times * δ0))
    found = bearing(replace(pair, pinion=crowned), FORCE, STIFFNESS)
    wanted = mean_share(pair, (1.5 / times) ** (1.0 / 3.0), 1.0 / 3.0)
    assert found.share == pytest.approx(wanted, abs=1.0 / POINTS)


def test_bearing_share_of_relieved_tips_at_a_light_load() -> None:
    """Tip relief that no load closes: the share of the path of contact where neither flank is relieved."""
    scene = spur_scene("pinion.tip_relief_um=50", "load.torque_Nm=1")
    pair = scene.gear_pair()
    (start, end), ρ = pair.path_of_contact, pair.pitch_point_roll_lengths[0]
    relief_start = pair.pinion.modifications.tip_relief_start_diameter
    assert relief_start is not None
    relieved = pair.pinion.roll_length(relief_start) - ρ
    found = bearing(pair, 1.0, STIFFNESS)
    assert found.share == pytest.approx((relieved - start) / (end - start), abs=0.04)


@pytest.mark.parametrize(("settings", "key", "share"), [
    (("pair.misalignment_um=1000",), "pair.misalignment_um = 1000", 10),
    (("pinion.lead_crowning_um=500",), "pinion.lead_crowning_um = 500", 23),
    (("load.torque_Nm=5", "wheel.tip_relief_um=50"), "wheel.tip_relief_um = 50", 76),
    (("pinion.helix_slope_um=-500",), "pinion.helix_slope_um = -500", 13),
    (("wheel.end_relief_um=400", "wheel.end_relief_length_mm=9"), "wheel.end_relief_um = 400", 17),
    (("load.torque_Nm=5", "pinion.root_relief_um=50"), "pinion.root_relief_um = 50", 81),
    (("load.torque_Nm=5", "pair.misalignment_um=3", "wheel.lead_crowning_um=2"),
     "pair.misalignment_um = 3 and wheel.lead_crowning_um = 2", 48),
])
def test_warning_names_the_modification_that_keeps_flanks_apart(
    settings: tuple[str, ...], key: str, share: int
) -> None:
    """The figure that does it, and what it does; several where only together they do."""
    text = said(*settings)
    assert f"{key} (µm): the flanks bear on about {share} %" in text


def test_usual_modifications_are_not_warned_of() -> None:
    """What designers give at the nominal load: reliefs near the deflection, some micrometres over the face."""
    for name in ("he2022", "yang2022", "zhang2023", "first_pair"):
        assert "bear on" not in said("mesh.level=standard", name=name)
    usual = ("pair.misalignment_um=5", "pinion.lead_crowning_um=5", "pinion.tip_relief_um=15", "wheel.tip_relief_um=15")
    assert "bear on" not in said(*usual)


@pytest.mark.parametrize(("settings", "words"), [
    ((), "No tip relief: tip edges may bear, as teeth deflect by about 8.5 µm; see tip_relief_um."),
    (("wheel.tip_relief_um=10",), "No tip relief on the pinion: tip edges may bear"),
    (("pinion.tip_relief_um=10", "wheel.tip_relief_um=10"), ""),
    (("pinion.tip_relief_um=10", "pinion.root_relief_um=10"), ""),  # which the wheel's tip meets
    (("wheel.root_relief_um=10",), "No tip relief on the wheel: tip edges may bear"),
    (("wheel.profile_crowning_um=10",), ""),
    (("wheel.profile_slope_um=10",), "No tip relief: tip edges may bear"),
    (("pinion.tip_relief_um=0.5", "wheel.tip_relief_um=10"), "Too little tip relief, 0.5 µm on the pinion: tip edges"),
    (("pinion.tip_relief_um=0.5",), "Too little tip relief, 0.5 µm on the pinion and 0 µm on the wheel: tip edges may"),
    (("wheel.profile_crowning_um=0.5",),
     "Too little tip relief, 0.5 µm on the pinion and 0.5 µm on the wheel: tip edges may bear"),
])
def test_missing_tip_relief_is_warned_of(settings: tuple[str, ...], words: str) -> None:
    """He's pair, whose transmission error in single contact is 8.50 µm (quick): `check` names what is not relieved."""
    text = overview(load_scene("demos/he2022.toml", settings))
    assert words in text and ("tip edges may" in text) == bool(words)


@pytest.mark.parametrize(("depths", "words"), [
    ((4.0, 4.0, 4.0), "No tip relief: tip edges may bear"),
    ((4.0, 4.0, 14.0), "No tip relief on the wheel: tip edges may bear"),
    ((14.0, 4.0, 14.0), ""),  # the wheel's tip meets the pinion's root
    ((4.0, 4.0, 1.0), "Too little tip relief, -3 µm on the pinion and 0 µm on the wheel: tip edges may bear"),
])
def test_charted_tip_relief_is_that_beyond_mid_height(
    tmp_path: Path, depths: tuple[float, float, float], words: str
) -> None:
    """A chart of the pinion's flank with these depths [µm] at root, mid-height and tip: a constant one relieves
    nothing, and one that is lower at mid-height than at the tip adds material there."""
    pair = spur_scene().gear_pair()
    ends = np.array([pair.pinion.roll_length(d) for d in (pair.active_start_diameters[0], pair.pinion.tip_diameter)])
    rolls = np.array([ends[0], ends.mean(), ends[1]])
    diameters = 2.0 * np.hypot(rolls, pair.pinion.base_radius)
    lines = [f"{d:.9f},{um:g}" for d, um in zip(diameters, depths)]
    (tmp_path / "chart.csv").write_text("\n".join(["diameter_mm,depth_um", *lines]))
    text = said(f"pinion.flank_csv={tmp_path / 'chart.csv'}")
    assert words in text and ("tip edges may" in text) == bool(words)


@pytest.mark.parametrize(("setting", "written"), [
    ("pinion.tip_relief_um=0.02", "20"), ("wheel.profile_crowning_um=0.005", "5"), ("wheel.root_relief_um=0.015", "15"),
    ("pinion.end_relief_um=0.03", "30"), ("pinion.lead_crowning_um=0.004", "4"),
])
def test_amounts_in_millimetres_are_refused(setting: str, written: str) -> None:
    """Amounts above 0 and below 0.1 µm, far below what can be ground: the message says what millimetres are in µm."""
    value = setting.partition("=")[2]
    with pytest.raises(SceneError, match=f"is {value} mm meant\\? Then write {written}; else give 0"):
        said(setting)
    key = setting.partition("=")[0]
    said(f"{key}=0.1"), said(f"{key}=0")


def test_check_warns_of_a_relief_that_may_fold_the_mesh() -> None:
    """A relief that `run` refuses because it folds the one fine mesh of a sector is named before."""
    one_mesh = "mesh.level=quick", 'exact.parts=["two-level"]'
    text = overview(load_scene("demos/yang2022.toml", [*one_mesh, "pinion.tip_relief_um=500"]))
    assert "The mesh may fold, which `run` then refuses: pinion.tip_relief_um: found 500" in text
    assert "fold" not in overview(load_scene("demos/yang2022.toml", ["pinion.tip_relief_um=20"]))


def test_run_warns_of_modifications_before_it_computes(
    tmp_path: object, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The warning comes first: with 1 mm of misalignment three minutes of searching ended without a result."""

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("evolvent.run.kinds.run.kept_pitch", stop)
    command = ["run", "demos/he2022.toml", "--quiet", "--set", "pair.misalignment_um=1000", "--out", f"{tmp_path}/out"]
    assert main(command) == Exit.FAILED
    said_first = capsys.readouterr().err
    assert "warning: pair.misalignment_um = 1000 (µm): the flanks bear on about 10 %" in said_first
    assert "warning: No tip relief: tip edges may bear" in said_first
