"""`evolvent strength` on Zhang's pair in plane strain: its tables, picture, refusals and ranks."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from evolvent.commands.app import main
from evolvent.gears.gear_model import Preparation
from evolvent.results.archive.run_folder import FolderError
from evolvent.results.archive.run_lock import locked
from evolvent.run.folder_checks import STUDY
from evolvent.run.kinds.strength import Strength
from evolvent.run.strength.pitch_roots import root_meshes
from evolvent.scene.scene import Scene, SceneError, load_scene
from evolvent_meshes.errors import InputError
from evolvent_meshes.mesh.mesh_data import MeshError
from tests.support.checkout import ROOT
from tests.support.computing.quiet import prepared_without, quietly

GAUGE = (
    'strength.gauges.gear=["pinion"]', 'strength.gauges.side=["loaded"]', "strength.gauges.angle_deg=[45.0]",
    "strength.gauges.height_mm=[0.0]", "strength.gauges.length_mm=[0.02]",
)
SETTINGS = "pinion.face_width_mm=25", "mesh.level=quick", "sweep.positions=12", "output.animation=false"


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/zhang2023.toml", [*SETTINGS, *settings])


def rows(path: Path) -> list[dict[str, str]]:
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With error bars; said is what `run` says of the tips, and what it means for roots."""
    folder = tmp_path_factory.mktemp("strength")
    plain, bears = quietly(Strength.of(scene()), folder)
    assert plain.startswith("No tip relief: tip edges may bear")
    assert bears.startswith("Tip-edge contact at ") and " of 12 positions, on teeth with up to " in bears
    assert "stresses at the roots rest on contact of edges" in bears
    return folder


def test_relieved_tips_that_do_not_bear_are_no_warning(tmp_path: Path) -> None:
    """Nothing is said of gears with tip relief whose edges do not bear."""
    relieved = "pinion.tip_relief_um=60", "wheel.tip_relief_um=60", "output.error_bars=false", "output.pictures=false"
    said = quietly(Strength.of(scene("sweep.positions=4", *relieved)), tmp_path)
    assert not any("Tip-edge contact" in each or "No tip" in each for each in said)


@pytest.mark.parametrize(("gear", "paper", "b"), [("pinion", 490.6, 530.1), ("wheel", 487.01, 546.5)])
def test_all_ways_stand_side_by_side(out: Path, gear: str, paper: float, b: float) -> None:
    """Both editions, six points of load, the largest over the path, tension and compression, tension at b: the paper's
    point b to 0.1 %; tension within 10 % of the paper's finite elements, with an error bar below 2 %; less at b, at the
    rotation of the formula."""
    own = {row["method"]: row for row in rows(out / "strength.csv") if row["gear"] == gear}
    assert len(own) == 2 + 6 + 1 + 3
    assert float(own["equal shares, outer point of double contact (b)"]["stress_MPa"]) == pytest.approx(b, rel=1e-3)
    tension = own["finite elements, tension"]
    assert float(tension["stress_MPa"]) == pytest.approx(paper, rel=0.1)
    assert 0.0 < float(tension["stress_MPa_error"]) < 0.02 * float(tension["stress_MPa"])
    assert float(own["finite elements, compression"]["stress_MPa"]) < -float(tension["stress_MPa"])
    methods = "equal shares", "finite elements, tension"
    at_b = [own[f"{method}, outer point of double contact (b)"] for method in methods]
    assert float(at_b[1]["stress_MPa"]) < float(tension["stress_MPa"])
    for row in own.values():  # formulas and finite elements alike: the part of the load, and the stress with all of it
        assert 0.0 < float(row["load_share"]) <= 1.0
        whole = float(row["stress_MPa"]) / float(row["load_share"])
        assert float(row["whole_load_MPa"]) == pytest.approx(whole, rel=0.1 if "finite" in row["method"] else 1e-8)
    assert float(at_b[1]["tooth_rotation_deg"]) == pytest.approx(float(at_b[0]["tooth_rotation_deg"]), abs=1e-7)


def test_table_over_the_rotation_has_the_peaks(out: Path) -> None:
    """The largest tension and the smallest pressure of root_stress.csv are those of strength.csv, at their rotations;
    rotations rise."""
    for gear in ("pinion", "wheel"):
        own = [row for row in rows(out / "root_stress.csv") if row["gear"] == gear]
        angles = np.array([float(row["tooth_rotation_deg"]) for row in own])
        assert (np.diff(angles) > 0.0).all()
        peaks = {row["method"]: row for row in rows(out / "strength.csv") if row["gear"] == gear}
        for name, best in (("tension", np.argmax), ("compression", np.argmin)):
            values = np.array([float(row[f"{name}_MPa"]) for row in own])
            peak, k = peaks[f"finite elements, {name}"], int(best(values))
            assert float(peak["stress_MPa"]) == pytest.approx(values[k], rel=1e-8)
            assert float(peak["tooth_rotation_deg"]) == pytest.approx(angles[k], abs=1e-7)
    assert (out / "pictures/root_stress.png").stat().st_size > 20_000


