"""Contact pressures by tooth and slice: force, fitted peak, contact length; balance of forces and energy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from evolvent.contact.hertz import line_peak_pressure
from evolvent.fem.material import Material, contact_modulus
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.pressure.contact_cells import FEWEST_FITTED
from evolvent.gears.pressure.contact_curvature import nominal_radius, radius_in_place
from evolvent.gears.pressure.flank_facets import HEIGHT_TOLERANCE, FlankFacets
from evolvent.gears.pressure.relief_starts import ContactWidth, over_relief_starts
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Bools, Floats, Ints
from evolvent_meshes.gears.pair import GearPair

FEWEST_POINTS = 5
"""Points under pressure that the fit of a half-ellipse needs."""


@dataclass(frozen=True)
class Slices:
    """The contact at a position in n slices: one a tooth pair and a layer of the mesh along z that bears load."""

    tooth: Ints
    """Index (n,) of the tooth pair."""
    z: Floats
    """Height (n,) of the slice's middle [mm]."""
    roll_distance: Floats
    """Distance ξ (n,) of the contact line from the pitch point along the transverse line of action [mm]."""
    width: Floats
    """Extent (n,) along z [mm]; 1 in 2D."""
    line_load: Floats
    """Normal force (n,) per length of the contact line [N/mm]."""
    peak: Floats
    """Peak (n,) of the fitted half-ellipse [MPa]; NaN on a tip edge."""
    largest: Floats
    """Largest pressure (n,) of the quadrature points [MPa]."""
    half_width: Floats
    """Half-width (n,) of the fitted half-ellipse across the contact line [mm]; NaN on a tip edge."""
    hertz: Floats
    """Hertz' p0 (n,) for the slice's line load and `radius` [MPa]."""
    radius: Floats
    """Relative radius of curvature (n,) across the contact line [mm], for involutes that touch where the centre of the
    slice's pressure lies; on a tip edge, which has no curvature, that on the nominal contact line."""
    edge: Bools
    """Whether the slice bears on a tip edge, (n,)."""
    facet: Floats
    """Arc lengths (n, 2) of the facets of pinion and wheel in which the slice's nominal contact line lies [mm]."""
    kink: Bools
    """Whether the slice's contact covers the start of a linear tip or root relief of a spur pair, (n,); see
    `relief_starts`."""
    narrow: Bools
    """Whether the contact of a spur pair is by Hertz narrower than `FEWEST_FITTED` facets of either flank, (n,). Its
    line load is accurate, its fitted peak is not. On helical lines neighbouring slices make up for it."""

    @staticmethod
    def joined(parts: Sequence[Slices]) -> Slices:
        """The slices of several positions in one."""
        return Slices(*(np.concatenate([getattr(cut, each.name) for cut in parts]) for each in fields(Slices)))

    @property
    def contact_width(self) -> ContactWidth:
        """Width of the contact by Hertz' half-width 2F/πp0 for the slice's line load; 0 without load."""
        loaded = self.hertz > 0.0
        half = np.where(loaded, 2.0 * self.line_load / (np.pi * np.where(loaded, self.hertz, 1.0)), 0.0)
        return ContactWidth(self.roll_distance, half, self.radius, self.facet)

    def of(self, chosen: Ints) -> Slices:
        """Some of the slices. chosen: (k,) their indices."""
        return Slices(*(getattr(self, each.name)[chosen] for each in fields(Slices)))

    def on_nominal_lines(self, pair: GearPair) -> Slices:
        """Slices with Hertz' p0 for the curvatures on the nominal contact lines, which depends on the line loads
        alone."""
        radius = nominal_radius(pair, self.roll_distance)
        return replace(self, hertz=self.hertz * np.sqrt(self.radius / radius), radius=radius)

    def of_hertz(self) -> Slices:
        """Slices with Hertz' peak pressures for the line loads in place of the fitted ones."""
        return replace(self, peak=np.where(self.edge, np.nan, self.hertz))

    def of_line_loads(self, pair: GearPair) -> Slices:
        """Slices with peak pressures that depend on the line loads alone, on tip edges too: Hertz' with the curvatures
        on the nominal contact line."""
        nominal = self.on_nominal_lines(pair)
        return replace(nominal, peak=nominal.hertz)


@dataclass(frozen=True)
class ToothSummary:
    """Force and pressures of one tooth pair at a position."""

    tooth: int
    """Index of the tooth pair."""
    force: float
    """Normal force [N; N/mm in 2D]."""
    edge_pressure: float
    """Largest pressure on a tip edge [MPa]; 0 where none bears."""
    kink_pressure: float
    """Largest fitted peak pressure over the start of a linear relief [MPa]; 0 where the contact covers none."""
    contact_length: float
    """Length of the contact line [mm]."""


