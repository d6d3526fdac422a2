"""What fine cells change in a flank's compliance: patches about coarse cells, at some places of the profile only.

Under the screw motion of the helicoid all layers along the face are congruent, so that all but those near the ends of
the face share their response. Along the profile the response changes slowly: that of a row is interpolated between
those of a few, turned with the flank's normal. Rows and layers near the edges of the flank have their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BarycentricInterpolator

from evolvent.contact.two_level.correction import Correction, PlacedResponse
from evolvent.contact.two_level.fine_surface import CoarseBody
from evolvent.contact.two_level.patch_response import patch_response
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent_meshes.arrays import Floats, Ints

REACH = 1.1
"""How far a patch extends beyond the loaded cells, in the longest edges of the coarse flank's cells. Difference of nine
in ten peak pressures of Yang's pair at quick from exact condensation of the same cells with 0.8, 1.1, 1.5, 2: 0.71,
0.11, 0.08, 0.08 %."""
SAMPLES = 5
"""Rows between those near root and tip that have a patch of their own."""


def reach_of(body: CoarseBody) -> float:
    """How far patches extend beyond the loaded cells [mm]."""
    return REACH * float(FlankLattice.of(body.surface.points).edges().max())


@dataclass(frozen=True)
class Axis:
    """The coarse cells of a flank along its profile or its face.

    count: their number.
    side: how many lie within reach on each side of a loaded one.
    samples: how many between those near the ends have a patch of their own.
    """

    count: int
    side: int
    samples: int

    @property
    def own(self) -> list[range]:
        """Blocks of cells near the ends, each loaded in one patch; all cells if that costs less, by the third power of
        the patches' extent."""
        near, patch = self.side + 1, 2 * self.side + 1
        if self.count <= 2 * near or self.count**3 <= (2 + self.samples) * patch**3:
            return [range(self.count)]
        return [range(near), range(self.count - near, self.count)]

    @property
    def between(self) -> range:
        """The cells in no block."""
        blocks = self.own
        return range(blocks[0].stop, blocks[-1].start)

    @property
    def sampled(self) -> list[int]:
        """Those of them that have a patch of their own: the middle one, or several, closer towards both ends, as a
        polynomial through them wants it (Chebyshev)."""
        cells = self.between
        if self.samples == 1 or len(cells) < 2:
            return [cells[len(cells) // 2]] if cells else []
        along = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, self.samples))
        return sorted({cells[round(i)] for i in along * (len(cells) - 1)})


@dataclass(frozen=True)
class Response:
    """What changes under the loads on a block of cells.

    change: (P, Q, d, p, q, d) displacements of P × Q nodes of the lattice by unit forces on p × q of them, in the frame
        that turns with the flank's normal [mm/N].
    before: (2,) rows and levels of nodes that move, before the first that is loaded.
    """

    change: Floats
    before: Ints


