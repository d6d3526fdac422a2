"""`evolvent transient` on He's pair in plane strain: its tables, picture, refusals and ranks."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evolvent.commands.app import main
from evolvent.dynamics.transient.back_flanks import BackFlanks
from evolvent.dynamics.transient.certificates import Unbalanced
from evolvent.dynamics.transient.step_balance import StepBalance, StepEnd, StepEnergies
from evolvent.gears.solution.certificates import PitchImbalance
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.run.kinds.transient import Transient
from evolvent.scene.scene import Scene, SceneError, load_scene
from evolvent_meshes.errors import InputError
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly

POSITIONS = 10
SETTINGS = (
    "mesh.level=quick", "sweep.positions=10", "contact.friction=[0.0,0.2]", "transient.speeds_rpm=[30,2000]",
    "transient.spectral_radius=0.0", "dynamics.backlash_um=50", "transient.drive=constant_speed",
    "output.animation=false",
)


def scene(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/he2022.toml", [*SETTINGS, *settings])


def rows(path: Path) -> list[dict[str, float]]:
    with open(path, encoding="utf-8") as stream:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("transient")
    tips, slow, fast, few = quietly(Transient.of(scene()), folder)
    assert tips.startswith("No tip relief")
    assert slow.startswith("30 r/min: the pair's own vibration")
    assert "error bars may not hold" in slow and "error bars" not in fast
    assert fast.startswith("2000 r/min: the pair's own vibration")
    assert "elements across the contact (median): below 2" in few
    return folder


def test_tables_have_every_speed_and_coefficient(out: Path) -> None:
    """Two speeds, two coefficients, ten positions; the picture is there; angles ascend over one pitch of 7.2°."""
    found = rows(out / "transient.csv")
    assert len(found) == 2 * 2 * POSITIONS
    assert (out / "pictures/transient.png").stat().st_size > 10_000
    for speed in (30.0, 2000.0):
        for friction in (0.0, 0.2):
            own = [row for row in found if (row["speed_rpm"], row["friction"]) == (speed, friction)]
            assert [row["pinion_angle_deg"] for row in own] == pytest.approx(0.72 * np.arange(POSITIONS))


def test_slow_rotation_stands_beside_equal_statics(out: Path) -> None:
    """30 r/min: transmission errors within 0.5 % of their largest, pressures within 1 % of those without inertia, also
    forces of each tooth."""
    slow = [row for row in rows(out / "transient.csv") if row["speed_rpm"] == 30.0]
    largest = max(row["static_transmission_error_um"] for row in slow)
    for row in slow:
        calm = row["static_transmission_error_um"]
        assert row["transmission_error_um"] == pytest.approx(calm, abs=0.005 * largest)
        assert row["max_pressure_MPa"] == pytest.approx(row["static_max_pressure_MPa"], rel=0.01)
    teeth = [row for row in rows(out / "transient_teeth.csv") if row["speed_rpm"] == 30.0]
    largest = max(row["normal_force_N"] for row in teeth)
    for row in teeth:
        assert row["normal_force_N"] == pytest.approx(row["static_normal_force_N"], abs=0.01 * largest)


def test_teeth_share_the_force(out: Path) -> None:
    """Without friction the normal forces of all teeth at a position are the mesh force, 20 mm wide: within 1 %."""
    whole, teeth = rows(out / "transient.csv"), rows(out / "transient_teeth.csv")
    for row in (row for row in whole if row["friction"] == 0.0):
        force = sum(
            each["normal_force_N"]
            for each in teeth
            if (each["speed_rpm"], each["friction"]) == (row["speed_rpm"], 0.0)
            and abs((each["tooth_angle_deg"] - row["pinion_angle_deg"] + 3.6) % 7.2 - 3.6) < 1e-6
        )
        assert force == pytest.approx(row["mesh_force_N"], rel=0.01)


def test_facts(out: Path) -> None:
    """All motions are steady, their mean mesh force is 170 N·m over the base radius within 1 %; at 2000 r/min the mesh
    force rises by more than 10 %, at 30 r/min by less than 1 %."""
    facts = json.loads((out / "transient.json").read_text())
    assert [(fact["speed_rpm"], fact["friction"]) for fact in facts] == [
        (30.0, 0.0), (30.0, 0.2), (2000.0, 0.0), (2000.0, 0.2)]
    for fact in facts:
        assert fact["steady"]
        assert fact["last_change"] <= 0.005
        assert fact["load_N"] == pytest.approx(2412.1, rel=1e-4)
        assert fact["mean_force_N"] == pytest.approx(fact["load_N"], rel=0.01)
        assert fact["separated"] == 0.0
        step = 60.0 / fact["speed_rpm"] / 50 / POSITIONS
        assert fact["steps_per_natural_period"] == pytest.approx(1.0 / (fact["natural_frequency_Hz"] * step))
        assert (fact["dynamic_factor"] > 1.1) == (fact["speed_rpm"] == 2000.0)
        assert (fact["dynamic_factor"] < 1.01) == (fact["speed_rpm"] == 30.0)


def test_facts_have_balances_and_losses(out: Path) -> None:
    """Momentum, reaction and the motion's energy to 1e-12 at every time step, what a step leaves without account below
    1 %, a mesh period below 0.1 %; damping and time scheme take out less than 0.1 % of what the load passes on,
    friction nothing or 1 to 5 %."""
    for fact in json.loads((out / "transient.json").read_text()):
        assert max(fact["momentum_error"], fact["reaction_error"], fact["motion_energy_error"]) < 1e-12
        assert 0.0 < fact["moment_error"] < 1e-4
        assert 0.0 < fact["period_energy_error"] < 1e-3
        assert 0.0 < fact["step_energy_error"] < 1e-2
        assert 0.0 < fact["damping_loss"] < 1e-3
        assert 0.0 < fact["numerical_loss"] < 1e-3
        assert (0.01 < fact["friction_loss"] < 0.05) == (fact["friction"] == 0.2)


def test_a_motion_out_of_balance_ends_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Energies of steps that all leave 2 % without account, as of a coarse mesh: the steady motion is refused, nothing
    is written, and the command ends with status 3."""
    right = StepBalance.energies

    def leaking(balance: StepBalance, before: StepEnd | None) -> StepEnergies:
        energies = right(balance, before)
        return replace(energies, rotation=energies.rotation + 0.02 * energies.passed)

    monkeypatch.setattr(StepBalance, "energies", leaking)
    words = ["transient", str(ROOT / "demos/he2022.toml"), "--out", str(tmp_path), "--quiet"]
    for setting in (*SETTINGS, "transient.speeds_rpm=[2000]", "contact.friction=0"):
        words += ["--set", setting]
    assert main(words) == Unbalanced.exit_status == 3
    assert not (tmp_path / "transient.csv").exists()
    assert not list((tmp_path / "results").glob("transient_*rpm_*.npz"))


