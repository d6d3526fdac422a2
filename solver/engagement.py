"""The whole engagement of one tooth, put together from one pitch.

At pinion rotation φ + 2π/z_1 tooth pair i stands where pair i + 1 stood at φ. So pair i at φ is one tooth pair at
φ + 2πi/z_1, its own rotation: 0 where its flanks meet at the pitch point of the mid-face section. A pitch with the
three or four pairs that touch is then a curve over the whole engagement, each rotation met once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.data import Floats, Ints
from solver.gear_results import Slices
from solver.run_data import RunData, SolvedPosition


@dataclass(frozen=True)
class Engagement:
    """One tooth's way through the mesh at one friction coefficient; entries (n,) ascend with `angle`.

    angle: the tooth's own pinion rotation [rad]. position, tooth: where in the pitch it was computed. force: normal
    [N]. share: of the sum over all teeth [-]. max_pressure: fitted, away from tip edges; mean_pressure: of the fitted
    peaks along the contact line; edge_pressure: largest at a tip edge, 0 without [MPa]. contact_length [mm].
    """

    friction: float
    angle: Floats
    position: Ints
    tooth: Ints
    force: Floats
    share: Floats
    max_pressure: Floats
    mean_pressure: Floats
    edge_pressure: Floats
    contact_length: Floats


def engagement(run: RunData, index: int) -> Engagement:
    """The engagement at friction coefficient number `index`."""
    rows = [row for k, each in enumerate(run.positions) for row in _rows(run, k, each[index])]
    columns = [np.array(column) for column in zip(*sorted(rows))]
    angle, position, tooth, *values = columns
    return Engagement(run.frictions[index], angle, position, tooth, *values)


def engagements(run: RunData) -> list[Engagement]:
    """One per friction coefficient."""
    return [engagement(run, index) for index in range(len(run.frictions))]


def _rows(run: RunData, k: int, solved: SolvedPosition) -> list[tuple[float, ...]]:
    total = sum(tooth.force for tooth in solved.teeth)
    return [
        (
            solved.result.stand.angle + tooth.tooth * run.pitch,
            k,
            tooth.tooth,
            tooth.force * run.width,
            tooth.force / total,
            tooth.max_pressure or np.nan,
            line_mean(solved.cut, tooth.tooth),
            tooth.edge_pressure,
            tooth.contact_length * run.width,
        )
        for tooth in solved.teeth
    ]


def line_mean(cut: Slices, tooth: int) -> float:
    """Mean along the contact line of the fitted peak pressures [MPa], tip edges left out; NaN where nothing is left."""
    here = (cut.tooth == tooth) & np.isfinite(cut.peak)
    return float(np.average(cut.peak[here], weights=cut.width[here])) if here.any() else float("nan")


def sign_changes(x: Floats, y: Floats) -> Floats:
    """Where the curve y (n,) over x (n,) crosses zero, by linear interpolation; NaN in y is passed over."""
    known = np.isfinite(y)
    x, y = x[known], y[known]
    positive = y >= 0.0
    k = np.flatnonzero(positive[:-1] != positive[1:])
    return np.asarray(x[k] - y[k] * (x[k + 1] - x[k]) / (y[k + 1] - y[k]))


def crossing(low: Engagement, high: Engagement) -> float:
    """The tooth's rotation [rad] at which the curves of maximum pressure of two friction coefficients cross, the one
    nearest to the pitch point; NaN where they do not cross."""
    angle, first, second = np.intersect1d(np.round(low.angle, 9), np.round(high.angle, 9), return_indices=True)
    found = sign_changes(angle, high.max_pressure[second] - low.max_pressure[first])
    return float(found[np.argmin(np.abs(found))]) if len(found) else float("nan")
