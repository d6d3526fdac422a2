"""Sentences on time steps that do not resolve the pair's own vibration."""

from __future__ import annotations

import pytest

from evolvent.dynamics.resolved_vibration import ENOUGH_STEPS, MOST_POSITIONS, unresolved
from evolvent.scene.scene import Scene
from evolvent.scene.schema.errors import keys_of


def test_the_wanted_positions_resolve_it() -> None:
    """3 steps a period at 20 positions: 54 positions have 8.1, 53 only 7.95. With 8 nothing is said."""
    assert "sweep.positions = 54 resolves it" in unresolved(1500.0, 3800.0, 3.0, 20)
    assert unresolved(1500.0, 3800.0, ENOUGH_STEPS, 20) == ""


@pytest.mark.parametrize("steps", [0.1, 1e-300, 0.0])
def test_slow_rotation_would_take_more_than_a_scene_may_have(steps: float) -> None:
    """Beyond 1600 positions: none is named, and the number that a scene may have is that of its schema."""
    said = unresolved(1e-3, 3800.0, steps, 20)
    assert f"no sweep.positions up to {MOST_POSITIONS} resolves it" in said
    assert f"to {MOST_POSITIONS}" in str(keys_of(Scene)["sweep.positions"].json_schema_extra)
