"""Estimated size of kept gears, beside the files that are written."""

from __future__ import annotations

import pytest
from mpi4py import MPI

from evolvent.check.cache_size import kept_megabytes
from evolvent.fem.cache.cache import Cache
from evolvent.gears.gear_model import prepare_model
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from tests.support.gear_cases import helical_scene, spur_scene


@pytest.mark.parametrize("scene", [spur_scene("mesh.level=fine"), helical_scene("mesh.elements_per_contact_width=1")])
def test_estimate_is_the_size_of_the_files(scene: Scene, kept: Cache) -> None:
    """Problem: a pair in the plane and one in space, each on one mesh. Exact: the files of both gears, to a quarter."""
    problem = gear_problem(scene)
    prepare_model(problem, MPI.COMM_SELF)
    written = sum(each.size for each in kept.entries())
    assert kept_megabytes(problem) == pytest.approx(1e-6 * written, rel=0.25)
