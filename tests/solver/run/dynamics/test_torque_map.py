"""The map over speed and torque: of a mesh in closed form, and of He's pair with few torques, positions and speeds."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.figures.all import VIBRATION_PICTURES
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.oscillator.steady_state import NoSteadyState
from evolvent.dynamics.pair_model import Drive, DriveSettings, MeshModel
from evolvent.dynamics.results.torque_map import TORQUE_MAP
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.run.dynamics import torque_map as module
from evolvent.run.dynamics.speeds import sweep_at
from evolvent.run.dynamics.torque_map import TorqueMap, torque_map
from evolvent.run.kinds.dynamics import Dynamics
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene
from evolvent.scene.schema.errors import SceneError
from evolvent_meshes.arrays import Floats
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly
from tests.support.computing.redrawn import redrawn
from tests.support.gear_cases import QUIET, spur_scene

PHASES = np.arange(12) / 12
STIFFNESS = 2.6e5 * (1.0 + 0.04 * np.cos(2.0 * np.pi * PHASES) + 0.02 * np.sin(4.0 * np.pi * PHASES))
LOADS, HEAVIEST = [250.0, 1000.0, 500.0], 2000.0
SPEEDS = np.linspace(2000.0, 6000.0, 15)
SETTINGS = (
    "output.pictures=true", "mesh.level=quick", "sweep.positions=10", "dynamics.torque_percents=[25,100,200]",
    "dynamics.speeds=30", "dynamics.map_speeds=30", "dynamics.speed_rpm=[1700,7000]", "dynamics.map_percents=[100,40]",
)


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/he2022_dynamics.toml", [*QUIET, *SETTINGS, *settings])


def rows(path: Path) -> list[dict[str, str]]:
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def linear_map(mesh: MeshModel, damping: float = 0.1) -> TorqueMap:
    """Of F = k(φ) x without unloaded error, solved at four other loads."""
    problem = gear_problem(spur_scene())
    forces = np.array([100.0, 400.0, 1100.0, HEAVIEST])
    stiffness = np.tile(STIFFNESS[:, None], len(forces))
    loaded = LoadedMesh(
        2.0 * np.pi / 50.0 * PHASES, problem.base_radius * forces, problem.base_radius, forces / stiffness, stiffness
    )
    settings = DriveSettings((7.65, 7.65), damping, 0.05, mesh=mesh)
    excitation = MeshExcitation(np.zeros(len(PHASES)), loaded)
    torques = [problem.base_radius * load for load in LOADS]
    return torque_map(excitation, problem, settings, torques, SPEEDS)


@pytest.mark.parametrize("mesh", ["force_surface", "tangent", "secant"])
def test_a_linear_mesh_answers_in_proportion_to_the_load(mesh: MeshModel) -> None:
    """m ẍ + c ẋ + k(φ) x = F_0, in contact throughout. Exact: x is in proportion to F_0, so that the amplitudes of
    250, 500 and 1000 N are as 1 : 2 : 4, the dynamic factor and the natural speed the same; 1e-7."""
    found = linear_map(mesh)
    assert found.warnings == ()
    assert len(found.rows) == 3 * 2 * len(SPEEDS)
    assert all(row.separated_share == row.back_contact_share == 0.0 for row in found.rows)
    over = {name: np.array([getattr(row, name) for row in found.rows]).reshape(3, -1) for name in (
        "torque_Nm", "elastic_equivalent_amplitude_um", "largest_force_N", "dynamic_factor", "natural_speed_rpm",
        "speed_rpm",
    )}
    for name in ("torque_Nm", "elastic_equivalent_amplitude_um", "largest_force_N"):
        assert over[name][1] == pytest.approx(2.0 * over[name][0], rel=1e-7)
        assert over[name][2] == pytest.approx(4.0 * over[name][0], rel=1e-7)
    for name in ("dynamic_factor", "natural_speed_rpm", "speed_rpm"):
        assert over[name][1:] == pytest.approx(np.tile(over[name][0], (2, 1)), rel=1e-7)
    assert over["dynamic_factor"].max() > 1.15


def test_forces_beyond_the_surface_are_said() -> None:
    """Lightly damped, the mesh force under 1000 N is more than 2000 N, under less it is not: its torque alone is
    named. With a stiffness there is no surface to leave."""
    found = linear_map("force_surface", 0.01)
    largest = [max(row.largest_force_N for row in found.rows[i : i + 30]) for i in (0, 30, 60)]
    assert largest[1] < HEAVIEST < largest[2]
    (said,) = found.warnings
    torque = found.rows[-1].torque_Nm
    assert said.startswith("torque_map.csv: the largest mesh force is beyond")
    assert f"under {torque:.4g} N·m ({largest[2] / HEAVIEST:.3g} times); there" in said
    assert linear_map("tangent", 0.01).warnings == ()


def test_a_load_that_fails_leaves_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """No steady state under 500 N: its torque is named, the rows of the other two stand."""

    def failing(pair: Drive, speeds: Floats) -> SpeedSweep:
        if pair.model.load == pytest.approx(500.0):
            raise NoSteadyState("branch: wanted a next one, found none")
        return sweep_at(pair, speeds)

    whole = linear_map("tangent")
    monkeypatch.setattr(module, "sweep_at", failing)
    found = linear_map("tangent")
    torques = sorted({row.torque_Nm for row in whole.rows})
    assert [row for row in whole.rows if row.torque_Nm != torques[1]] == list(found.rows)
    assert found.warnings == (
        f"torque_map.csv: nothing under {torques[1]:.4g} N·m: branch: wanted a next one, found none",
    )


def test_without_rows_there_is_no_picture(tmp_path: Path) -> None:
    """Where no load has steady states nothing is drawn; of one with them a picture is."""
    TORQUE_MAP.write(RunFolder(tmp_path), [])
    assert list(from_tables(VIBRATION_PICTURES, tmp_path)) == []
    TORQUE_MAP.write(RunFolder(tmp_path), linear_map("tangent").rows)
    (picture,) = from_tables(VIBRATION_PICTURES, tmp_path)
    assert picture.name == "torque_map.png" and picture.draw().startswith(b"\x89PNG")


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """He's pair at its torque and at two fifths of it."""
    folder, one = tmp_path_factory.mktemp("dynamics"), scene()
    assert one.dynamics is not None
    quietly(Dynamics.of(one), folder)
    return folder


