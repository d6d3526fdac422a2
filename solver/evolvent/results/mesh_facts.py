"""Quality of a run's meshes: shape of the cells, and how many of them resolve the contact width."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from evolvent.gears.pressure import contact_cells
from evolvent.gears.pressure.contact_cells import FEWEST_CELLS
from evolvent.results.run_data import RunData

NARROW = 0.1
"""Quantile of all slices that `cells_across_narrow_contact` gives."""


@dataclass(frozen=True)
class MeshFacts:
    """Quality of both sector meshes and of the contact's resolution."""

    min_scaled_jacobian: float
    """Smallest scaled Jacobian of the cells of both sectors; 1 is a cube, 0 a cell that is folded."""
    cells_across_contact_width: float
    """Elements across the fitted contact width, median of all slices; null in line contact, whose width the elements do
    not resolve."""
    cells_across_narrow_contact: float
    """Elements across the narrowest tenth of the contact: nine of ten slices of all positions have more; null in line
    contact."""


def cells_across(run: RunData, share: float = 0.5) -> float:
    """Fitted contact width over the mean length of a profile element: this quantile of all slices, by default the
    median. NaN in line contact."""
    if run.is_line:
        return math.nan
    half_widths = np.concatenate([solved.cut.half_width for each in run.positions for solved in each])
    flank, radius, order = run.flank, run.pair.pinion.base_radius, run.scene.mesh.order
    return contact_cells.cells_across(half_widths, flank.z, flank.roll_length, radius, order, share)


def few_cells_across(run: RunData) -> bool:
    """Whether the contact is too few cells wide for single peaks to be trusted. That of a line contact needs none."""
    return not run.is_line and not cells_across(run) >= FEWEST_CELLS
