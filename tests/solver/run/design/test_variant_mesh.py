"""Figures of variants on condensed gears: He's spur pair in plane strain, in line contact."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.run.design.design_space import DesignSpace
from evolvent.run.design.variant_mesh import FIRST_HARMONIC, LOST, ON_EDGES, PEAK_TO_PEAK, PRESSURE, VariantMesh
from evolvent.run.kinds.losses import LOSSES, Losses
from evolvent.scene.scene import Scene
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import helical_scene, model_of, spur_scene

SETTINGS = (
    "mesh.level=line", 'design.vary=[["both.tip_relief_um",0.0,40.0,1.0]]', "pinion.tip_relief_form=parabolic",
    "wheel.tip_relief_form=parabolic", "pinion.tip_relief_um=0", "wheel.tip_relief_um=0",
)
ANGLES = np.array(uniform_pitch(50, 12).angles)
TORQUES = 51e3, 170e3


def mesh_of(scene: Scene, friction: float = 0.0) -> VariantMesh:
    assert scene.design is not None
    own = DesignSpace(scene, scene.design)

    def pair_of(variant: Floats) -> GearPair:
        return own.scene_of(variant).gear_pair()

    return VariantMesh.of(model_of(scene), pair_of, TORQUES, ANGLES, friction)


def test_a_variant_is_what_its_own_scene_is() -> None:
    """A relief of 20 µm on gears that were condensed without: the figures of a scene that has it, whose gears are
    condensed for it. The first harmonic of 12 positions is |Σ e_k exp(2πi k/12)| / 6."""
    found, reason = mesh_of(spur_scene(*SETTINGS)).figures(np.array([20.0, 20.0]))
    own = loaded_mesh(
        model_of(spur_scene(*SETTINGS, "pinion.tip_relief_um=20", "wheel.tip_relief_um=20")), TORQUES, ANGLES
    )
    assert own.line is not None and reason == ""
    assert found[:, PEAK_TO_PEAK] == pytest.approx(1e3 * np.ptp(own.errors, axis=0), rel=1e-9)
    turning = np.exp(2j * np.pi * np.arange(12) / 12.0)
    amplitude = 1e3 * np.abs(turning @ own.errors) / 6.0
    assert found[:, FIRST_HARMONIC] == pytest.approx(amplitude, rel=1e-9)
    assert found[:, PRESSURE] == pytest.approx(own.line.largest_pressure_MPa, rel=1e-9)
    assert found[:, ON_EDGES] == pytest.approx(own.line.on_edges.max(axis=0), abs=1e-12)


@pytest.mark.parametrize("on", ["pinion", "wheel"])
def test_loss_is_that_of_losses(on: str, tmp_path: Path) -> None:
    """A relief of 20 µm at μ = 0.1: the loss that `evolvent losses --level line` writes for the scene that has it. The
    other figures are those without friction."""
    mesh = mesh_of(spur_scene(*SETTINGS, f"load.on={on}"), 0.1)
    found, _ = mesh.figures(np.array([20.0, 20.0]))
    relieved = "pinion.tip_relief_um=20", "wheel.tip_relief_um=20", "contact.friction=0.1", "sweep.positions=12"
    quietly(Losses.of(spur_scene(*SETTINGS, *relieved, f"load.on={on}"), (30.0, 100.0)), tmp_path)
    assert found[:, LOST] == pytest.approx([row.loss_percent for row in LOSSES.read(tmp_path)], rel=1e-7)
    without, _ = replace(mesh, friction=0.0).figures(np.array([20.0, 20.0]))
    assert np.isnan(without[:, LOST]).all()
    np.testing.assert_array_equal(np.delete(found, LOST, axis=1), np.delete(without, LOST, axis=1))


def test_loss_in_space_is_that_of_losses(tmp_path: Path) -> None:
    """A narrow helical pair. `losses` sums over the middles of parts of layers, a variant over the stations of the
    lines: 1.5e-4 apart."""
    line = (
        "mesh={level='line'}", "load.torque_Nm=60", "contact.friction=0.1", "sweep.positions=4",
        'design.vary=[["both.tip_relief_um",20.0,40.0,20.0]]', "pinion.tip_relief_form=parabolic",
        "wheel.tip_relief_form=parabolic", "pinion.tip_relief_um=40", "wheel.tip_relief_um=40",
    )
    scene = helical_scene(*line)
    assert scene.design is not None
    own, angles = DesignSpace(scene, scene.design), np.array(uniform_pitch(20, 4).angles)
    mesh = VariantMesh.of(model_of(scene), lambda each: own.scene_of(each).gear_pair(), (60e3,), angles, 0.1)
    found, reason = mesh.figures(np.array([40.0, 40.0]))
    quietly(Losses.of(scene, (100.0,)), tmp_path)
    (row,) = LOSSES.read(tmp_path)
    assert reason == "" and found[0, LOST] == pytest.approx(row.loss_percent, rel=3e-4)


def test_edges_bear_without_relief() -> None:
    """A third of the load and more under 170 N·m; none with 30 µm."""
    mesh = mesh_of(spur_scene(*SETTINGS))
    without, relieved = (mesh.figures(np.array([each, each]))[0] for each in (0.0, 30.0))
    assert without[1, ON_EDGES] > 0.3 and relieved[:, ON_EDGES].max() == 0.0


def test_an_impossible_variant_has_a_reason() -> None:
    """0.05 µm is refused, as a number in millimetres."""
    found, reason = mesh_of(spur_scene(*SETTINGS)).figures(np.array([0.05, 0.05]))
    assert np.isnan(found).all() and "pinion.tip_relief_um" in reason
