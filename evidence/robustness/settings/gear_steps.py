"""He's spur pair with friction, the last position of a sweep reached in steps of very different length."""

from __future__ import annotations

import numpy as np
from mpi4py import MPI

from evidence.robustness.settings.sheets import Cell, Sheet, sheet_of
from evidence.scenes import spur_pair
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.solution.certificates import balance_error
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.scene.gear_problem import gear_problem

STEPS, LAST, COUNT = (0.01, 0.05, 0.2, 1.0, 5.0), 3.0, 4  # degrees, degrees, positions
FRICTIONS = (0.05, 0.1, 0.3, 0.6, 1.0)


def spur_pair_at_steps() -> Sheet:
    """Step × μ: four positions, the last one always the same."""
    model = prepare_model(gear_problem(spur_pair("mesh.level=quick")), MPI.COMM_SELF).model
    return sheet_of(
        ("position_step", "A spur pair (He, quick), position steps from 0.01° to 5°", "worst balance error"),
        ("μ", FRICTIONS),
        ("step of pinion rotation [°]", STEPS),
        lambda i, j: _cell(model, FRICTIONS[i], STEPS[j]),
    )


def _cell(model: GearModel, friction: float, step: float) -> Cell:
    pitch = Pitch(tuple(np.radians(LAST - step * np.arange(COUNT)[::-1])))
    swept = [p.results[0] for p in sweep_pitch(model, pitch, [friction], initial_state([friction]))]
    return Cell(float(np.mean([r.iterations for r in swept])), max(balance_error(r) for r in swept))
