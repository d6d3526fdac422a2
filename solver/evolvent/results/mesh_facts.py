"""Quality of a run's meshes: shape of the cells, and how many of them resolve the contact width."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.results.run_data import RunData
from evolvent.scene.checking.scene_warnings import FEWEST_CELLS

HEIGHT_TOLERANCE = 1e-6
"""Nodes within this height [mm] are of one row."""
NARROW = 0.1
"""Quantile of all slices that `cells_across_narrow_contact` is."""


@dataclass(frozen=True)
class MeshFacts:
    """Quality of both sector meshes and of the contact's resolution."""

    min_scaled_jacobian: float
    """Smallest scaled Jacobian of the cells of both sectors; 1 is a cube, 0 a cell that is folded."""
    cells_across_contact_width: float
    """Elements across the fitted contact width, median of all slices."""
    cells_across_narrow_contact: float
    """Elements across the narrowest tenth of the contact: nine of ten slices of all positions have more."""


def cells_across(run: RunData, share: float = 0.5) -> float:
    """Fitted contact width over the mean length of a profile element: this quantile of all slices, by default the
    median."""
    widths = np.concatenate([2.0 * solved.cut.half_width for each in run.positions for solved in each])
    known, flank = widths[np.isfinite(widths)], run.flank
    row = flank.z <= flank.z.min() + HEIGHT_TOLERANCE
    arc = flank.roll_length[row] ** 2 / (2.0 * run.pair.pinion.base_radius)
    elements = (int(row.sum()) - 1) / run.scene.mesh.order
    return float(np.quantile(known, share) * elements / np.ptp(arc)) if len(known) else float("nan")


def few_cells_across(run: RunData) -> bool:
    """Whether the contact is too few cells wide for single peaks to be trusted."""
    return not cells_across(run) >= FEWEST_CELLS
