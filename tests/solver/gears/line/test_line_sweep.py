"""A pitch in line contact: its positions, where it goes on, and edges of tips that bear."""

from __future__ import annotations

import pytest
from mpi4py import MPI

from evolvent.gears.line.line_gears import LineGears
from evolvent.gears.line.line_result import EdgeContact, LineResult
from evolvent.gears.line.line_sweep import line_sweep
from evolvent.gears.solution.certificates import pitch_imbalance
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from tests.solver.gears.line.test_line_gears import RELIEVED
from tests.support.gear_cases import model_of, spur_scene

PITCH = uniform_pitch(50, 4)


def test_positions_of_a_pitch() -> None:
    """Exact: as each position alone, the last one closes; the pitch is in balance; gone on from the third position, the
    same two are left."""
    model = model_of(spur_scene(*RELIEVED, "mesh.level=line"))
    gears, force = LineGears.of(model, True), model.load.torque / model.base_radius
    swept = list(line_sweep(model, PITCH, (0.0, 0.1), MPI.COMM_SELF))
    assert [each.angle for each in swept] == list(PITCH.angles)
    assert [each.closes for each in swept] == [False, False, False, True]
    for each in swept:
        for result, friction in zip(each.results, (0.0, 0.1)):
            alone = LineResult.of(gears.position(each.angle), force, friction)
            assert result.friction == friction
            assert result.transmission_error == pytest.approx(alone.transmission_error, rel=1e-12)
    assert pitch_imbalance([each.results[1] for each in swept]) < 1e-12
    left = list(line_sweep(model, PITCH, (0.0, 0.1), MPI.COMM_SELF, 2))
    again, before = ([each.results[1].transmission_error for each in part] for part in (left, swept[2:]))
    assert again == before


def test_edges_that_bear_end_the_pitch() -> None:
    """Problem: He's pair without relief, whose tips bear. The message has torque, part of the load and remedy."""
    model = model_of(spur_scene("mesh.level=line"))
    with pytest.raises(EdgeContact, match=r"under 170 N·m they bear .* % of it .*; relieve the tips \(tip_relief_um\)"):
        list(line_sweep(model, uniform_pitch(50, 20), (0.0,), MPI.COMM_SELF))
