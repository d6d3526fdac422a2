"""A wear study of a gear pair, whose meshes follow or not, stopped and resumed."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from evolvent.wear.block_stepping import BlockSettings
from evolvent.wear.gears.gear_study import StudyState, checkpoint_of, study_states
from evolvent.wear.gears.gear_wear import GearWear
from tests.support.gear_wear_cases import wear_scene, wearing_gears


@cache
def studied(refresh: float) -> tuple[GearWear, list[StudyState]]:
    """A spur pair worn by 3 µm."""
    gears = wearing_gears(wear_scene("spur"), 8, refresh)
    return gears, list(study_states(gears, (2e5, 8e5), BlockSettings(4e4)))


def test_study_depths_do_not_depend_on_mesh_updates() -> None:
    """Problem: meshes that follow each 0.5 µm, or not at all. Exact: the same depths, within 1 % of the volume."""
    (never, fixed), (often, moved) = studied(np.inf), studied(5e-4)
    assert never.mesh_updates == 0 and often.mesh_updates >= 3
    one, other = fixed[-1].state.depth, moved[-1].state.depth
    assert never.areas @ np.abs(one - other) < 0.01 * never.areas @ one
    assert [stage.report for stage in moved].count(True) == 3


def test_resumed_study_takes_the_same_blocks() -> None:
    """Problem: a study resumed by other objects from a checkpoint after the third block, when the meshes had followed.
    Exact: the blocks and depths of the study without a stop, within 1e-9 of the largest depth."""
    _, whole = studied(5e-4)
    scene = wear_scene("spur")
    first = wearing_gears(scene, 8, 5e-4)
    sweep = study_states(first, (2e5, 8e5), BlockSettings(4e4))
    stage = next(stage for k, stage in enumerate(sweep) if k == 4)
    assert first.mesh_updates > 0
    second, kept = wearing_gears(scene, 8, 5e-4), checkpoint_of(first, stage)
    rest = list(study_states(second, (2e5, 8e5), BlockSettings(4e4), kept))
    assert [s.state.cycles for s in rest] == pytest.approx([s.state.cycles for s in whole[4:]], rel=1e-9)
    deepest = whole[-1].state.depth.max()
    np.testing.assert_allclose(rest[-1].state.depth, whole[-1].state.depth, atol=1e-9 * deepest)
