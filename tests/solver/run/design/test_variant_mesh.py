"""Figures of variants on condensed gears: He's spur pair in plane strain, in line contact."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.run.design.design_space import DesignSpace
from evolvent.run.design.variant_mesh import ON_EDGES, PEAK_TO_PEAK, PRESSURE, VariantMesh
from evolvent.scene.scene import Scene
from tests.support.gear_cases import model_of, spur_scene

SETTINGS = (
    "mesh.level=line", 'design.vary=[["both.tip_relief_um",0.0,40.0,1.0]]', "pinion.tip_relief_form=parabolic",
    "wheel.tip_relief_form=parabolic", "pinion.tip_relief_um=0", "wheel.tip_relief_um=0",
)
ANGLES = np.array(uniform_pitch(50, 12).angles)
TORQUES = 51e3, 170e3


def mesh_of(scene: Scene) -> VariantMesh:
    assert scene.design is not None
    own = DesignSpace(scene, scene.design)
    return VariantMesh.of(model_of(scene), lambda variant: own.scene_of(variant).gear_pair(), TORQUES, ANGLES)


def test_a_variant_is_what_its_own_scene_is() -> None:
    """A relief of 20 µm on gears that were condensed without: the figures of a scene that has it, whose gears are
    condensed for it."""
    found, reason = mesh_of(spur_scene(*SETTINGS)).figures(np.array([20.0, 20.0]))
    own = loaded_mesh(
        model_of(spur_scene(*SETTINGS, "pinion.tip_relief_um=20", "wheel.tip_relief_um=20")), TORQUES, ANGLES
    )
    assert own.line is not None and reason == ""
    assert found[:, PEAK_TO_PEAK] == pytest.approx(1e3 * np.ptp(own.errors, axis=0), rel=1e-9)
    assert found[:, PRESSURE] == pytest.approx(own.line.largest_pressure_MPa, rel=1e-9)
    assert found[:, ON_EDGES] == pytest.approx(own.line.on_edges.max(axis=0), abs=1e-12)


def test_edges_bear_without_relief() -> None:
    """A third of the load and more under 170 N·m; none with 30 µm."""
    mesh = mesh_of(spur_scene(*SETTINGS))
    without, relieved = (mesh.figures(np.array([each, each]))[0] for each in (0.0, 30.0))
    assert without[1, ON_EDGES] > 0.3 and relieved[:, ON_EDGES].max() == 0.0


def test_an_impossible_variant_has_a_reason() -> None:
    """0.05 µm is refused, as a number in millimetres."""
    found, reason = mesh_of(spur_scene(*SETTINGS)).figures(np.array([0.05, 0.05]))
    assert np.isnan(found).all() and "pinion.tip_relief_um" in reason
