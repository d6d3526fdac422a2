"""`evolvent dynamics` on He's pair with few torques, positions and speeds."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest

from evolvent.cli import main
from evolvent.dynamics.oscillator.mesh_law import MeshLaw, behind, stepped_side
from evolvent.dynamics.oscillator.speed_sweep import speeds_to_periods, sweep_speeds
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent.dynamics.pair_model import Drive, geometric_backlash
from evolvent.run.dynamics.vibration import _not_followed, drive_settings, run_dynamics
from evolvent.run.load_list import load_scenes
from evolvent.scene.scene import Scene, load_scene
from evolvent.scene.schema.errors import SceneError
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair
from tests.support.checkout import ROOT
from tests.support.gear_cases import QUIET
from tests.support.running.processes import Run, on_ranks

SETTINGS = (
    "mesh.level=quick", "sweep.positions=10", "dynamics.torque_percents=[25,100,200]", "dynamics.speeds=60",
    "dynamics.speed_rpm=[2500,7000]",
)  # fmt: skip


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/he2022_dynamics.toml", [*QUIET, *SETTINGS, *settings])


def rows(path: Path) -> list[dict[str, str]]:
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With the force surface."""
    folder, one = tmp_path_factory.mktemp("dynamics"), scene()
    assert one.dynamics is not None
    loads = load_scenes(one, one.dynamics.torque_percents)
    (said,) = run_dynamics(list(loads.values()), one.dynamics, folder, quiet=True)
    assert said.startswith("dynamics.torque_percents: the largest mesh force is")
    return folder


def test_resonance_is_where_stiffness_and_inertia_put_it(out: Path) -> None:
    """The natural speed is √(k/m_e) 60/(2π z), and at 60 speeds the mesh force is largest within a fifth of it running
    up; above it the pair is isolated: K_v falls towards 1."""
    known = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))
    assert known["equivalent_mass_kg"] == pytest.approx(0.7701, rel=1e-4)
    natural = np.sqrt(1e6 * known["mean_stiffness_N_per_um"] / known["equivalent_mass_kg"]) * 60.0 / (2.0 * np.pi * 50)
    assert known["natural_speed_rpm"] == pytest.approx(natural, rel=1e-9)
    lines = rows(out / "response.csv")
    assert [line["way"] for line in lines] == ["up"] * 60 + ["down"] * 60
    up = lines[:60]
    factor = np.array([float(line["dynamic_factor"]) for line in up])
    assert float(up[int(np.argmax(factor))]["speed_rpm"]) == pytest.approx(natural, rel=0.2)
    assert 1.0 < factor[-1] < 1.2
    assert {line["repeats"] for line in lines} == {"1"}


def test_pairs_jump_at_the_folds(out: Path) -> None:
    """Running up, the jump is at the first speed above a fold; branch.csv marks as many as dynamics.json names."""
    folds = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))["folds_rpm"]
    assert sum(line["fold"] == "True" for line in rows(out / "branch.csv")) == len(folds) > 0
    speeds = np.linspace(2500.0, 7000.0, 60)
    jumps = [float(line["speed_rpm"]) for line in rows(out / "response.csv")[:60] if line["jumped"] == "True"]
    assert len(jumps) == 1
    assert any(0.0 <= jumps[0] - fold <= speeds[1] - speeds[0] for fold in folds)
    assert (out / "pictures/vibration.png").stat().st_size > 20_000
    assert (out / "excitation.csv").exists()


def test_settings_follow_from_the_gears() -> None:
    """Without inertia and backlash in the scene: those of steel bodies, and of the tooth thicknesses, which leave none
    at the reference centre distance; 0.1 mm more opens 2 · 0.1 mm · sin α along the line of action (ISO 21771), 1 %."""
    plain = load_scene(ROOT / "demos/he2022.toml", [*QUIET, "dynamics.speeds=2"])
    assert plain.dynamics is not None
    pair = plain.gear_pair()
    settings = drive_settings(pair, plain.dynamics)
    assert settings.inertias[0] == settings.inertias[1] == pytest.approx(7.4, rel=0.05)
    assert settings.backlash == pytest.approx(0.0, abs=1e-9)
    gear = GearParameters.from_rack(
        z=50, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=70.0
    )
    assert geometric_backlash(GearPair(gear, gear, 150.1)) == pytest.approx(0.2 * np.sin(np.radians(20.0)), rel=0.01)


