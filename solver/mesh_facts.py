"""How good a run's mesh was: its cells, and how many of them the contact is wide."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solver.run_data import RunData

SAME = 1e-6  # [mm] of height within which nodes are of one row

@dataclass(frozen=True)
class MeshFacts:
    """What the meshes are worth."""

    min_scaled_jacobian: float
    """Smallest scaled Jacobian of the cells of both sectors; 1 is a cube, 0 a cell that is folded."""
    cells_across_contact_width: float
    """Elements across the width 2b_H of the contact as it was found, in the median."""


def cells_across(run: RunData) -> float:
    """Median over all slices of the fitted contact width 2b over the mean length of a profile element."""
    widths = np.concatenate([2.0 * solved.cut.half_width for each in run.positions for solved in each])
    known, flank = widths[np.isfinite(widths)], run.flank
    row = flank.z <= flank.z.min() + SAME
    arc = flank.roll_length[row] ** 2 / (2.0 * run.pair.pinion.base_radius)
    elements = (int(row.sum()) - 1) / run.scene.mesh.order
    return float(np.median(known) * elements / np.ptp(arc)) if len(known) else float("nan")