class Towers:
    """The patches of a swept flank.

    body: the flank's coarse cells, all layers of one height, and how they are split, all alike along profile and face.
    base_radius: of the gear [mm].
    twist: rotation of the section along the face [rad/mm].
    held: facet groups of the body that are fixed.
    flux_safety: see `patch_response`.
    """

    def __init__(
        self, body: CoarseBody, base_radius: float, twist: float, held: tuple[str, ...], flux_safety: float | None
    ) -> None:
        self._body, self._base_radius, self._twist = body, base_radius, twist
        self._held, self._flux_safety = held, flux_safety
        self._coarse, self._fine = (FlankLattice.of(each.points) for each in (body.surface, body.fine.surface))
        self._nodes = 2 * np.array(self._fine.cells) // self._coarse.cells
        self._cells = self._coarse.place(body.surface.points[body.surface.facets[:, -1]]) // 2
        self._reach = reach_of(body)

    @property
    def axes(self) -> tuple[Axis, Axis]:
        """Along the profile and along the face."""
        rows, layers = self._coarse.cells
        corners = self._coarse.points[::2, ::2]
        return (
            Axis(rows, self._side(corners[:, layers // 2]), SAMPLES),
            Axis(layers, self._side(corners[rows // 2]), 1),
        )

    def correction(self) -> Correction:
        """Raises NotPositiveDefinite, OutOfMemory."""
        _, face = self.axes
        placed = [each for block in face.own for each in self._along_profile(block, [block.start])]
        for layer in face.sampled:
            placed += self._along_profile(range(layer, layer + 1), face.between)
        return Correction(len(self._body.fine.surface.points), placed)

    def _along_profile(self, layers: range, places: range | list[int]) -> list[PlacedResponse]:
        """The responses of all rows to loads on some layers, used where those are the first layers."""
        profile, _ = self.axes
        placed = [self._placed(self._response(block, layers), block.start, places) for block in profile.own]
        known = [self._response(range(row, row + 1), layers) for row in profile.sampled]
        for row in profile.between:
            weights = BarycentricInterpolator(profile.sampled, np.eye(len(known)))(row)
            change = np.sum([weight * each.change for weight, each in zip(weights, known)], axis=0)
            placed.append(self._placed(Response(change, known[0].before), row, places))
        return placed

    def _side(self, corners: Floats) -> int:
        """How many cells within reach, from their corners (count + 1, 3) along one line."""
        distance = np.linalg.norm(corners[:, None] - corners, axis=2)
        return int(np.triu(distance < self._reach).sum(axis=1).max())

    def _response(self, rows: range, layers: range) -> Response:
        """Of the patch about some cells."""
        loaded = np.isin(self._cells[:, 0], rows) & np.isin(self._cells[:, 1], layers)
        patch = self._body.near(np.flatnonzero(loaded), self._reach)
        response = patch_response(self._body, patch, self._held, self._flux_safety)
        at, last = self._fine.place(response.points), np.array(self._fine.nodes.shape) - 1
        cells = np.array([[rows.start, layers.start], [rows.stop, layers.stop]])
        low, high = cells * self._nodes
        high += high == last  # the last nodes of the flank belong to its last cells
        sides = self._nodes * [axis.side for axis in self.axes]
        start, stop = np.maximum(0, low - sides), np.minimum(last, high + sides) + 1
        moves, sources = ((at >= a).all(axis=1) & (at < b).all(axis=1) for a, b in ((start, stop), (low, high)))
        turn = self._turn(rows.start, layers.start)
        change = np.einsum("ba,ibjc,ce->iaje", turn, response.change[moves][:, :, sources], turn, optimize=True)
        result = np.zeros((*(stop - start), 3, *(high - low), 3))
        i, j = at[moves] - start, at[sources] - low
        result[i[:, 0, None], i[:, 1, None], :, j[:, 0], j[:, 1]] = np.moveaxis(change, 1, 2)
        return Response(result, low - start)

    def _placed(self, response: Response, row: int, layers: range | list[int]) -> PlacedResponse:
        """A response at its places: loads on cells from this row on, and from each of these layers on."""
        P, Q, d, p, q, _ = response.change.shape
        nodes, sources = [], []
        for layer in layers:
            first = self._nodes * [row, layer]
            sources.append(self._window(first, (p, q)))
            nodes.append(self._window(first - response.before, (P, Q)))
        turns = np.array([self._turn(row, layer) for layer in layers])
        return PlacedResponse(response.change.reshape(P * Q * d, -1), np.array(nodes), np.array(sources), turns)

    def _window(self, start: Ints, size: tuple[int, int]) -> Ints:
        """Numbers of the fine nodes in a part of the lattice."""
        rows, levels = (slice(a, a + n) for a, n in zip(start, size))
        return self._fine.nodes[rows, levels].ravel()

    def _turn(self, row: int, layer: int) -> Floats:
        """(3, 3) from the frame that turns with the normal, at the first corner of a coarse cell, to the gear's."""
        r = self._coarse.radius[2 * row]
        angle = self._twist * self._coarse.height[2 * layer]
        angle -= np.sqrt(max(r**2 - self._base_radius**2, 0.0)) / self._base_radius
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
