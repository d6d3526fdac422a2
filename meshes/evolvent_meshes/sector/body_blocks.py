"""Blocks of a section below the root band: rim, web and hub, down to the bore.

Rows of cells end on the circles at which web and rim, web and hub meet; there the swept mesh loses the cells beside the
web. A full ring has the rim's rows only.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.profile import polar
from evolvent_meshes.mesh.structured_grid import subdivided, transfinite
from evolvent_meshes.sector.root_band import RootBand
from evolvent_meshes.sector.section_blocks import (
    Piece,
    even,
    graded_fractions,
    grid_piece,
    half_steps,
    line,
    to_polar,
)

WIDER = 1.3
"""Height of the rim's first row over the width of the back band above it."""


def body_blocks(
    loaded: RootBand, back: RootBand, gear: GearParameters, inner: int, elements: tuple[int, int, int]
) -> list[Piece]:
    """The root blocks of both sides and the base between them, down to the bore.

    inner: columns of cells of the base. elements: rows of cells of rim, web and hub.
    """
    rim, *below = elements
    circles = body_circles(gear)
    corners = [side.inner(np.array([float(side.neck)]))[0] for side in (loaded, back)]
    cut = np.pi / gear.z
    depths, angles = to_polar(np.array(corners))
    rows = subdivided(graded_fractions(depths[0] - circles[0], WIDER * loaded.widths[1], rim), 2)
    blocks: list[Piece] = []
    for side, angle, end in zip((loaded, back), angles, (cut, -cut), strict=True):
        top = side.inner(half_steps(side.neck, side.cells))
        blocks += _down_to_bore(top, circles, (angle, end), rows, below)
    top = line(corners[0], corners[1], even(half_steps(0, inner)))
    return [*blocks, *_down_to_bore(top, circles, (angles[0], angles[1]), rows, below)]


def body_circles(gear: GearParameters) -> list[float]:
    """Radii [mm] at which rim, web and hub end, from the outermost; of a full ring the bore's alone."""
    diameters = *gear.web_diameters, gear.bore_diameter
    return [0.5 * each for each in dict.fromkeys(diameters)]


def _down_to_bore(
    top: Floats, circles: list[float], angles: tuple[float, float], rows: Floats, below: list[int]
) -> Iterator[Piece]:
    """The blocks between a line of points (n, 2), circles [mm] and two angles [rad].

    rows: fractions of the way from the line to the first circle. below: rows of cells from each circle to the next.
    """
    across = np.linspace(0, 1, len(top))
    angle = angles[0] + across * (angles[1] - angles[0])
    outer = polar(np.full(len(top), circles[0]), angle)
    west, east = (line(top[k], outer[k], rows) for k in (0, -1))
    yield grid_piece(transfinite(top, outer, west, east, across, rows))
    for (high, low), count in zip(pairwise(circles), below):
        radius = subdivided(np.geomspace(high, low, count + 1), 2)  # cells of one shape, as displacements want it
        yield grid_piece(polar(*np.broadcast_arrays(radius, angle[:, None])))
