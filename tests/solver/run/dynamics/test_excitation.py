"""`evolvent excitation` on He's pair: what it writes, what it leaves alone, and what several ranks find."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest

from evidence.calls import temporary_call
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.results.archive.store import ArchiveError
from evolvent.run.dynamics.excitation import loaded_pitch
from evolvent.run.dynamics.scene_torques import scene_torques
from evolvent.run.kept_pitch import COMPANION
from evolvent.run.kinds.excitation import Excitation
from evolvent.scene.scene import SceneError
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshError
from tests.support.computing.quiet import prepared_without, quietly
from tests.support.gear_cases import model_of, spur_scene, swept

SETTINGS = "mesh.level=quick", "output.pictures=true", "sweep.positions=6"
PERCENTS = [50.0, 100.0]
TIPS = "No tip relief: tip edges may bear, as teeth deflect by about 8.5 µm; see tip_relief_um."
"""Warning under the heaviest torque."""


def rows(path: Path) -> list[dict[str, str]]:
    with open(path, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def column(lines: list[dict[str, str]], name: str) -> Floats:
    return np.array([float(line[name]) for line in lines])


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Under 50 and 100 % of the torque."""
    folder = tmp_path_factory.mktemp("excitation")
    (tips,) = quietly(Excitation.under(scene_torques(spur_scene(*SETTINGS), PERCENTS)), folder)
    assert tips == TIPS
    return folder


def test_table_has_what_a_sweep_finds(out: Path) -> None:
    """Transmission error and stiffness under the whole torque as a sweep on the same meshes has them, 1e-6; no unloaded
    error; the secant is the force over the deflection."""
    lines = rows(out / "excitation.csv")
    assert len(lines) == 12
    full = [line for line in lines if float(line["torque_Nm"]) == 170.0]
    (curves,) = swept(model_of(spur_scene(*SETTINGS)), column(full, "pinion_angle_deg"), [0.0])
    assert column(full, "transmission_error_um") == pytest.approx(1e3 * curves.of("transmission_error"), rel=1e-6)
    stiffness = 20.0e-3 * np.array([result.stiffness for result in curves.results])
    assert column(full, "tangent_stiffness_N_per_um") == pytest.approx(stiffness, rel=1e-6)
    assert column(lines, "unloaded_transmission_error_um") == pytest.approx(0.0, abs=1e-3)
    secant = column(lines, "mesh_force_N") / column(lines, "transmission_error_um")
    assert column(lines, "secant_stiffness_N_per_um") == pytest.approx(secant, rel=1e-3)
    assert column(full, "mesh_force_N") == pytest.approx(170e3 / 70.4769, rel=1e-5)


def test_harmonics_are_those_of_the_table(out: Path) -> None:
    """Two harmonics from six positions, of three quantities under two torques and of the unloaded error; the first one
    of the stiffness by its sum, 1e-7."""
    lines = rows(out / "harmonics.csv")
    assert len(lines) == 2 * (1 + 2 * 3)
    stiffness = [line for line in lines if line["quantity"].startswith("tangent") and float(line["torque_Nm"]) == 170.0]
    full = [line for line in rows(out / "excitation.csv") if float(line["torque_Nm"]) == 170.0]
    values = column(full, "tangent_stiffness_N_per_um")
    first = 2.0 * np.mean(values * np.exp(-2j * np.pi * np.arange(6) / 6))
    assert float(stiffness[0]["amplitude"]) == pytest.approx(abs(first), rel=1e-7)
    assert float(stiffness[0]["mean"]) == pytest.approx(values.mean(), rel=1e-7)
    assert float(stiffness[0]["peak_to_peak"]) == pytest.approx(np.ptp(values), rel=1e-7)
    assert (out / "pictures/excitation.png").stat().st_size > 20_000


def test_error_bars_come_from_a_coarse_companion(out: Path, tmp_path: Path) -> None:
    """Where they are asked for: of every position half the difference to the excitation on elements of twice the size,
    at least; the values stay, 1e-8; without the companion there are none."""
    loads = scene_torques(spur_scene(*SETTINGS, "output.error_bars=true"), PERCENTS)
    tips, large = quietly(Excitation.under(loads), tmp_path)
    assert tips == TIPS and large.startswith("Peak-to-peak values whose error bar exceeds a quarter of them: ")
    lines, plain = rows(tmp_path / "excitation.csv"), rows(out / "excitation.csv")
    angles = np.radians(column(lines[:6], "pinion_angle_deg"))
    with temporary_call() as call:
        coarse = loaded_pitch(call, loads, angles, COMPANION)
    for name, factor, values in (("transmission_error_um", 1e3, coarse.errors),
                                 ("tangent_stiffness_N_per_um", 1e-3, coarse.stiffness)):
        found, bars = column(lines, name), column(lines, f"{name}_error")
        assert found == pytest.approx(column(plain, name), rel=1e-8)
        assert (bars >= 0.5 * np.abs(found - factor * values.T.ravel()) - 1e-6).all()
        assert (bars < 0.1 * found).all()
        assert np.isnan(column(plain, f"{name}_error")).all()
    assert np.isfinite(column(rows(tmp_path / "harmonics.csv"), "amplitude_error")).all()


def test_companion_that_fails_costs_the_error_bars_only(tmp_path: Path) -> None:
    """Tables as without, and a sentence with the reason."""

    loads = scene_torques(spur_scene(*SETTINGS, "output.error_bars=true"), PERCENTS[:1])
    prepare = prepared_without(companion_mesh, MeshError("too coarse"))
    tips, said = quietly(Excitation.under(loads), tmp_path, prepare=prepare)
    assert said == "Error bars: their coarse companion could not be solved: too coarse"
    assert json.loads((tmp_path / "excitation.json").read_text(encoding="utf-8"))["warnings"] == [tips, said]
    assert np.isnan(column(rows(tmp_path / "excitation.csv"), "secant_stiffness_N_per_um_error")).all()


def test_positions_of_other_torques_are_refused(out: Path, tmp_path: Path) -> None:
    """Resumed with one torque less: what is stored belongs to the longer list."""
    loads = scene_torques(spur_scene(*SETTINGS), PERCENTS[:1])
    with pytest.raises(ArchiveError, match="found those of other gears, meshes, torques or positions"):
        quietly(Excitation.under(loads), copytree(out, tmp_path / "out"), resume=True)


def test_nothing_to_go_on_from_is_said(tmp_path: Path) -> None:
    """The call begins from the start, with a sentence."""
    loads = scene_torques(spur_scene(*SETTINGS, "sweep.positions=3"), PERCENTS[:1])
    said, _ = quietly(Excitation.under(loads), tmp_path, resume=True)
    assert said.startswith("--resume found nothing to continue")


def test_two_positions_are_too_few(tmp_path: Path) -> None:
    """Refused before anything is computed: they hold no harmonic."""
    loads = scene_torques(spur_scene(*SETTINGS, "sweep.positions=2"), PERCENTS)
    with pytest.raises(SceneError, match=r"sweep\.positions: found 2; allowed: 3 or more"):
        quietly(Excitation.under(loads), tmp_path)
    assert list(tmp_path.iterdir()) == []
