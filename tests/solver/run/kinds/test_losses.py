"""`evolvent losses` on He's spur pair in plane strain: input power, tooth loss factor, warnings, refusals, picture."""

from __future__ import annotations

from pathlib import Path

import pytest

from evolvent.commands.app import main
from evolvent.gears.line.line_result import EdgeContact
from evolvent.results.archive.store import ArchiveError
from evolvent.results.drawing.style import png_of
from evolvent.run.kinds.losses import LOSSES, Losses, LossRow, losses_figure
from evolvent.scene.scene import SceneError
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import QUIET, spur_scene

SMALL = (*QUIET, "mesh.level=quick", "sweep.positions=4", "contact.friction=0.3")


def rows(folder: Path, *settings: str, percents: tuple[float, ...] = (100.0,)) -> list[LossRow]:
    quietly(Losses.of(spur_scene(*SMALL, *settings), percents), folder)
    return LOSSES.read(folder)


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_power_is_that_of_the_gear_with_the_torque(tmp_path: Path, gear: str) -> None:
    """170 N·m on either gear of a pair 50/50 at 1000 r/min are 17802.4 W. On the pinion they are the input; on the
    wheel they are what is left of it after the loss, so that the input is 1/(1 − loss) times as much."""
    (row,) = rows(tmp_path, f"load.on={gear}")
    held = 17802.3584
    assert row.torque_on == gear and 2.0 < row.loss_percent < 4.0
    delivered = row.input_at_1000_rpm_W - (row.loss_at_1000_rpm_W if gear == "wheel" else 0.0)
    assert delivered == pytest.approx(held, rel=1e-7)
    assert row.loss_at_1000_rpm_W == pytest.approx(0.01 * row.loss_percent * row.input_at_1000_rpm_W, rel=1e-7)


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_power_of_a_driving_wheel(tmp_path: Path, gear: str) -> None:
    """The wheel drives: 170 N·m on it are the input, on the pinion what is left of it; the loss is the same but for the
    share of the torque, 2 %."""
    (row,) = rows(tmp_path / "one", f"load.on={gear}", "load.driving=wheel")
    delivered = row.input_at_1000_rpm_W - (row.loss_at_1000_rpm_W if gear == "pinion" else 0.0)
    assert delivered == pytest.approx(17802.3584, rel=1e-7)
    (other,) = rows(tmp_path / "other", f"load.on={gear}")
    assert row.loss_percent == pytest.approx(other.loss_percent, rel=0.02)


def test_tooth_loss_factor_stands_beside_the_formula(tmp_path: Path) -> None:
    """Loss over μ; within a tenth of Ohlendorf's 0.0986 for equal shares. Without friction it is not known."""
    without, with_friction = rows(tmp_path, "contact.friction=[0.0,0.3]")
    assert with_friction.tooth_loss_factor == pytest.approx(0.01 * with_friction.loss_percent / 0.3, rel=1e-7)
    assert with_friction.tooth_loss_factor == pytest.approx(with_friction.ohlendorf_loss_factor, rel=0.1)
    assert without.loss_percent == 0.0 and without.tooth_loss_factor != without.tooth_loss_factor


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_errors_follow_from_that_of_the_loss(tmp_path: Path, gear: str) -> None:
    """With input P on the pinion the power P l has the error P δl; with P delivered by the wheel it is P l/(1 − l), and
    its derivative P/(1 − l)². The loss factor has that of the loss over μ."""
    (row,) = rows(tmp_path, f"load.on={gear}", "output.error_bars=true")
    loss, error = 0.01 * row.loss_percent, 0.01 * row.loss_percent_error
    left = 1.0 - loss if gear == "wheel" else 1.0
    assert 0.0 < error < loss
    assert row.loss_at_1000_rpm_W_error == pytest.approx(row.input_at_1000_rpm_W / left * error, rel=1e-6)
    assert row.tooth_loss_factor_error == pytest.approx(error / 0.3, rel=1e-6)


def test_warnings_are_those_of_the_heaviest_torque(tmp_path: Path) -> None:
    """Deflection under twice the torque, twice 8.5 µm; edges that bear, spacing, and an operating speed are said."""
    speed = "dynamics.operating_rpm=3000", "dynamics.backlash_um=50", "sweep.positions=8"
    said = quietly(Losses.of(spur_scene(*SMALL, *speed), (50.0, 200.0)), tmp_path)
    assert any("tip edges may bear, as teeth deflect by about 17 µm" in each for each in said)
    assert any(each.startswith("Tip-edge contact at ") and "under 340 N·m" in each for each in said)
    assert any(each.startswith("under 340 N·m: Positions are 0.90° apart") for each in said)
    assert any(each.startswith("dynamics.operating_rpm: without effect on losses.csv") for each in said)


def test_loads_that_edges_bear_are_left_out_in_line_contact(tmp_path: Path) -> None:
    """Problem: reliefs of 4 µm, used up by the whole torque of He's pair but not by a tenth of it. Right: the light
    load has its row, a sentence says why the others have none; an error where there is no other load."""
    settings = ("pinion.tip_relief_um=4", "wheel.tip_relief_um=4", "mesh.level=line", "sweep.positions=8")
    said = quietly(Losses.of(spur_scene(*SMALL, *settings), (10.0, 100.0, 120.0)), tmp_path / "some")
    assert [row.torque_Nm for row in LOSSES.read(tmp_path / "some")] == [17.0]
    (left_out,) = [sentence for sentence in said if sentence.startswith("Loads from 170 N·m on are left out")]
    assert "relieve the tips" in left_out
    with pytest.raises(EdgeContact):
        quietly(Losses.of(spur_scene(*SMALL, *settings), (100.0,)), tmp_path / "none")


def test_a_picture_without_error_bars(tmp_path: Path) -> None:
    """Drawn from rows whose errors are NaN."""
    assert png_of(losses_figure, "pair", rows(tmp_path)).startswith(b"\x89PNG")


def test_without_friction_there_is_no_loss() -> None:
    """Refused before anything is computed."""
    with pytest.raises(SceneError, match=r"contact\.friction: found no coefficient but 0; allowed: at least one above"):
        Losses.of(spur_scene(*SMALL, "contact.friction=0")).check()


def test_other_torques_are_named(tmp_path: Path) -> None:
    """Resumed with another list: the list is named, not the torques that follow from it."""
    rows(tmp_path)
    with pytest.raises(ArchiveError, match=r"this one has load\.percents = .*50.* \(kept: .*100.*\); resume"):
        quietly(Losses.of(spur_scene(*SMALL), (50.0, 100.0)), tmp_path, resume=True)


def test_last_lines_have_the_loss(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Under the heaviest torque, for each coefficient above 0."""
    words = [word for setting in SMALL for word in ("--set", setting)]
    scene = str(ROOT / "demos/he2022.toml")
    assert main(["losses", scene, "--out", str(tmp_path), "--percent", "50,100", *words]) == 0
    (row,) = (row for row in LOSSES.read(tmp_path) if row.torque_Nm == 170.0)
    wanted = f"170 N·m on the pinion, pinion drives, μ = 0.3: loss {row.loss_percent:.2f} % of the input, "
    assert wanted in capfd.readouterr().out
