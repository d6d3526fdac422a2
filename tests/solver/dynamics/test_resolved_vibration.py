"""Sentences on time steps that do not resolve the pair's own vibration."""

from __future__ import annotations

import pytest

from evolvent.dynamics.resolved_vibration import ENOUGH_STEPS, MOST_POSITIONS, unresolved, unresolved_within, unseen
from evolvent.scene.scene import Scene
from evolvent.scene.schema.errors import keys_of


def test_the_wanted_positions_resolve_it() -> None:
    """3 steps a period at 20 positions: 134 positions have 20.1, 133 only 19.95. With 20 nothing is said; with a
    spectral radius of 0 no positions are asked for."""
    assert "sweep.positions = 134 resolves it" in unresolved(1500.0, 3800.0, 3.0, 20, 0.8)
    assert "statics are what is left" in unresolved(1500.0, 3800.0, 3.0, 20, 0.0)
    assert unresolved(1500.0, 3800.0, ENOUGH_STEPS, 20, 0.8) == ""


@pytest.mark.parametrize("steps", [0.1, 1e-300, 0.0])
def test_slow_rotation_would_take_more_than_a_scene_may_have(steps: float) -> None:
    """Beyond 1600 positions: none is named, and the number that a scene may have is that of its schema."""
    said = unresolved(1e-3, 3800.0, steps, 20, 0.8)
    assert f"no sweep.positions up to {MOST_POSITIONS} resolves it" in said
    assert f"to {MOST_POSITIONS}" in str(keys_of(Scene)["sweep.positions"].json_schema_extra)


def test_divided_steps_are_told_apart_from_the_positions_of_the_tables() -> None:
    """6 steps a period with a tolerance of 0.03, where He's dynamic factor at 900 r/min was 1.40 instead of 1.51; with
    12 it was 1.49, but the tables' 1.7 positions a period had 4.3 of 7.8 µm peak to peak."""
    said = unresolved_within(900.0, 3624.0, 6.0, 0.03)
    assert "6 time steps a period; wanted 8: transient.tolerance = 0.03 lets" in said
    assert unresolved_within(900.0, 3624.0, 12.0, 0.01) == ""
    assert "has 1.66 positions a period; wanted 8: the tables" in unseen(900.0, 3624.0, 1.66)
    assert unseen(900.0, 3624.0, 8.0) == ""
