"""Wear of nearly rigid bodies of the public API, against the shape that their removed volume gives."""

from __future__ import annotations

import pytest
from wear_cases import (
    CYLINDER_DEPTH,
    CYLINDER_WIDTH,
    LINE_LOAD,
    SLIDING,
    SPHERE_DEPTH,
    K,
    cylinder,
    mesh_volume,
    sphere,
)  # fmt: skip

from wear.blocks import BlockSettings
from wear.cycle import Cycle, Travel
from wear.law import Archard
from wear.study import Refresh, WearStudy

MILLIMETRE = Cycle(travel=(Travel(1, translation=(1.0, 0.0, 0.0)),))


@pytest.mark.parametrize("follows", [False, True])
def test_cylinder(follows: bool) -> None:
    """A nearly rigid cylinder worn flat: a = (3RkF's/2)^⅓ = 0.19574 mm, h = a²/2R = 3.832e-3 mm, within 1 %; also where
    the mesh follows each 1e-3 mm. Volume kF's within 1e-6 at the nodes, and the mesh's own loss within 0.1 %."""
    assert pytest.approx(0.19574, abs=5e-6) == CYLINDER_WIDTH
    assert pytest.approx(3.832e-3, abs=5e-7) == CYLINDER_DEPTH
    refresh = Refresh(depth=1e-3) if follows else None
    study, volume = WearStudy(cylinder(), (Archard(K),), MILLIMETRE, refresh), 0.0
    for block in study.blocks(SLIDING, BlockSettings(first=100.0)):
        volume += block.length * block.state.now.volumes[0, "arc"]
    depth = study.by_side(block.state.depth)[0, "arc"]
    assert study.refreshed == (3 if follows else 0)
    assert depth.max() == pytest.approx(CYLINDER_DEPTH, rel=0.01)
    assert volume == pytest.approx(K * LINE_LOAD * SLIDING, rel=1e-6)
    before, after = (mesh_volume(mesh) for mesh in (cylinder().bodies[0].mesh, study.meshes(block.state.depth)[0]))
    assert before - after == pytest.approx(volume, rel=1e-3)


def test_sphere() -> None:
    """A nearly rigid sphere worn flat: πh²(R − h/3) = kFs, h = 7.979e-3 mm, within 1 %."""
    study = WearStudy(sphere(), (Archard(K),), MILLIMETRE)
    *_, block = study.blocks(SLIDING, BlockSettings(first=100.0))
    assert pytest.approx(7.979e-3, rel=5e-4) == SPHERE_DEPTH  # which leaves the h/3 out
    assert block.state.depth.max() == pytest.approx(SPHERE_DEPTH, rel=0.01)
