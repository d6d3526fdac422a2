"""Heights of a sector's layers of cells: below the teeth they end at the faces of a web, at the ends of a support."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.mesh.mesh_data import MeshError

ABOVE = 0.6
"""How far below the root circle, in normal modules, the layers are as on the flank: a rim is one module thick."""
FEWEST = 3
"""Layers that a web or a support may take a part of."""


def node_heights(gear: GearParameters, heights: Floats, radius: Floats) -> Floats:
    """Heights (levels, nodes) [mm] of a swept section's nodes.

    heights: (levels,) of the layers' nodes on the flank, ends and middles in turn [mm].
    radius: (nodes,) of the section [mm].
    At the bore the nearest ends of layers are moved to the ends of a partial support, from the inside of the rim to the
    hub to the faces of a web, the others evenly between. In the rim, and in the hub of a gear that has both, heights
    change in proportion to the radius. Raises MeshError for fewer than FEWEST layers.
    """
    plain = np.repeat(heights[:, None], len(radius), axis=1)
    known = list(_moved_layers(gear, heights))
    if not known or len(heights) < 2:
        return plain
    top = 0.5 * gear.root_diameter - ABOVE * gear.normal_module
    at, moved = zip(*known, (top, heights))
    return _interpolated(radius, np.array(at), np.array(moved))


def fewest_layers(gear: GearParameters) -> int:
    """Layers that a sector needs at least for its web or its support; 0 of a full ring that is held over its face."""
    return FEWEST if gear.thin_web is not None or gear.support.is_partial(gear.face_width) else 0


def web_layers(gear: GearParameters, heights: Floats) -> range:
    """The layers of cells that a web takes up, all of a full ring. heights: as of `node_heights`. Raises MeshError."""
    if (web := gear.thin_web) is None:
        return range(len(heights) // 2)
    return range(*_between(heights, gear.face_width, web.ends))


def _moved_layers(gear: GearParameters, heights: Floats) -> Iterator[tuple[float, Floats]]:
    """Radii [mm], rising, and the heights (levels,) [mm] there."""
    if gear.support.is_partial(gear.face_width):
        yield 0.5 * gear.bore_diameter, _moved(heights, gear.face_width, gear.support.ends(gear.face_width))
    if (web := gear.thin_web) is not None:
        outer, inner = gear.web_diameters
        moved = _moved(heights, gear.face_width, web.ends)
        yield 0.5 * inner, moved
        yield 0.5 * outer, moved


def _interpolated(radius: Floats, at: Floats, moved: Floats) -> Floats:
    """Heights (levels, nodes) at radii (nodes,), linear between known ones: moved (k, levels) at rising radii (k,)."""
    second = np.clip(np.searchsorted(at, radius), 1, len(at) - 1)
    share = np.clip((radius - at[second - 1]) / (at[second] - at[second - 1]), 0.0, 1.0)[:, None]
    return np.asarray(((1.0 - share) * moved[second - 1] + share * moved[second]).T)


def _between(heights: Floats, face_width: float, wanted: tuple[float, float]) -> tuple[int, int]:
    """Numbers of the two ends of layers that are nearest to two heights [mm]. Raises MeshError."""
    ends, half, (low, high) = heights[::2], face_width / 2.0, wanted
    if len(ends) <= FEWEST:
        raise MeshError(
            f"sector: wanted at least {FEWEST} layers where a gear has a web or is held on a part of its face, found "
            f"{len(ends) - 1}; take more face_elements"
        )
    last = len(ends) - 1
    first = 0 if low <= -half else int(np.clip(np.argmin(abs(ends - low)), 1, last - 1))
    second = last if high >= half else int(np.clip(np.argmin(abs(ends - high)), first + 1, last - 1))
    if first >= second:  # both between the last two ends
        first = second - 1
    return first, second


def _moved(heights: Floats, face_width: float, wanted: tuple[float, float]) -> Floats:
    """Heights (levels,) [mm] where layers end at two heights [mm]."""
    ends, half = heights[::2], face_width / 2.0
    first, second = _between(heights, face_width, wanted)
    places = {0: -half, len(ends) - 1: half, first: max(wanted[0], -half), second: min(wanted[1], half)}
    known = sorted(places)
    return np.interp(heights, ends[known], [places[each] for each in known])
