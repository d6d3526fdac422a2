"""Contact pressures by tooth and slice: force, fitted peak, contact length; balance of forces and energy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from evolvent.fem.material import Material, contact_modulus
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Bools, Floats, Ints

FEWEST_POINTS = 5
"""Points under pressure that the fit of a half-ellipse needs."""
HEIGHT_TOLERANCE = 1e-6
"""Heights [mm] closer than this are equal."""


@dataclass(frozen=True)
class Slices:
    """The contact at a position in n slices: one a tooth pair and a layer of the mesh along z that bears load."""

    tooth: Ints
    """(n,) int, index of the tooth pair."""
    z: Floats
    """(n,) height of the slice's middle [mm]."""
    roll_distance: Floats
    """(n,) distance ξ of the contact line from the pitch point along the transverse line of action [mm]."""
    width: Floats
    """(n,) extent along z [mm]; 1 in 2D."""
    line_load: Floats
    """(n,) normal force per length of the contact line [N/mm]."""
    peak: Floats
    """(n,) peak of the fitted half-ellipse [MPa]; NaN on a tip edge."""
    largest: Floats
    """(n,) largest pressure of the quadrature points [MPa]."""
    half_width: Floats
    """(n,) half-width of the fitted half-ellipse across the contact line [mm]; NaN on a tip edge."""
    hertz: Floats
    """(n,) Hertz' p0 for the slice's line load and the exact curvatures [MPa]."""
    edge: Bools
    """(n,) bool, whether the slice bears on a tip edge."""

    @staticmethod
    def joined(parts: Sequence[Slices]) -> Slices:
        """The slices of several positions in one."""
        return Slices(*(np.concatenate([getattr(cut, each.name) for cut in parts]) for each in fields(Slices)))


@dataclass(frozen=True)
class ToothSummary:
    """One tooth pair at a position."""

    tooth: int
    """Index of the tooth pair."""
    force: float
    """Normal force [N; N/mm in 2D]."""
    max_pressure: float
    """Largest fitted peak pressure away from tip edges [MPa]."""
    edge_pressure: float
    """Largest pressure on a tip edge [MPa]; 0 where none bears."""
    contact_length: float
    """Length of the contact line [mm]."""


def slices(result: PositionResult, heights: Floats, materials: tuple[Material, Material]) -> Slices:
    """The slices of a position. heights: (n,) z of the pinion flank's nodes [mm]; materials: (pinion, wheel)."""
    edges = layer_edges(heights)
    c = result.contact
    layer = np.clip(np.searchsorted(edges, c.z, side="right") - 1, 0, len(edges) - 2)
    modulus = contact_modulus(*materials)
    keys = np.unique(np.column_stack([c.tooth, layer]), axis=0)
    rows = [_slice(result, (c.tooth == t) & (layer == k), edges[k : k + 2], modulus) for t, k in keys]
    columns = list(zip(*rows)) if rows else [()] * 9
    return Slices(keys[:, 0], *(np.array(column) for column in columns))


def on_tip_edge(cut: Slices, tooth: int, z: Floats) -> Bools:
    """Whether heights z (n,) [mm] lie in (closed) layers in which a tooth pair bears on a tip edge: (n,) bool."""
    layers = np.flatnonzero((cut.tooth == tooth) & cut.edge)
    away = np.abs(z[:, None] - cut.z[layers]) - 0.5 * cut.width[layers]
    return np.asarray((away <= HEIGHT_TOLERANCE).any(axis=1))


def layer_edges(heights: Floats) -> Floats:
    """Boundaries (l + 1,) [mm] of the l element layers, from the heights of second-order nodes; in 2D one layer of unit
    width, for loads are per mm there."""
    rows = np.unique(np.round(heights, 9))
    return np.array([-0.5, 0.5]) if len(rows) == 1 else rows[::2]


def _slice(result: PositionResult, here: Bools, ends: Floats, modulus: float) -> tuple[float | bool, ...]:
    pair, c = result.stand.pair, result.contact
    p, w = c.pressure[here], c.weights[here]
    width = float(ends[1] - ends[0])
    load = float(np.sum(p * w)) / (width / np.cos(pair.pinion.base_helix_angle))
    ξ = float(np.average(c.roll_distance[here], weights=p * np.abs(w)))
    edge = bool(np.any(c.edge[here]))
    ρ = float(pair.relative_curvature_radius(np.clip(ξ, *pair.path_of_contact)))
    peak, half = (np.nan, np.nan) if edge else fitted_peak(c.across[here], p, w, load)
    hertz = float(np.sqrt(max(load, 0.0) * modulus / (np.pi * ρ)))
    return float(ends.mean()), ξ, width, load, peak, float(p.max()), half, hertz, edge


def fitted_peak(s: Floats, p: Floats, w: Floats, load: float) -> tuple[float, float]:
    """Peak p0 [MPa] and half-width b [mm] of the half-ellipse that has the pressure's line load and second moment.

    s, p, w: (n,) coordinate across the contact line [mm], pressure [MPa], weight of the quadrature points; load: F in
    N/mm. b = 2√(M_2/F), p0 = 2F/πb with M_2 the second moment about the centre of pressure: integrals of the contact
    pressure converge faster than its values, which scatter where the contact's rim lies in a cell. With fewer than five
    points: the largest pressure and NaN.
    """
    if len(p) < FEWEST_POINTS:
        return float(p.max()), float("nan")
    force = p @ w
    centre = (p * s) @ w / force
    half = 2.0 * np.sqrt((p * (s - centre) ** 2) @ w / force)
    return float(2.0 * load / (np.pi * half)), float(half)


def tooth_summaries(result: PositionResult, cut: Slices) -> list[ToothSummary]:
    """The tooth pairs in contact, ascending. cut: the position's slices."""
    cos_b = np.cos(result.stand.pair.pinion.base_helix_angle)
    summaries = []
    for tooth in np.unique(cut.tooth):
        here = cut.tooth == tooth
        peak = float(np.nanmax(cut.peak[here], initial=0.0))
        edge = float(cut.largest[here & cut.edge].max(initial=0.0))
        points = result.contact.tooth == tooth
        force = float(np.sum(result.contact.pressure[points] * result.contact.weights[points]))
        summaries.append(ToothSummary(int(tooth), force, peak, edge, float(cut.width[here].sum() / cos_b)))
    return summaries
