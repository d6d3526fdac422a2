"""Gear pairs that wear, from Python: the same depths as a run of the same scene."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.results.archive.archive import Archive
from evolvent.run.kinds.wear import Wear
from evolvent.wear import Archard, BlockSettings, wear_study, wearing_pair
from evolvent.wear.results.archive import read_checkpoint
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import spur_scene
from tests.support.gears_api_curve import he_problem

WEAR = (
    "wear.cycles=4e4", "wear.pinion_mm2_per_N=1e-10", "wear.wheel_mm2_per_N=3e-10", "wear.report_at_cycles=2e4",
    "wear.first_block_cycles=1e4", "sweep.positions=4", "mesh.level='quick'",
)


def test_wear_study_of_the_api_equals_that_of_a_run(tmp_path: Path) -> None:
    """Problem: He's pair at level quick wears for 4e4 revolutions, once as a scene with [wear] and once by the API with
    the same blocks. Exact: the same blocks, and the same depths at all flank nodes, to
    rounding."""
    scene = spur_scene(*WEAR)
    quietly(Wear.of(scene), tmp_path)
    expected = read_checkpoint(Archive(tmp_path, scene))
    assert expected is not None
    pair = wearing_pair(he_problem(), Archard(1e-10, 3e-10), positions=4, comm=MPI.COMM_SELF)
    *_, last = wear_study(pair, (2e4, 4e4), BlockSettings(1e4))
    assert last.state.cycles == expected.cycles == 4e4
    assert len(last.rows) == len(expected.rows) >= 2
    rounding = 1e-10 * expected.depth.max()  # of sums over arrays that lie elsewhere, through an iterative solver
    np.testing.assert_allclose(last.state.depth, expected.depth, rtol=0.0, atol=rounding)
    pinion, wheel = pair.by_gear(last.state.depth)
    assert wheel.max() > 2.0 * pinion.max() > 0.0
