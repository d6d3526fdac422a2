"""The grid of a flank's nodes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from evolvent.scene.scene import Scene
from evolvent.wear.gears.flank_grid import FlankGrid
from tests.support.gear_cases import helical_scene, model_of, spur_scene


@pytest.mark.parametrize("make", [spur_scene, helical_scene])
def test_regular_grid_has_the_areas_of_the_flank(make: Callable[[str], Scene]) -> None:
    """Problem: a regular grid over the arcs and heights of a flank's nodes. Exact: the areas of the mesh's nodes within
    1 % each, in all within 1e-4."""
    for body in model_of(make("mesh.level=quick")).bodies:
        own = FlankGrid.of(body)
        regular = FlankGrid.regular(own.arcs, own.heights, body.gear.base_helix_angle)
        assert regular.areas.sum() == pytest.approx(own.areas.sum(), rel=1e-4)
        np.testing.assert_allclose(regular.areas[regular.node], own.areas[own.node], rtol=1e-2)