def test_editions_and_tolerance_class_are_the_scenes(tmp_path: Path) -> None:
    """One edition, of 2006, with a tolerance class of 4: twice the 328.0 MPa of equal shares at d, times Y_DT; without
    error bars these are unknown."""
    one = scene("strength.editions=[2006]", "strength.tolerance_class=4", "output.error_bars=false")
    quietly(Strength.of(one), tmp_path)
    found = rows(tmp_path / "strength.csv")
    assert [row["method"] for row in found if row["method"].startswith("ISO")] == ["ISO 6336-3:2006"] * 2
    assert float(found[0]["stress_MPa"]) == pytest.approx(656.0 * (2.366 - 0.666 * 2.14131), rel=3e-4)
    assert {row["stress_MPa_error"] for row in found} == {"nan"}


def test_a_short_gauge_finds_the_stress(tmp_path: Path) -> None:
    """At 45° of the pinion's loaded side, where the tension is largest: E/(1 − ν²) times its largest strain is that
    stress, 1 %, with an error bar; a gauge that is longer than the root is refused before anything is solved."""
    quietly(Strength.of(scene(*GAUGE)), tmp_path)
    tension = next(row for row in rows(tmp_path / "strength.csv") if row["method"] == "finite elements, tension")
    strains = rows(tmp_path / "gauges.csv")
    largest = max(strains, key=lambda row: float(row["strain_um_per_m"]))
    stress = 212e3 / (1.0 - 0.289**2) * 1e-6 * float(largest["strain_um_per_m"])
    assert stress == pytest.approx(float(tension["stress_MPa"]), rel=0.01)
    assert 0.0 < float(largest["strain_um_per_m_error"]) < 0.03 * float(largest["strain_um_per_m"])
    with pytest.raises(InputError, match="strain gauge"):
        quietly(Strength.of(scene(*GAUGE, "strength.gauges.length_mm=[30.0]")), tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_companion_that_fails_costs_the_error_bars_only(tmp_path: Path) -> None:
    """Tables as without, and a sentence with the reason."""

    coarse = root_meshes(scene())[1].mesh
    *_, said = quietly(Strength.of(scene()), tmp_path, prepare=prepared_without(coarse, MeshError("too coarse")))
    assert said == "Error bars: their coarse companion could not be solved: too coarse"


def test_a_folder_in_use_is_refused(tmp_path: Path) -> None:
    """Another run computes into the folder: refused before anything is meshed."""
    with locked(tmp_path), pytest.raises(FolderError, match="computes into, found process"):
        quietly(Strength.of(scene()), tmp_path, prepare=meshed_in_vain)


def test_the_folder_of_a_study_is_refused(tmp_path: Path) -> None:
    """Before anything is meshed, also with --overwrite: the table of the study is of other scenes."""
    (tmp_path / STUDY).write_text("{}")
    with pytest.raises(FolderError, match=r"found a study \(study\.json\); allowed: a folder without"):
        quietly(Strength.of(scene()), tmp_path, overwrite=True, prepare=meshed_in_vain)


def meshed_in_vain(*_: object) -> Preparation:
    pytest.fail("meshed")


@pytest.mark.parametrize(
    "setting",
    [
        "strength.editions=[]", "strength.editions=[2006,2006]", "strength.editions=[2012]",
        "strength.tolerance_class=0", "strength.root_refinement=0",
    ],
)
def test_wrong_keys_are_named(setting: str) -> None:
    with pytest.raises(SceneError, match=setting.split("=")[0]):
        scene(setting)


def test_gauges_without_their_values_are_refused() -> None:
    """Two lengths for one gauge."""
    with pytest.raises(SceneError, match=r"strength\.gauges.*2 values"):
        scene(*GAUGE, "strength.gauges.length_mm=[0.5,0.5]")


def test_command_line(tmp_path: Path) -> None:
    """A narrow helical pair: the standard's virtual gears without a rotation, and no other formulas."""
    words = ["--set", "sweep.positions=2", "--set", "output.error_bars=false", "--set", "output.pictures=false"]
    pair = str(ROOT / "evidence/benchmarks/accuracy/scenes/narrow_helical.toml")
    more = ["--set", "mesh.elements_per_contact_width=0.5", "--set", "contact.friction=0", "--set", "mesh.order=1"]
    assert main(["strength", pair, "--out", str(tmp_path), "--quiet", *words, *more]) == 0
    found = rows(tmp_path / "strength.csv")
    assert len(found) == 2 * (2 + 2)
    assert {row["tooth_rotation_deg"] for row in found if row["method"].startswith("ISO")} == {"nan"}
