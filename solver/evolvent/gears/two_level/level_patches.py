"""Correction of a flank's compliance by fine cells: patches about coarse cells, at some places of the profile only.

Under the screw motion of the helicoid all layers along the face are congruent, so that all but those near the ends of
the face share their response. Along the profile the response changes slowly: that of a row is interpolated between
those of a few, turned with the flank's normal. Rows and layers near the edges of the flank have their own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.interpolate import BarycentricInterpolator

from evolvent.contact.two_level.fine_surface import CoarseBody, FineSurface
from evolvent.contact.two_level.patch_response import patch_response
from evolvent.fem.parallel.memory import Stack
from evolvent.fem.surface import Surface
from evolvent.gears.two_level.coarse_axis import Axis
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent.gears.two_level.strips import StripCorrection, turned
from evolvent.gears.two_level.symmetric_strips import Strip
from evolvent_meshes.arrays import Bools, Floats, Ints, Reals
from evolvent_meshes.mesh.patches import Patch
from evolvent_meshes.rotation import turn

REACH = 1.1
"""How far a patch extends beyond the loaded cells, in the longest edges of the coarse flank's cells. Difference of nine
in ten peak pressures of Yang's pair at quick from exact condensation of the same cells with 0.8, 1.1, 1.5, 2: 0.71,
0.11, 0.08, 0.08 %."""
STEEP, STEEP_REACH = np.radians(30.0), 1.6
"""Base helix angle from which on patches reach further, and how far. The same difference of four random pairs with
reference helix angles from 35° to 37°, all peaks, with 1.1 and 1.6: 2.6, 1.3, 1.3, 0.9 and 1.7, 0.5, 0.6, 0.5 %."""
NEGLIGIBLE = 5e-3
"""Nodes at a patch's rim that move by less than this fraction of the largest displacement are left out."""
SAMPLES = 4
"""Rows between those near root and tip whose response is computed, not interpolated. Largest error of a correction, of
its largest entry, with three, four, five (Yang's pinion, at the ends of its face, where it is largest): 2.8, 1.0 and
0.7 %."""
COST = 1.5
"""Power of the number of a patch's fine cells with which its time grows, with Nitsche's functionals or without: 0.4 to
0.6 s for 680 cells, 1.6 to 2.8 s for 1,200."""

Block = tuple[range, range]
"""Rows and layers of coarse cells that are loaded in one patch."""


def reach_of(flank: FlankLattice, base_helix_angle: float) -> float:
    """How far patches extend beyond the loaded cells of a flank [mm]. base_helix_angle: of either sign [rad]."""
    edges = STEEP_REACH if abs(base_helix_angle) >= STEEP else REACH
    return edges * float(flank.edges().max())


@dataclass(frozen=True)
class Response:
    """Correction of the displacements under the loads on a block of cells.

    change: (P, Q, d, p, q, d) displacements of P × Q nodes of the lattice by unit forces on p × q of them, in the frame
        that turns with the flank's normal, in single precision [mm/N].
    before: (2,) rows and levels of nodes that move, before the first that is loaded.
    offset: (2,) rows and layers of cells from the one whose frame it is to the first that is loaded.
    """

    change: Reals
    before: Ints
    offset: Ints

    def by_row(self, nodes: int, cells: int) -> list[Response]:
        """Response to the loads on each row of so many cells, of so many rows of nodes; the last one may have one
        more."""
        result = []
        for cell, (a, b) in enumerate(pairwise([*(nodes * np.arange(cells)), self.change.shape[3]])):
            before = np.array([self.before[0] + a, self.before[1]])
            result.append(Response(self.change[:, :, :, a:b], before, self.offset + np.array([cell, 0])))
        return result

    def by_layer(self, nodes: int, cells: int) -> list[Response]:
        """Response to the loads on each layer of so many cells, of so many levels of nodes; the last one may have one
        more."""
        return [each._swapped() for each in self._swapped().by_row(nodes, cells)]

    def _swapped(self) -> Response:
        """Response with rows and levels exchanged."""
        return Response(np.transpose(self.change, (1, 0, 2, 4, 3, 5)), self.before[::-1], self.offset[::-1])


@dataclass(frozen=True)
class BlockResponse:
    """Corrections of the required functionals under the loads on a block of cells."""

    plain: Response | None
    """Correction of displacements: where a finer level follows, or contact is computed on the gear without the
    pressure."""
    nitsche: Response | None
    """Correction of the functionals of Nitsche's pressure side: where contact is computed on the gear that carries
    it."""

    @property
    def inner(self) -> Response:
        """Response for a finer level."""
        assert self.plain is not None
        return self.plain

    @property
    def contact(self) -> Response:
        """Response for contact on this level."""
        return self.inner if self.nitsche is None else self.nitsche


