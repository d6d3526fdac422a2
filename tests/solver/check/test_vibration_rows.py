"""What `evolvent check` tells of the section [dynamics]."""

from __future__ import annotations

from pathlib import Path

import pytest

from evolvent.check.check_report import overview
from evolvent.check.vibration_rows import vibration_lines
from evolvent.scene.scene import load_scene
from tests.support.checkout import ROOT
from tests.support.gear_cases import spur_scene


def told(*settings: str) -> dict[str, tuple[str, ...]]:
    """Name of a line -> its values, of He's pair."""
    scene = load_scene(ROOT / "demos/he2022_dynamics.toml", settings)
    assert scene.dynamics is not None
    return {name.strip(): values for name, _, _, values in vibration_lines(scene, scene.dynamics)}


def test_figures_of_hes_pair() -> None:
    """Exact: m_e = I/(2 r_b²) of equal gears; ISO's natural speed 4566 r/min."""
    found = told()
    assert found["moment of inertia"] == ("0.00765", "0.00765")
    assert [float(each) for each in found["at the bore, beyond the body's"]] == pytest.approx([2.55e-4] * 2, rel=0.01)
    own = load_scene(ROOT / "demos/he2022.toml", ["dynamics.backlash_um=50"])
    assert own.dynamics is not None
    assert ("  at the bore, beyond the body's", "", "kg·m²", ("0", "0")) in vibration_lines(own, own.dynamics)
    assert float(found["equivalent mass along the line of action"][0]) == pytest.approx(0.7701, abs=1e-4)
    assert found["natural speed by c_γα of ISO 6336-1"] == ("4566",)
    assert found["positions × torques of the excitation"] == ("40 × 10",)
    assert found["lacking for unloaded errors"] == ("0",)
    assert told("dynamics.speed_rpm=[500,900]")["speeds"] == ("500", "900")


def test_proud_flanks_lack_backlash(tmp_path: Path) -> None:
    """10 µm of material too much on the pinion's flanks, on both sides of the teeth, at a backlash of 5 µm: 15 µm."""
    chart = tmp_path / "proud.csv"
    chart.write_text("diameter_mm,depth_um\n140,-10\n157,-10\n")
    found = told(f'pinion.flank_csv="{chart}"', "dynamics.backlash_um=5")
    assert float(found["lacking for unloaded errors"][0]) == pytest.approx(15.0, rel=1e-2)


def test_motions_and_their_time_are_told() -> None:
    """100 speeds, 400 with the three other excitations of error bars, a few seconds; slow speeds take as much longer
    as a mesh period has more natural ones. Without a backlash that somebody names there is none to be told."""
    found = told("dynamics.speeds=100")
    assert found["speeds, up and down"] == ("100",)
    assert found["with those on other excitations, for error bars"] == ("400",)
    (time,) = (value for name, value in told("output.error_bars=false").items() if "processor time" in name)
    assert time == ("6 s",)
    (slow,) = (value for name, value in told("dynamics.speed_rpm=[50,60]").items() if "processor time" in name)
    assert "min" in slow[0]
    bare = load_scene(ROOT / "demos/he2022.toml", ["dynamics.speeds=10"])
    assert bare.dynamics is not None
    rows = {name: values for name, _, _, values in vibration_lines(bare, bare.dynamics)}
    assert rows["backlash along the line of action"] == ("none is given",)


def test_table_is_printed_with_the_section_alone() -> None:
    """A scene without [dynamics] has no such table."""
    assert "\nVibration" in overview(load_scene(ROOT / "demos/he2022_dynamics.toml", []))
    assert "Vibration" not in overview(spur_scene())
