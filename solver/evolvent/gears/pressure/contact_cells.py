"""How many elements of a flank's mesh resolve the width of the contact."""

from __future__ import annotations

import numpy as np

from evolvent.gears.pressure.flank_facets import HEIGHT_TOLERANCE
from evolvent_meshes.arrays import Floats

FEWEST_CELLS = 2.0
"""Fewest elements across the contact width 2b_H without a warning: with fewer, errors of peak pressures reach 15 % and
more, with 3 they are 3 % (docs/benchmark.md)."""
FEWEST_FITTED = 1.5
"""Fewest facets across Hertz' contact width for a fitted peak to be reported of a spur pair: with fewer, fitted peaks
are up to 2.6 times Hertz' for the same load, with more they lie within 15 % (away from tip edges and relief starts)."""
SCATTER = "may be off by 15 % and more and are for orientation only"
"""Words of warnings on the error of peak pressures on few elements."""
FINER = 'take mesh.level = "standard" or mesh.elements_per_contact_width = 3'
"""Words of warnings on the remedy for few elements."""


def cells_across(
    half_widths: Floats, heights: Floats, roll_lengths: Floats, base_radius: float, order: int, share: float = 0.5
) -> float:
    """Fitted contact width 2b over the mean length of a profile element: this quantile of all slices, by default the
    median; NaN where no slice has a width.

    half_widths: (s,) of the slices [mm], NaN where there is none; heights, roll_lengths: (n,) z and transverse
    curvature radii of the pinion flank's nodes [mm]; base_radius: of the pinion [mm]; order: of the cells.
    """
    known = 2.0 * half_widths[np.isfinite(half_widths)]
    row = heights <= heights.min() + HEIGHT_TOLERANCE
    arc = roll_lengths[row] ** 2 / (2.0 * base_radius)
    elements = (int(row.sum()) - 1) / order
    return float(np.quantile(known, share) * elements / np.ptp(arc)) if len(known) else float("nan")


def coarse_contact(across: float) -> list[str]:
    """A sentence where fewer elements than `FEWEST_CELLS` lie across the contact, in the median; else none."""
    return [] if across >= FEWEST_CELLS else [f"{across:.1f} elements across the contact (median): {few_cells()}"]


def few_cells() -> str:
    """The consequence of fewer cells than `FEWEST_CELLS`, and the remedy."""
    return f"below {FEWEST_CELLS:g}, peak pressures {SCATTER}: {FINER}."