@dataclass(frozen=True)
class LoadedPatch:
    """The patch of a block of coarse cells.

    block: the cells with forces.
    patch: cells within reach of them.
    cost: estimated, relative to that of other patches of any flank.
    """

    block: Block
    patch: Patch
    cost: float


class LevelPatches:
    """Patches of one level of a swept flank.

    body: the flank's coarse cells, all layers of one height, and how they are split, all alike along profile and face.
    base_radius: of the gear [mm].
    twist: rotation of the section along the face [rad/mm].
    held: facet groups of the body that are fixed.
    flux_safety: see `patch_response`.
    is_followed: whether a finer level follows, which takes the displacements even where there is a `flux_safety`.
    """

    def __init__(
        self, body: CoarseBody, base_radius: float, twist: float, held: tuple[str, ...], flux_safety: float | None,
        is_followed: bool = False,
    ) -> None:
        self._body, self._base_radius, self._twist = body, base_radius, twist
        self._held, self._flux_safety = held, flux_safety
        self._is_plain = flux_safety is None or is_followed
        self._coarse, self._fine = (FlankLattice.of(each.points) for each in (body.surface, body.fine.surface))
        self._nodes = 2 * np.array(self._fine.cells) // self._coarse.cells
        self._cells = self._coarse.place(body.surface.points[body.surface.facets[:, -1]]) // 2
        base_helix_angle = float(np.arctan(twist * base_radius))
        self._reach, self._flux_reach = (reach_of(each, base_helix_angle) for each in (self._coarse, self._fine))

    @cached_property
    def axes(self) -> tuple[Axis, Axis]:
        """Coarse cells along the profile and along the face."""
        rows, layers = self._coarse.cells
        corners = self._coarse.points[::2, ::2]
        return (
            Axis.of(corners[:, layers // 2], self._reach, SAMPLES),
            Axis.of(corners[rows // 2], self._reach, 1),
        )

    @property
    def coarse(self) -> Surface:
        """The flank before it is divided."""
        return self._body.surface

    @property
    def surface(self) -> FineSurface:
        """The finely divided flank."""
        return self._body.fine

    def patches(self) -> list[LoadedPatch]:
        """All patches that `correction` needs."""
        profile, face = self.axes
        layers = [*face.own, *(range(i, i + 1) for i in face.sampled)]
        return [self._patch((rows, those)) for those in layers for rows in profile.loaded]

    def _patch(self, block: Block) -> LoadedPatch:
        loaded = np.isin(self._cells[:, 0], block[0]) & np.isin(self._cells[:, 1], block[1])
        patch = self._body.near(np.flatnonzero(loaded), self._reach)
        cells = float(self._body.counts[patch.cells].prod(axis=1).sum())
        return LoadedPatch(block, patch, cells**COST)

    def correction(self, responses: Mapping[Block, Response]) -> StripCorrection:
        """Correction from the `response` of each of the `patches`, all plain or all of Nitsche's functionals."""
        _, face = self.axes
        strips = []
        for block in face.own:
            for row, response in self._along_profile(block, responses):
                for layer, each in zip(block, response.by_layer(int(self._nodes[1]), len(block))):
                    strips.append(self._strip(each, row, range(layer, layer + 1)))
        for layer in face.sampled:
            rows = self._along_profile(range(layer, layer + 1), responses)
            strips += [self._strip(response, row, face.between) for row, response in rows]
        return StripCorrection.of(self._fine, int(self._nodes[1]), self._angle, strips)

    def _along_profile(self, layers: range, responses: Mapping[Block, Response]) -> Iterator[tuple[int, Response]]:
        """The responses to loads on each row of coarse cells in some layers."""
        profile, _ = self.axes
        known = []
        for block in sorted(profile.loaded, key=lambda block: block.start):
            for row, each in zip(block, responses[block, layers].by_row(int(self._nodes[0]), len(block))):
                if row in profile.between:
                    known.append(self._alike(each, row))
                else:
                    yield row, each
        for row in profile.between:
            weights = BarycentricInterpolator(profile.sampled, np.eye(len(known)))(row)
            change = np.sum([weight * each.change for weight, each in zip(weights, known)], axis=0)
            yield row, replace(known[0], change=change)

    def _alike(self, response: Response, row: int) -> Response:
        """Response to the loads on a row between the blocks, in its own frame and on as many rows of nodes about it as
        those of all such rows have."""
        profile, _ = self.axes
        below, above = self._nodes[0] * np.array(profile.extent(profile.between))
        P, _, _, p, *_ = response.change.shape
        low = int(response.before[0] - below)
        high = low + int(below + p + above) + 1
        change = np.zeros((high - low, *response.change.shape[1:]), dtype=np.float32)
        change[max(-low, 0) : P - low] = response.change[max(low, 0) : high]
        R = turn(self._normal_angle(row - int(response.offset[0])) - self._normal_angle(row), 3).astype(np.float32)
        change = np.einsum("ba,PQbpqc,ce->PQapqe", R, change, R, optimize=True)
        return Response(change, np.array([below, response.before[1]]), response.offset * np.array([0, 1]))

    def response(self, loaded: LoadedPatch, stack: Stack | None = None) -> BlockResponse:
        """Response of one of the `patches`; stack: see `patch_response`. Raises NotPositiveDefinite, OutOfMemory."""
        low, high = self._loaded_nodes(loaded.block)

        def within(points: Floats) -> Bools:
            at = self._fine.place(points)
            return np.asarray((at >= low).all(axis=1) & (at < high).all(axis=1))

        found = patch_response(
            self._body, loaded.patch, self._held, self._flux_safety, within, self._flux_reach, stack
        )

        def framed(change: Floats) -> Response:
            return self._framed(loaded.block, found.points, found.loaded, change)

        plain = framed(found.change) if self._is_plain else None
        return BlockResponse(plain, None if found.nitsche is None else framed(found.nitsche))

    def _framed(self, block: Block, points: Floats, loaded: Bools, change: Floats) -> Response:
        """A change (n, 3, s, 3) at fine nodes (n, 3), some of them `loaded`, on the lattice and in the frame that turns
        with the flank's normal."""
        low, high = self._loaded_nodes(block)
        last = np.array(self._fine.nodes.shape) - 1
        # patches between the blocks have one shape, so that they can be interpolated
        both = zip(self.axes, block)
        alike = (axis.between if {*cells} <= {*axis.between} else cells for axis, cells in both)
        below, above = self._nodes * np.transpose([axis.extent(each) for axis, each in zip(self.axes, alike)])
        start, stop = np.maximum(0, low - below), np.minimum(last, high + above) + 1
        at = self._fine.place(points)
        moves = (at >= start).all(axis=1) & (at < stop).all(axis=1)
        R = turn(self._angle[low[1]] - self._normal_angle(block[0].start), 3)
        R, single = R.astype(np.float32), change[moves].astype(np.float32)  # as strips are in the end
        turned_change = np.einsum("ba,ibjc,ce->iaje", R, single, R, optimize=True)
        result = np.zeros((*(stop - start), 3, *(high - low), 3), dtype=np.float32)
        i, j = at[moves] - start, at[loaded] - low
        result[i[:, 0, None], i[:, 1, None], :, j[:, 0], j[:, 1]] = np.moveaxis(turned_change, 1, 2)
        return Response(result, low - start, np.zeros(2, dtype=np.int64))

    def _loaded_nodes(self, block: Block) -> tuple[Ints, Ints]:
        """The first row and level of nodes with forces on a block of cells, and those after the last ones."""
        rows, layers = block
        low, high = np.array([[rows.start, layers.start], [rows.stop, layers.stop]]) * self._nodes
        high += high == np.array(self._fine.nodes.shape) - 1  # the last nodes of the flank belong to its last cells
        return low, high

    def _strip(self, response: Response, row: int, layers: range) -> Strip:
        """A response at its places: loads on cells from this row on, and from each of these layers on."""
        P, Q, _, p, q, _ = response.change.shape
        source = self._nodes * [row, layers.start]
        start = source - response.before
        # from the frame that turns with the normal, at the first loaded cell, to those of the layers
        frame = source[1] - self._nodes[1] * response.offset[1]
        first = self._angle[frame] - self._normal_angle(row - response.offset[0])
        moved, loaded = (first - self._angle[at : at + count] for at, count in ((start[1], Q), (source[1], q)))
        change = turned(np.moveaxis(response.change, 2, -1), moved[:, None, None, None])
        change = turned(np.moveaxis(change, -2, -1), loaded[:, None])  # (P, Q, p, q, d moved, d loaded)
        change = np.ascontiguousarray(np.transpose(change, (3, 2, 5, 1, 0, 4))).reshape(q * p * 3, -1)
        places = [(int(each[1]), int(each[0])) for each in (source, start)]
        return Strip(change, (q, p), (Q, P), places[0], places[1], len(layers)).trimmed(NEGLIGIBLE)

    @cached_property
    def _angle(self) -> Floats:
        """Rotation (levels,) of the frame of the coarse layer in which each level of fine nodes is [rad]."""
        layer = np.minimum(np.arange(self._fine.nodes.shape[1]) // self._nodes[1], self._coarse.cells[1] - 1)
        return np.asarray(self._twist * self._coarse.height[2 * layer])

    def _normal_angle(self, row: int) -> float:
        """Angle by which the flank's normal turns along the profile up to the first corner of a row of coarse cells
        [rad]."""
        r = self._coarse.radius[2 * row]
        return float(np.sqrt(max(r**2 - self._base_radius**2, 0.0)) / self._base_radius)
