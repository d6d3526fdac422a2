"""Costs of the gear pair: its model, the seconds of a pitch, the functions that are profiled. No times are asserted."""

from __future__ import annotations

import ast
from dataclasses import replace

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from evidence.benchmarks.gears.pitch import PitchFacts
from evidence.benchmarks.gears.profile import LEVEL_PARTS, ONE_MESH_PARTS
from evidence.benchmarks.gears.three_teeth import three_teeth
from evidence.benchmarks.gears.whole_runs import RunCase, failed, row_of
from tests.support.checkout import ROOT


def test_three_teeth_are_one_body_each() -> None:
    """The copies of a sector are welded along their cuts: cells that share nodes connect all of a gear's mesh."""
    task = three_teeth(1.0)
    for mesh in task.bodies:
        first = np.repeat(mesh.cells[:, :1], mesh.cells.shape[1] - 1, axis=1).ravel()
        links = coo_matrix((np.ones(len(first)), (first, mesh.cells[:, 1:].ravel())), shape=2 * (len(mesh.points),))
        assert connected_components(links, directed=False)[0] == 1


def test_a_pitch_is_told_from_one_position() -> None:
    """Seconds of start 1, meshing 50, assembling 2, condensing 3 and positions 4, 5, 6 (again): one position takes
    1 + 2 + 3 + 4, the pitch 1 + 2 + 3 + 15; the mean of 7 and 9 mm is 8."""
    facts = PitchFacts(10, 1, 1.0, 50.0, 2.0, 3.0, (4.0, 5.0, 6.0), 2, (3, 3, 3), (7.0, 9.0), 100.0, 20.0)
    assert facts.one_position == 10.0
    assert facts.without_meshing == 21.0
    assert facts.counted == 2
    assert facts.mean_error == 8.0


def test_profiled_functions_are_there() -> None:
    """The profile looks functions up by file and name: one that was renamed would silently take no time."""
    solver = ROOT / "solver" / "evolvent"
    for _, file, function in (*ONE_MESH_PARTS, *LEVEL_PARTS):
        tree = ast.parse((solver / file).read_text(encoding="utf-8"))
        assert function in {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}, (file, function)


def test_a_run_is_told_by_its_summary() -> None:
    """100 s of which positions took 40, error bars 10 and output 5: the gears took 45. Newton's method took 6 and 10
    iterations: 8 in the mean. A bar of 90 s is missed, one of 110 s is met; a run that failed has no figures."""
    case = RunCase("a", "scene", "quick", (), seconds_bar=90.0)
    timings = {"mesh": 1.0, "assemble": 60.0, "factor": 60.0, "positions": 40.0, "error_bars": 10.0, "output": 5.0}
    summary = {
        "timings_s": {**timings, "total": 100.0}, "positions": [{"newton_iterations": n} for n in (6, 10)],
        "frictions": [{}], "dofs": 10, "flank_dofs": 20,
    }
    row = row_of(case, summary, 300.0)
    assert row.prepare == 45.0
    assert row.iterations == 8.0
    assert not row.met
    assert row_of(replace(case, seconds_bar=110.0, iterations_bar=8.0), summary, 300.0).met
    assert not row_of(replace(case, seconds_bar=110.0, iterations_bar=7.9), summary, 300.0).met
    assert failed(case, "killed").note == "killed"
    assert np.isnan(failed(case, "killed").seconds)
