"""Vibrations that are refused by geometry alone, before any contact is solved, on He's pair."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from evolvent.check.check_report import overview
from evolvent.commands.app import main
from evolvent.dynamics.modes import static_shapes
from evolvent.dynamics.of_scene import backlash_problem, operating_point
from evolvent.gears import gear_model
from evolvent.run.computation import Computation
from evolvent.run.kinds.dynamics import Dynamics
from evolvent.run.kinds.run import Run
from evolvent.scene.scene import Scene, load_scene
from evolvent.scene.schema.errors import SceneError
from evolvent_meshes.errors import InputError
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import QUIET


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/he2022_dynamics.toml", [*QUIET, "sweep.positions=10", *settings])


def test_too_little_backlash_is_said_before_contact_is_solved(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Flanks that stand 10 µm proud on both sides, backlash 0: refused by geometry alone, with status 2, and no file is
    left; `check` has the same figure, and with what is asked for the scene is taken."""
    (tmp_path / "proud.csv").write_text("diameter_mm,depth_um\n140,-10\n157,-10\n")
    proud = f'pinion.flank_csv="{tmp_path / "proud.csv"}"'
    monkeypatch.setattr(gear_model, "condensed_gears", None)
    with pytest.raises(SceneError, match=r"found 0 µm, 20(\.\d)? µm less than unloaded errors") as error:
        quietly(Dynamics.of(scene(proud, "dynamics.backlash_um=0")), tmp_path / "out")
    assert not (tmp_path / "out").exists()
    assert f"{error.value}" in overview(scene(proud, "dynamics.backlash_um=0"))
    least = re.search(r"from (\S+) µm on", str(error.value))
    assert least and backlash_problem(scene(proud, f"dynamics.backlash_um={least[1]}")) is None


@pytest.mark.parametrize("computation", [Dynamics, Run])
def test_less_inertia_than_the_body_is_said_before_contact_is_solved(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, computation: type[Computation[Any]]
) -> None:
    """Elastic bodies move with all of their mass, 7.4e-3 kg m² of He's pinion: a given inertia below that is refused by
    geometry alone, before anything is meshed, by `evolvent dynamics` and by `evolvent run` at a speed, with rigid
    bodies as the remedy, which take it; `check` says so."""
    light = "dynamics.pinion_inertia_kg_m2=5e-3", "dynamics.operating_rpm=2000"
    monkeypatch.setattr(static_shapes, "body_mesh", None)
    with pytest.raises(InputError, match=r"dynamics\.pinion_inertia_kg_m2: wanted at least .*0\.0073.*rigid") as error:
        quietly(computation.of(scene(*light)), tmp_path / "out")
    assert not (tmp_path / "out").exists()
    assert f"would refuse this scene: {error.value}" in overview(scene(*light))
    rigid = scene(*light, 'dynamics.bodies="rigid"')
    assert "would refuse" not in overview(rigid) and operating_point(rigid) is not None


def test_a_refused_inertia_ends_with_status_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """From the command line, with the key and the remedy."""
    words = "--set", "dynamics.wheel_inertia_kg_m2=5e-3", "--out", str(tmp_path / "out"), "--quiet"
    assert main(["dynamics", str(ROOT / "demos/he2022_dynamics.toml"), *words]) == 2
    said = capsys.readouterr().err
    assert "dynamics.wheel_inertia_kg_m2" in said and 'take dynamics.bodies = "rigid"' in said


@pytest.mark.parametrize(
    ("settings", "named"),
    [
        ((), False),  # the reference centre distance
        (("pair.centre_distance_mm=150.0005",), False),  # rounding
        (("dynamics.backlash_um=60",), True),
        (("pair.centre_distance_mm=150.1",), True),
        (("pinion.tooth_thickness_allowance_um=-60",), True),
    ],
)
def test_somebody_names_the_backlash(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, settings: tuple[str, ...], named: bool
) -> None:
    """A scene whose vibration would be that of a pair without backlash, because nobody has given one, is refused before
    anything is computed, by `evolvent dynamics` and by `evolvent run` at a speed, with the keys that give one. Once, it
    was computed without any, and showed no free flight and no jump."""
    given = load_scene(ROOT / "demos/he2022.toml", [*QUIET, "dynamics.operating_rpm=2000", *settings])
    monkeypatch.setattr(gear_model, "condensed_gears", None)
    assert (backlash_problem(given) is None) == named
    if named:
        assert operating_point(given) is not None
        return
    computations: tuple[type[Computation[Any]], ...] = Dynamics, Run
    for computation in computations:
        with pytest.raises(SceneError, match=r"dynamics\.backlash_um: found nothing.*tooth_thickness.*centre_dist"):
            quietly(computation.of(given), tmp_path / "out")
        assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("setting", "key"),
    [
        ("dynamics.base_pitch_deviation_um=0", "dynamics.base_pitch_deviation_um"),
        ("dynamics.speed_rpm=[4000,500]", "dynamics.speed_rpm"),
        ("dynamics.torque_percents=[50,200]", "dynamics.torque_percents"),
        ("dynamics.torque_percents=[100,100]", "dynamics.torque_percents"),
        ("dynamics.damping_ratio=0", "dynamics.damping_ratio"),
        ("dynamics.pinion_inertia_kg_m2=-1", "dynamics.pinion_inertia_kg_m2"),
        ('dynamics.mesh="cubic"', "dynamics.mesh"),
        ("dynamics.histories_rpm=[3000,3000]", "dynamics.histories_rpm"),
        ("dynamics.histories_rpm=[-1]", "dynamics.histories_rpm"),
        ("dynamics.tolerance_class=13", "dynamics.tolerance_class"),
        ('dynamics.flank_surface="through_hardened"', "dynamics.contact_endurance_MPa"),
    ],
)
def test_wrong_keys_are_named(setting: str, key: str) -> None:
    with pytest.raises(SceneError, match=key):
        scene(setting)
