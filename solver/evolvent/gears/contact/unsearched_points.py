"""Where flanks may touch outside the searched window, for flanks that have rows and layers."""

from __future__ import annotations

import numpy as np

from evolvent.contact.search.pairing import Pairing
from evolvent.fem.surface import Surface
from evolvent.gears.contact.cell_axis import CellAxis
from evolvent.gears.contact.contact_line import ContactLine
from evolvent.gears.contact.lattice_pairing import faced_points
from evolvent_meshes.arrays import Floats

APART = 0.1
"""Distance [modules] between the places that face each other on conjugate flanks from which on these are taken to be
apart. Modifications and deflection move them against each other by less."""


def unsearched_pairs(
    line: ContactLine, half_width: float, moved: float, flanks: tuple[Surface, Surface], max_gap: float,
    max_overlap: float,
) -> Pairing:
    """Points outside the window with their partners, at gaps in [−max_overlap, max_gap] [mm]: at the heights of the
    pinion's nodes, about half a row apart, and on the edges of what both flanks share.

    half_width: of the window [mm of profile arc].
    moved: how far beside the window contact is looked for in slices on the path of contact [mm of profile arc].
    flanks: of pinion and wheel in place.
    """
    axis = CellAxis.of(line, half_width)
    arc, z = _points(line)
    pair, ξ = line.stand.pair, line.stand.roll_distance(line.tooth, z)
    start, end = pair.path_of_contact
    away, searched = np.full(len(z), np.inf), np.zeros(len(z), dtype=bool)
    if axis is not None:
        away = np.abs(arc - axis.at(z)[0])
        searched = (away <= half_width) & (z >= axis.limits[0]) & (z <= axis.limits[-1])
    wanted = ((ξ < start) | (ξ > end) | (away <= half_width + moved)) & ~searched
    arc, z = arc[wanted], z[wanted]
    near = line.distance(arc, z, flanks) < APART * pair.pinion.normal_module
    faced = faced_points(line, arc[near], z[near], flanks)
    gap = faced.pairing.gap
    return faced.pairing.of(faced.found & faced.inside & (gap >= -max_overlap) & (gap <= max_gap))


def _points(line: ContactLine) -> tuple[Floats, Floats]:
    """Profile arcs on the pinion's flank and heights (q,) of points all over what both flanks share."""
    height, wheel = (flank.height for flank in line.flanks)
    height = height[(height >= wheel[0]) & (height <= wheel[-1])]
    line_arc = line.arc(height)
    low, high = (line_arc + edge for edge in line.edges(height, line_arc))
    shared = high > low
    height, low, high = height[shared], low[shared], high[shared]
    count = 1 + int(np.ceil(np.max(2.0 * (high - low) / line.row_width(height), initial=0.0)))
    arc = low + (high - low) * np.linspace(0.0, 1.0, count)[:, None]
    return arc.ravel(), np.broadcast_to(height, arc.shape).ravel()
