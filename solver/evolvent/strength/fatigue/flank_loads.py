"""Pressure and friction at the points of the flanks over the engagement of a tooth.

While the contact passes over a point of a flank its pressure hardly changes, nor does its friction where it slides one
way. So the history there is that of the tractions at the moment when the contact line lies over it, moved on along the
profile: a slice of a position stands for the point of both flanks below its middle. Within a few half-widths of the
pitch line this does not hold: friction goes from μ over 0 to μ the other way while the contact passes over the point
(`strength.results.friction_reversal` has which points these are).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from evolvent.gears.pressure.contact_slices import Slices, layer_edges, slice_numbers
from evolvent.gears.pressure.line_peaks import between, counts, pooled_peaks
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.strength.fatigue.half_plane import HertzTractions, LineForces
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class FlankLoads:
    """Loads of the n slices of all positions of a pitch that are loaded between the tip-edge zones, away from the
    starts of linear reliefs."""

    place: Ints
    """Position in the pitch, tooth pair and layer of the face (n, 3): the same points at other friction coefficients
    have the same."""
    roll_distance: Floats
    """Distance ξ (n,) of the contact line from the pitch point along the line of action [mm]."""
    height: Floats
    """Axial position (n,) of the slice's middle [mm]."""
    peak: Floats
    """Peak p0 (n,) of the fitted half-ellipse of pressure, averaged with neighbours as in reported pressures [MPa]."""
    half_width: Floats
    """Half-width b (n,) across the contact line with the slice's line load, 2F/(π p0) [mm]."""
    friction: Floats
    """Tangential force over normal force (n,): μ where all of the slice slides, less where it sticks."""

    @staticmethod
    def joined(parts: Sequence[FlankLoads]) -> FlankLoads:
        """Loads of several positions together."""
        return FlankLoads(*(np.concatenate([getattr(p, each.name) for p in parts]) for each in fields(FlankLoads)))


@dataclass(frozen=True)
class LoadedPosition:
    """A position and its contact in slices."""

    index: int
    """Number of the position in the pitch."""
    result: PositionResult
    """Contact solution of the position."""
    cut: Slices
    """Slices of the contact."""
    heights: Floats
    """Axial positions z (m,) of the pinion flank's nodes [mm]."""

    def loads(self, inner: tuple[float, float]) -> FlankLoads:
        """Loads of the slices between the tip-edge zones, away from the starts of linear reliefs. inner: see
        `RunData.inner_path`."""
        chosen = self._chosen(inner)
        cut, peak = self.cut, pooled_peaks(self.cut)[chosen]
        half = 2.0 * cut.line_load[chosen] / (np.pi * peak)
        tooth, layer, _ = self._numbers
        place = np.column_stack([np.full(len(chosen), self.index), tooth[chosen], layer[chosen]])
        return FlankLoads(place, cut.roll_distance[chosen], cut.z[chosen], peak, half, self._friction[chosen])

    def solved_and_fitted(self, inner: tuple[float, float]) -> list[tuple[LineForces, HertzTractions]]:
        """Forces of the slices of `loads` as solved, at their quadrature points, beside the fitted tractions, both
        about the centre of pressure. inner: see `RunData.inner_path`."""
        own, number = self.loads(inner), self._numbers[2]
        found = []
        for k, slice_number in enumerate(self._chosen(inner)):
            fitted = HertzTractions(float(own.half_width[k]), float(own.peak[k]), float(own.friction[k]))
            load = float(self.cut.line_load[slice_number])
            found.append((self._solved(np.flatnonzero(number == slice_number), load), fitted))
        return found

    def _solved(self, here: Ints, load: float) -> LineForces:
        """Forces as solved of a slice with points `here` and a line load [N/mm]."""
        c = self.result.contact
        force = c.traction[here] * c.weights[here, None]
        force *= load / force[:, 0].sum()
        whole = force[:, 1:].sum(axis=0)
        along = force[:, 1:] @ (whole / max(float(np.linalg.norm(whole)), 1e-300))
        centre = force[:, 0] @ c.across[here] / load
        return LineForces(c.across[here] - centre, force[:, 0], along)

    def _chosen(self, inner: tuple[float, float]) -> Ints:
        return np.flatnonzero(counts(self.cut) & between(self.cut.roll_distance, inner))

    @cached_property
    def _numbers(self) -> tuple[Ints, Ints, Ints]:
        return slice_numbers(self.result.contact, layer_edges(self.heights))

    @cached_property
    def _friction(self) -> Floats:
        """Tangential force over normal force (slices,)."""
        c, number = self.result.contact, self._numbers[2]
        force = c.traction * c.weights[:, None]
        normal, *tangential = (np.bincount(number, column) for column in force.T)
        if not tangential:
            return np.zeros(len(normal))
        return np.asarray(np.linalg.norm(tangential, axis=0) / normal)