def slices(
    result: PositionResult, flanks: tuple[FlankFacets, FlankFacets], materials: tuple[Material, Material],
    exact: bool = False,
) -> Slices:
    """The slices of a position. flanks, materials: of pinion and wheel. exact: whether the contact is that of exact
    flanks, which no facets round: a line contact's."""
    c, edges = result.contact, layer_edges(flanks[0].z)
    tooth, layer, number = slice_numbers(c, edges)
    edge = np.bincount(number, c.edge, len(tooth)) > 0.0
    width = np.diff(edges)[layer]
    force = np.bincount(number, c.pressure * c.weights, len(tooth))
    load = force * np.cos(result.stand.pair.pinion.base_helix_angle) / width
    ξ, radius = _places(result, number, edge)
    hertz = line_peak_pressure(np.maximum(load, 0.0), radius, contact_modulus(*materials))
    largest, peak, half = _fits(c, number, load, edge)
    z = 0.5 * (edges[:-1] + edges[1:])[layer]
    pair = result.stand.pair
    facet = np.column_stack([flank.lengths_at(ρ) for flank, ρ in zip(flanks, pair.curvature_radii(ξ))]) * (not exact)
    cut = Slices(
        tooth, z, ξ, width, load, peak, largest, half, hertz, radius, edge, facet, *np.zeros((2, len(ξ)), dtype=bool)
    )
    if pair.pinion.base_helix_angle != 0.0:
        return cut
    narrow = 2.0 * cut.contact_width.half_width < FEWEST_FITTED * facet.max(axis=1)
    return replace(cut, kink=~edge & over_relief_starts(pair, cut.contact_width), narrow=narrow)


def slice_numbers(c: ContactPoints, edges: Floats) -> tuple[Ints, Ints, Ints]:
    """Tooth pair and layer (n,) of each slice, and the slice (q,) of each point. edges: (l + 1,) [mm]."""
    layers = len(edges) - 1
    layer = np.clip(np.searchsorted(edges, c.z, side="right") - 1, 0, layers - 1)
    keys, number = np.unique(c.tooth * layers + layer, return_inverse=True)
    tooth, layer = np.divmod(keys, layers)
    return tooth, layer, number


def on_tip_edge(cut: Slices, tooth: int, z: Floats) -> Bools:
    """Whether heights z (n,) [mm] lie in (closed) layers in which a tooth pair bears on a tip edge: (n,) bool."""
    return _in_layers(cut, np.flatnonzero((cut.tooth == tooth) & cut.edge), z)


def over_kink(cut: Slices, tooth: int, z: Floats) -> Bools:
    """Whether heights z (n,) [mm] lie in (closed) layers in which the contact of a tooth pair covers the start of a
    linear relief: (n,) bool."""
    return _in_layers(cut, np.flatnonzero((cut.tooth == tooth) & cut.kink), z)


def _in_layers(cut: Slices, layers: Ints, z: Floats) -> Bools:
    """Whether heights z (n,) [mm] lie in the (closed) layers of these slices: (n,) bool."""
    away = np.abs(z[:, None] - cut.z[layers]) - 0.5 * cut.width[layers]
    return np.asarray((away <= HEIGHT_TOLERANCE).any(axis=1))


def layer_edges(heights: Floats) -> Floats:
    """Boundaries (l + 1,) [mm] of the l element layers, from the heights of second-order nodes; in 2D one layer of unit
    width, for loads are per mm there."""
    rows = np.unique(np.round(heights, 9))
    return np.array([-0.5, 0.5]) if len(rows) == 1 else rows[::2]


def _places(result: PositionResult, number: Ints, edge: Bools) -> tuple[Floats, Floats]:
    """Values of `Slices.roll_distance` and `Slices.radius`, from means of the contact points weighted with their
    forces. number: (q,) slice of each point; edge: (n,)."""
    c, pair = result.contact, result.stand.pair
    force = c.pressure * np.abs(c.weights)
    whole = np.bincount(number, force, len(edge))
    columns = (c.roll_distance, c.across, c.opposite)
    ξ, pinion, wheel = (np.bincount(number, force * column, len(edge)) / whole for column in columns)
    on_line, in_place = nominal_radius(pair, ξ), radius_in_place(pair, ξ, (pinion, wheel))
    return ξ, np.where(edge | np.isnan(in_place), on_line, in_place)


def _fits(c: ContactPoints, number: Ints, load: Floats, edge: Bools) -> Floats:
    """Largest pressure of each slice and, away from tip edges, its `fitted_peak`, (3, n). number, edge: see `_places`;
    load: (n,) [N/mm]."""
    order = np.argsort(number, kind="stable")
    points = np.split(order, np.searchsorted(number[order], np.arange(1, len(load))))
    largest = [c.pressure[i].max() for i, _ in zip(points, load)]
    fits = [
        (np.nan, np.nan) if on_edge else fitted_peak(c.across[i], c.pressure[i], c.weights[i], F)
        for i, F, on_edge in zip(points, load, edge)
    ]
    return np.vstack([largest, np.array(fits).reshape(-1, 2).T])


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
        edge = float(cut.largest[here & cut.edge].max(initial=0.0))
        kink = float(cut.peak[here & cut.kink].max(initial=0.0))
        force, length = result.contact.normal_force(tooth), float(cut.width[here].sum() / cos_b)
        summaries.append(ToothSummary(int(tooth), force, edge, kink, length))
    return summaries