def test_little_backlash_is_warned_of(tmp_path: Path) -> None:
    """That of the reference centre distance, none: the key and the static deflection are named."""
    one = scene("dynamics.backlash_um=0", 'dynamics.mesh="secant"', "dynamics.speeds=2")
    assert one.dynamics is not None
    loads = load_scenes(one, one.dynamics.torque_percents)
    (said,) = run_dynamics(list(loads.values()), one.dynamics, tmp_path, quiet=True)
    known = json.loads((tmp_path / "dynamics.json").read_text(encoding="utf-8"))
    deflection = known["static_force_N"] / known["mean_stiffness_N_per_um"]
    assert said.startswith(f"dynamics.backlash_um: found 0 µm, less than the static deflection of {deflection:.3g} µm")


def test_motions_that_grow_without_end_are_said() -> None:
    """A stiffness of two levels on both sides without backlash, a linear equation, of which Floquet's multipliers are
    above 1 from 0.81 to 0.84 of the natural speed: two sentences with these speeds, 2 %."""
    mass, stiffness, teeth = 0.77e-3, 258.6e3, 50
    side = stepped_side(np.array([0.0, 0.3, 1.0]), stiffness * np.array([1.6, 0.4]))
    natural = np.sqrt(stiffness / mass)
    model = TorsionalModel(mass, 2412.0, MeshLaw(side, behind(side, 0.0)), 0.02 * mass * natural)
    vibrating = Drive(model, stiffness, teeth)
    speeds = np.linspace(0.7, 0.95, 51) * vibrating.natural_speed
    pieces, gone = _not_followed(vibrating, sweep_speeds(model, speeds_to_periods(speeds, teeth)))
    found = re.match(r"steady states: found 2 pieces .* with ends at (\d+), (\d+) r/min\. branch", pieces)
    assert found is not None
    assert [float(each) for each in found.groups()] == pytest.approx(
        [0.81 * vibrating.natural_speed, 0.84 * vibrating.natural_speed], rel=0.02
    )
    growing = re.match(r"response\.csv: at \d of 51 speeds, from (\d+) to (\d+) r/min, the motion grows", gone)
    assert growing is not None
    assert [float(each) for each in growing.groups()] == pytest.approx(
        [0.81 * vibrating.natural_speed, 0.84 * vibrating.natural_speed], rel=0.02
    )


@pytest.mark.parametrize(
    ("setting", "key"),
    [
        ("dynamics.speed_rpm=[4000,500]", "dynamics.speed_rpm"),
        ("dynamics.torque_percents=[50,200]", "dynamics.torque_percents"),
        ("dynamics.torque_percents=[100,100]", "dynamics.torque_percents"),
        ("dynamics.damping_ratio=0", "dynamics.damping_ratio"),
        ("dynamics.pinion_inertia_kg_m2=-1", "dynamics.pinion_inertia_kg_m2"),
        ('dynamics.mesh="cubic"', "dynamics.mesh"),
    ],
)
def test_wrong_keys_are_named(setting: str, key: str) -> None:
    with pytest.raises(SceneError, match=key):
        scene(setting)


@pytest.mark.mpi
@pytest.mark.parametrize("ranks", on_ranks(2))
def test_ranks_find_the_same(run_script: Run, out: Path, tmp_path: Path, ranks: int) -> None:
    """Two ranks divide the positions of the excitation: the same response to 1e-4, and one line at the end."""
    code = "import sys; from evolvent.cli import main; sys.exit(main(sys.argv[1:]))"
    arguments = ["dynamics", "demos/he2022_dynamics.toml", "--out", str(tmp_path / "out")]
    for setting in SETTINGS:
        arguments += ["--set", setting]
    done = run_script("-c", code, *arguments, ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    assert done.stdout.count("done: ") == 1
    one, two = (
        np.array([float(line["largest_force_N"]) for line in rows(folder / "response.csv")])
        for folder in (out, tmp_path / "out")
    )
    assert two == pytest.approx(one, rel=1e-4)


def test_results_are_not_replaced_unasked(out: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Status 2 before anything is computed."""
    assert main(["dynamics", str(ROOT / "demos/he2022_dynamics.toml"), "--out", str(out)]) == 2
    assert "--overwrite" in capsys.readouterr().err