def test_plot_draws_the_map_again(out: Path, tmp_path: Path) -> None:
    """From the tables alone, byte by byte."""
    assert redrawn(out, tmp_path) == {"excitation.png", "vibration.png", "waterfall.png", "torque_map.png"}


def test_line_of_the_scenes_torque_is_the_response(out: Path) -> None:
    """At the same speeds, up and down, with jumps between: every column that both tables have, to the last digit; the
    natural speed is that of dynamics.json."""
    response = rows(out / "response.csv")
    found = [row for row in rows(out / "torque_map.csv") if float(row["torque_Nm"]) == pytest.approx(170.0)]
    assert any(row["jumped"] == "True" for row in response)
    both = set(response[0]) & set(found[0])
    assert len(both) == 9
    assert [{name: row[name] for name in both} for row in found] == [
        {name: row[name] for name in both} for row in response
    ]
    natural = json.loads((out / "dynamics.json").read_text(encoding="utf-8"))["natural_speed_rpm"]
    assert [float(row["natural_speed_rpm"]) for row in found] == pytest.approx([natural] * 60, rel=1e-8)


def test_a_lighter_torque_has_a_softer_mesh(out: Path) -> None:
    """Between the torques that were solved: 68 N·m come first, at the same speeds; contact stiffens with the load, so
    that the natural speed is lower, by less than a tenth."""
    lines = rows(out / "torque_map.csv")
    light, heavy = lines[:60], lines[60:]
    assert [float(row["torque_Nm"]) for row in light] == pytest.approx([68.0] * 60)
    assert [(row["speed_rpm"], row["way"]) for row in light] == [(row["speed_rpm"], row["way"]) for row in heavy]
    low, high = float(light[0]["natural_speed_rpm"]), float(heavy[0]["natural_speed_rpm"])
    assert 0.9 * high < low < high
    assert (out / "pictures/torque_map.png").stat().st_size > 20_000


@pytest.mark.parametrize(
    "percents",
    ["[100]", "[50,50]", "[0.5,100]", "[100,401]", "[50,201]", "[1,2,3,4,5,6,7,8,9,10,11,12,13]"],
)
def test_wrong_maps_are_named(percents: str) -> None:
    """Too few, one twice, too light, too heavy, heavier than the force surface, too many."""
    with pytest.raises(SceneError, match=r"dynamics\.map_percents"):
        scene("dynamics.torque_percents=[100,200]", f"dynamics.map_percents={percents}")


def test_a_map_may_reach_the_heaviest_torque() -> None:
    """200 % on a surface that ends there is allowed; by default there is no map."""
    one, plain = scene("dynamics.map_percents=[1,200]"), load_scene(ROOT / "demos/he2022_dynamics.toml", QUIET)
    assert one.dynamics is not None and one.dynamics.map_percents == (1.0, 200.0)
    assert plain.dynamics is not None and plain.dynamics.map_percents == ()
