"""The middle line of contact cells and their width, of second order along each cell."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from evolvent.gears.contact.contact_line import ContactLine
from evolvent_meshes.arrays import Floats, Ints

STEADY = 0.6
"""Greatest length of a cell [normal modules]: within it the load along a contact line hardly changes where the gap does
not."""
BENT = 0.125
"""Length of a cell, in its widths, over √(R/ρ), R the radius of curvature of the modifications along the line and ρ the
relative one across. Where cells are two or three layers long in a relief, line loads there alternate by up to a fifth
from layer to layer: with cells of ten widths K_Hβ of Yang's pair with reliefs of 60 µm was 1.325 at a twentieth of the
torque, of one layer 1.230, of this length 1.226; that of 23/81 at 100 N·m was 1.089 with cells twice as long, 1.0735 of
this length, 1.0726 of one layer."""


@dataclass(frozen=True)
class CellAxis:
    """A contact line between the limits of L cells. Profile arcs are of second order in height in each, as the shape
    functions are: so displacements that are linear on the flank are represented exactly.

    limits: (L + 1,) heights that limit the cells [mm].
    arc: (2L + 1,) profile arc of the line on the pinion's flank at limits and middles [mm].
    width: (2L + 1,) of the cells there [mm of profile arc].
    """

    limits: Floats
    arc: Floats
    width: Floats

    @staticmethod
    def of(line: ContactLine, half_width: float) -> CellAxis | None:
        """The axis of cells as wide as the rows of the pinion's flank; None where the line has left the flanks. Where
        the half-width of the window [mm of profile arc] is infinite, the axis spans the whole face instead."""
        limits = line.cell_limits(partial(cell_length, line), bool(np.isinf(half_width)))
        if not len(limits):
            return None
        z = _heights(limits)
        return CellAxis(limits, line.arc(z), line.row_width(z))

    @property
    def heights(self) -> Floats:
        """Heights (2L + 1,) of the levels of nodes [mm]."""
        return _heights(self.limits)

    def cell(self, z: Floats) -> Ints:
        """The cells (q,) in which heights lie."""
        return np.clip(np.searchsorted(self.limits, z, side="right") - 1, 0, len(self.limits) - 2)

    def at(self, z: Floats) -> tuple[Floats, Floats]:
        """Profile arc of the line and width of the cells at heights (q,) [mm]."""
        cell = self.cell(z)
        y = (z - self.limits[cell]) / np.diff(self.limits)[cell]
        N, nodes = along(y), 2 * cell[:, None] + np.arange(3)
        return np.einsum("qk,qk->q", N, self.arc[nodes]), np.einsum("qk,qk->q", N, self.width[nodes])


def along(y: Floats) -> Floats:
    """Shape functions (q, 3) of a second-order interval at coordinates (q,): of its start, its middle and its end."""
    return np.stack([(1.0 - y) * (1.0 - 2.0 * y), 4.0 * y * (1.0 - y), y * (2.0 * y - 1.0)], axis=1)


def cell_length(line: ContactLine, z: Floats) -> Floats:
    """Length (h,) of cells at heights z [mm]: `STEADY` or, where modifications bend the gap along the line, `BENT`."""
    pair = line.stand.pair
    ξ = np.clip(line.stand.roll_distance(line.tooth, z), *pair.path_of_contact)
    ratio = np.sqrt(np.maximum(line.bend_of_gap(z) * pair.relative_curvature_radius(ξ), np.finfo(float).tiny))
    return np.asarray(np.minimum(STEADY * pair.pinion.normal_module, BENT * line.row_width(z) / ratio))


def _heights(limits: Floats) -> Floats:
    result = np.empty(2 * len(limits) - 1)
    result[::2], result[1::2] = limits, 0.5 * (limits[1:] + limits[:-1])
    return result
