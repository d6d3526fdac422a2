"""The part of the error bars of a line contact that no mesh has."""

from __future__ import annotations

from dataclasses import astuple
from pathlib import Path

import numpy as np
import pytest

from evolvent.results.error_bars.line_parts import LOSS_OFF, RUBBING_VARIES, TANGENT_OFF, line_parts
from evolvent.results.run_data import RunData, read_run
from evolvent.run.kinds.run import Run
from tests.solver.run.test_line_run import helical_line, line_scene
from tests.support.computing.quiet import quietly


def run_of(folder: Path, helical: bool) -> RunData:
    scene = helical_line("load.torque_Nm=40", "contact.friction=[0.0,0.2]") if helical else line_scene()
    quietly(Run.of(scene), folder)
    return read_run(folder)


@pytest.mark.parametrize("helical", [False, True])
def test_parts_are_of_the_figures(helical: bool, tmp_path: Path) -> None:
    """Exact: parts of the mean stiffness and of the loss; the peak-to-peak transmission error of a helical pair has one
    for friction, in proportion to μ and the deflection, that of a spur pair has none."""
    run = run_of(tmp_path, helical)
    smooth, rubbing = (line_parts(run, index) for index in range(2))
    assert all(np.isfinite(astuple(each)).all() for each in (smooth, rubbing))
    solved = [each[1] for each in run.positions]
    stiffness = np.mean([1e-3 * each.result.stiffness for each in solved]) * run.width / run.pair.face_width
    assert rubbing.mesh_stiffness_N_per_mm_um == pytest.approx(TANGENT_OFF * stiffness)
    loss = sum(each.result.friction_loss for each in solved) / sum(each.result.torques[0] for each in solved)
    assert smooth.loss_percent == 0.0 and rubbing.loss_percent == pytest.approx(100.0 * LOSS_OFF * loss)
    deflection = np.mean([1e3 * (each.result.transmission_error - each.unloaded_error) for each in solved])
    errors = [[1e3 * each[i].result.transmission_error for each in run.positions] for i in range(2)]
    bars = [max(6e-3 * np.ptp(error), 1e-3 * deflection) for error in errors]
    more = RUBBING_VARIES * 0.2 * deflection if helical else 0.0
    assert rubbing.transmission_error_peak_to_peak_um == pytest.approx(bars[1] + more, rel=1e-9)
    assert (smooth.face_load_factor > 0.0) == helical