def test_statics_out_of_balance_end_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Friction that takes twice as much: the pitch without inertia loses energy, and no table is written."""
    right = vars(PositionResult)["friction_loss"].fget
    monkeypatch.setattr(PositionResult, "friction_loss", property(lambda result: 2.0 * right(result)))
    with pytest.raises(PitchImbalance, match="wanted an energy balance"):
        quietly(Transient.of(scene("transient.speeds_rpm=[2000]")), tmp_path)
    assert not list(tmp_path.glob("*.csv"))


def test_a_motion_that_does_not_repeat_yet_is_named(tmp_path: Path) -> None:
    """Two mesh periods of a lightly damped pair from statics are not enough; the motion is drawn all the same."""
    few = scene("transient.speeds_rpm=[2000]", "contact.friction=0", "transient.mesh_periods=2",
                "dynamics.damping_ratio=0.01", "output.error_bars=false", "output.animation=true")
    said = quietly(Transient.of(few), tmp_path)
    assert "not steady after 2 mesh periods" in said[1]
    assert (tmp_path / "pictures/field_of_action.gif").stat().st_size > 10_000


@pytest.mark.evidence
def test_back_flanks_are_refused(tmp_path: Path) -> None:
    """Near resonance with hardly damping the pair is thrown apart further than a backlash of 1 µm."""
    thrown = scene("transient.speeds_rpm=[4200]", "contact.friction=0", "dynamics.damping_ratio=0.005",
                   "dynamics.backlash_um=1", "transient.spectral_radius=0.9", "transient.drive=free")
    with pytest.raises(BackFlanks, match="back flanks"):
        quietly(Transient.of(thrown), tmp_path)
    assert not (tmp_path / "transient.csv").exists()


def test_scenes_that_cannot_be_computed(tmp_path: Path) -> None:
    """No section; two positions."""
    bare = load_scene(ROOT / "demos/he2022.toml", ["mesh.level=quick"])
    with pytest.raises(InputError, match=r"transient\.speeds_rpm"):
        quietly(Transient.of(bare), tmp_path)
    with pytest.raises(SceneError, match=r"sweep\.positions"):
        quietly(Transient.of(scene("sweep.positions=2")), tmp_path)


def test_command_line_without_a_speed_ends_with_status_2(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Of a scene without the section: what is wanted, and nothing is written."""
    words = ["transient", str(ROOT / "demos/he2022.toml"), "--out", str(tmp_path), "--level", "quick"]
    assert main(words) == 2
    assert "transient.speeds_rpm" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
