"""In which keys two scenes differ: named with both values, as a run that cannot be resumed says it."""

from __future__ import annotations

from pathlib import Path

import pytest

from evolvent.results.archive.archive import Archive
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.scene_files import write_scene
from evolvent.results.archive.store import ArchiveError, arrays_bytes
from evolvent.scene.differences import differences
from evolvent.scene.skips import with_deflected_flanks
from tests.support.gear_cases import spur_scene

CHART = "diameter_mm,depth_um\n140,0\n156,{depth}\n"


def test_differing_keys_are_named_with_both_values() -> None:
    """The torque alone; a section and a key that one of them lacks; of five keys the first three."""
    kept = spur_scene("load.torque_Nm=100")
    assert differences(kept, spur_scene("load.torque_Nm=171")) == "load.torque_Nm = 171 (kept: 100)"
    more = spur_scene("load.torque_Nm=100", "wear.cycles=1e4", "wear.pinion_mm2_per_N=1e-10", "pinion.hand=left")
    assert 'pinion.hand = "left" (kept: not given)' in differences(kept, more)
    five = ("mesh.order=1", "contact.friction=0.1", "sweep.positions=7", "pinion.tip_relief_um=3.0")
    found = differences(kept, spur_scene("load.torque_Nm=90", *five))
    assert found.count("(kept: ") == 3 and found.endswith(", 2 more")


def test_title_output_and_deflected_flanks_are_no_difference() -> None:
    """The title, the output, and deflected flanks, which a run has come to by itself."""
    scene = spur_scene()
    assert differences(scene, spur_scene("title='other'", "output.fields=true")) == ""
    kept = with_deflected_flanks(scene)
    assert kept != scene and differences(kept, scene) == ""
    assert differences(kept, spur_scene("load.torque_Nm=171")).count("(kept: ") == 1


def test_flank_charts_differ_by_content(tmp_path: Path) -> None:
    """One that says the same elsewhere is no other one."""
    for name, depth in (("a", 3), ("b", 3), ("c", 4)):
        (tmp_path / f"{name}.csv").write_text(CHART.format(depth=depth), encoding="utf-8")
    a, b, c = (spur_scene(f"wheel.flank_csv='{tmp_path / name}.csv'") for name in "abc")
    assert differences(a, b) == ""
    assert differences(a, c) == "another chart as wheel.flank_csv"


def test_refused_resume_names_the_difference(tmp_path: Path) -> None:
    """The keys; the version where none differs; that the kept scene cannot be read."""
    scene = spur_scene()
    RunFolder(tmp_path).write("results/state.npz", arrays_bytes({"fingerprint": "another one", "complete": 0}))
    write_scene(spur_scene("load.torque_Nm=100"), RunFolder(tmp_path))
    with pytest.raises(ArchiveError, match=r"another one: this one has load\.torque_Nm = 170 \(kept: 100\);"):
        Archive(tmp_path, scene).read_sweep(scene.gear_pair())
    write_scene(scene, RunFolder(tmp_path))
    with pytest.raises(ArchiveError, match="found those of another version of Evolvent: no key differs"):
        Archive(tmp_path, scene).read_sweep(scene.gear_pair())
    (tmp_path / "scene.toml").unlink()
    with pytest.raises(ArchiveError, match=r"scene\.toml cannot be read"):
        Archive(tmp_path, scene).read_sweep(scene.gear_pair())
