"""From nodal pressures to what a gear engineer reads: per tooth force, fitted peak pressure, contact length, balance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.data import Floats
from solver.gear_body import GearBody
from solver.gear_position import PositionResult
from solver.material import Material

FEWEST = 3  # nodes under pressure that a fit of a half-ellipse needs


@dataclass(frozen=True)
class Slices:
    """The contact of a position cut at the flank's node rows of equal height; one entry per tooth pair and row that
    carries load.

    tooth, z [mm], ξ [mm], width (of the slice along z) [mm; 1 in 2D], line_load [N/mm of contact line], peak: fitted
    pressure [MPa], largest: of the nodes [MPa], half_width: fitted, of the profile arc [mm], hertz: p0 for the slice's
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


def slices(result: PositionResult, pinion: GearBody, materials: tuple[Material, Material]) -> Slices:
    """Cuts a position's contact into slices of constant z."""
    z = np.round(pinion.z[result.node], 9)
    widths = slice_widths(pinion)
    arc = pinion.roll_length[result.node] ** 2 / (2.0 * pinion.gear.base_radius)
    keys = sorted({(int(t), float(h)) for t, h, p in zip(result.tooth, z, result.pressure) if p > 0.0})
    rows = [_slice(result, (result.tooth == t) & (z == h), arc, widths[h], t, h, pinion, materials) for t, h in keys]
    columns = list(zip(*rows)) if rows else [()] * 10
    return Slices(*(np.array(c) for c in columns))


def slice_widths(pinion: GearBody) -> dict[float, float]:
    """Height z -> extent [mm] along z that the node row stands for (1 in 2D: loads are per mm there)."""
    heights = np.unique(np.round(pinion.z, 9))
    if len(heights) == 1:
        return {float(heights[0]): 1.0}
    edges = np.concatenate([[heights[0]], 0.5 * (heights[1:] + heights[:-1]), [heights[-1]]])
    return dict(zip(heights.tolist(), np.diff(edges).tolist()))


def _slice(
    result: PositionResult, here: np.ndarray, arc: Floats, width: float, tooth: int, z: float, pinion: GearBody,
    materials: tuple[Material, Material],
) -> tuple[float, ...]:  # fmt: skip
    pair = result.stand.pair
    p, s, m = result.pressure[here], arc[here], result.weights[here]
    cos_b = np.cos(pair.pinion.base_helix_angle)
    load = float(np.sum(p * m)) / (width / cos_b)
    ξ = float(result.ξ[here][0])
    edge = bool(np.any(result.edge[here] & (p > 0.0)))
    ρ = float(pair.relative_curvature_radius(np.clip(ξ, *pair.path_of_contact)))
    modulus = 1.0 / sum(1.0 / material.plane_modulus for material in materials)
    peak, half = (np.nan, np.nan) if edge else fitted_peak(s, p)
    hertz = float(np.sqrt(load * modulus / (np.pi * ρ)))
    return tooth, z, ξ, width, load, peak, float(p.max()), half, hertz, edge


def fitted_peak(s: Floats, p: Floats) -> tuple[float, float]:
    """Peak and half-width of the half-ellipse p² = p0²(1 − (s − s0)²/b²) that fits nodal pressures best.

    The fit takes the nodes above a third of the largest pressure (the contact's ends are a matter of the node spacing).
    Where fewer than three such nodes, or no ellipse, are found: the largest pressure and NaN.
    """
    high = p > p.max() / 3.0
    if high.sum() < FEWEST:
        return float(p.max()), float("nan")
    centre = s[high].mean()
    c2, c1, c0 = np.polyfit(s[high] - centre, p[high] ** 2, 2)
    if c2 >= 0.0:
        return float(p.max()), float("nan")
    top = c0 - c1**2 / (4.0 * c2)
    return float(np.sqrt(top)), float(np.sqrt(-top / c2))


def tooth_summaries(result: PositionResult, cut: Slices) -> list[ToothSummary]:
    """Per tooth pair in contact, ascending."""
    cos_b = np.cos(result.stand.pair.pinion.base_helix_angle)
    summaries = []
    for tooth in np.unique(cut.tooth):
        here = cut.tooth == tooth
        nodes = result.tooth == tooth
        peak = float(np.nanmax(cut.peak[here], initial=0.0))
        edge = float(cut.largest[here & cut.edge].max(initial=0.0))
        force = float(np.sum(result.pressure[nodes] * result.weights[nodes]))
        summaries.append(ToothSummary(int(tooth), force, peak, edge, float(cut.width[here].sum() / cos_b)))
    return summaries


def balance_error(result: PositionResult) -> float:
    """The largest of the relative force, moment and energy imbalances."""
    return max(result.residual, result.energy_imbalance)
