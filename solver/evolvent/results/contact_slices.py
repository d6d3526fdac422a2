"""From contact pressures to what a gear engineer reads: force, fitted peak and contact length of a tooth, balance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.fem.material import Material, contact_modulus
from evolvent.gears.sweep.position import PositionResult
from evolvent_meshes.arrays import Floats

FEWEST = 5  # points under pressure that a fit of a half-ellipse needs
SAME = 1e-6  # [mm] of height


@dataclass(frozen=True)
class Slices:
    """The contact of a position cut into the layers of the mesh along z; one entry per tooth pair and layer with load.

    tooth, z (middle) [mm], ξ [mm], width (along z) [mm; 1 in 2D], line_load [N/mm of contact line], peak: fitted
    pressure [MPa], largest: of the points [MPa], half_width: fitted, across the line [mm], hertz: p0 for the slice's
    own line load and exact curvatures [MPa]; edge: bears on a tip edge, where peak is NaN.
    """

    tooth: np.ndarray
    z: Floats
    ξ: Floats
    width: Floats
    line_load: Floats
    peak: Floats
    largest: Floats
    half_width: Floats
    hertz: Floats
    edge: np.ndarray


@dataclass(frozen=True)
class ToothSummary:
    """One tooth pair at a position: normal force [N], fitted peak pressure away from tip edges [MPa], largest pressure
    at a tip edge [MPa, 0 without], length of the contact line [mm]."""

    tooth: int
    force: float
    max_pressure: float
    edge_pressure: float
    contact_length: float


def slices(result: PositionResult, heights: Floats, materials: tuple[Material, Material]) -> Slices:
    """Cuts a position's contact into slices of constant z; heights: z of the pinion flank's nodes (n,) [mm]."""
    edges = layer_edges(heights)
    c = result.contact
    layer = np.clip(np.searchsorted(edges, c.z, side="right") - 1, 0, len(edges) - 2)
    modulus = contact_modulus(*materials)
    keys = np.unique(np.column_stack([c.tooth, layer]), axis=0)
    rows = [_slice(result, (c.tooth == t) & (layer == k), edges[k : k + 2], modulus) for t, k in keys]
    columns = list(zip(*rows)) if rows else [()] * 9
    return Slices(keys[:, 0], *(np.array(column) for column in columns))


def on_tip_edge(cut: Slices, tooth: int, z: Floats) -> np.ndarray:
    """(n,) bool: heights z (n,) [mm] of layers in which a tooth pair bears on a tip edge, their rims included."""
    layers = np.flatnonzero((cut.tooth == tooth) & cut.edge)
    away = np.abs(z[:, None] - cut.z[layers]) - 0.5 * cut.width[layers]
    return np.asarray((away <= SAME).any(axis=1))


def layer_edges(heights: Floats) -> Floats:
    """Ends (l + 1,) of the element layers from the heights of second-order nodes [mm]; in 2D one layer of unit width
    (loads are per mm there)."""
    rows = np.unique(np.round(heights, 9))
    return np.array([-0.5, 0.5]) if len(rows) == 1 else rows[::2]


def _slice(result: PositionResult, here: np.ndarray, ends: Floats, modulus: float) -> tuple[float | bool, ...]:
    pair, c = result.stand.pair, result.contact
    p, w = c.pressure[here], c.weights[here]
    width = float(ends[1] - ends[0])
    load = float(np.sum(p * w)) / (width / np.cos(pair.pinion.base_helix_angle))
    ξ = float(np.average(c.ξ[here], weights=p * np.abs(w)))
    edge = bool(np.any(c.edge[here]))
    ρ = float(pair.relative_curvature_radius(np.clip(ξ, *pair.path_of_contact)))
    peak, half = (np.nan, np.nan) if edge else fitted_peak(c.across[here], p, w, load)
    hertz = float(np.sqrt(max(load, 0.0) * modulus / (np.pi * ρ)))
    return float(ends.mean()), ξ, width, load, peak, float(p.max()), half, hertz, edge


def fitted_peak(s: Floats, p: Floats, w: Floats, load: float) -> tuple[float, float]:
    """Peak [MPa] and half-width [mm] of the half-ellipse with the line load F [N/mm] and the second moment of pressures
    p at points s across the line, with quadrature weights w: b = 2√(M_2/F), p0 = 2F/πb.

    Integrals of the contact pressure converge faster than its values, which scatter where the patch just enters a cell.
    Where fewer than five points are pressed: the largest pressure and NaN.
    """
    if len(p) < FEWEST:
        return float(p.max()), float("nan")
    force = p @ w
    centre = (p * s) @ w / force
    half = 2.0 * np.sqrt((p * (s - centre) ** 2) @ w / force)
    return float(2.0 * load / (np.pi * half)), float(half)


def tooth_summaries(result: PositionResult, cut: Slices) -> list[ToothSummary]:
    """Per tooth pair in contact, ascending."""
    cos_b = np.cos(result.stand.pair.pinion.base_helix_angle)
    summaries = []
    for tooth in np.unique(cut.tooth):
        here = cut.tooth == tooth
        peak = float(np.nanmax(cut.peak[here], initial=0.0))
        edge = float(cut.largest[here & cut.edge].max(initial=0.0))
        own = result.contact.tooth == tooth
        force = float(np.sum(result.contact.pressure[own] * result.contact.weights[own]))
        summaries.append(ToothSummary(int(tooth), force, peak, edge, float(cut.width[here].sum() / cos_b)))
    return summaries
