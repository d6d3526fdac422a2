"""What the points of a flank see in one mesh passage, read from a solved pitch of a plane pair, and what formulas say.

A point bears while the contact, 2b wide, goes over it. The single-point observation takes load and specific sliding ζ
for constant meanwhile (He et al. 2022, Eqs 21, 22): it slides 2b|ζ|, and a ridge of line load F/L wears

    h = (K/H)(F/L)|ζ|

whatever its width; the product of the largest stress and the sliding distance (Eq. 24) is 4/π times that.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid

from evolvent.contact.hertz import line_half_width, line_peak_pressure
from evolvent.fem.material import contact_modulus
from evolvent.gears.sweep.position import PositionResult
from evolvent.results.engagement import engagement
from evolvent.results.fields.flank_field import flank_field
from evolvent.results.run_data import RunData
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent.wear.gears.passage import passage
from evolvent.wear.results.report import WornPair
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair

Ridge = Callable[[RunData, PositionResult, int, Floats], Floats]
"""Pressure (n,) [MPa] of a tooth pair at a position, at distances (n,) [mm] from the contact line."""
WIDER = 1.6  # times as long as Hertz' width lasts is a point watched


@dataclass(frozen=True)
class Contacts:
    """The contact's stands along a gear's flank, off the tip edges, entries (n,) ascending with ξ.

    ξ, radius [mm]; peak: fitted pressure, hertz: p0 for the own line load [MPa]; half_width: fitted, hertz_half_width
    [mm]; sliding: of the point under the contact's middle, with the fitted width, single_point: 2b|ζ| with Hertz' b
    [mm].
    """

    ξ: Floats
    radius: Floats
    peak: Floats
    hertz: Floats
    half_width: Floats
    hertz_half_width: Floats
    sliding: Floats
    single_point: Floats

    @staticmethod
    def of(run: RunData, gear: int) -> Contacts:
        """Of a plane pair's pitch without friction coefficients other than its first."""
        cuts = [each[0].cut for each in run.positions]
        ξ, load, peak, hertz, b = (
            np.concatenate([getattr(cut, name) for cut in cuts])
            for name in ("ξ", "line_load", "peak", "hertz", "half_width")
        )
        own = np.flatnonzero(np.isfinite(peak) & np.isfinite(b) & (hertz > 0.0))
        own = own[np.argsort(ξ[own])]
        ξ, load, peak, hertz, b = (values[own] for values in (ξ, load, peak, hertz, b))
        wide = 2.0 * load / (np.pi * hertz)
        single = 2.0 * wide * np.abs(run.pair.specific_sliding(ξ)[gear])
        return Contacts(
            ξ, radius_at(run.pair, gear, ξ), peak, hertz, b, wide, sliding(run.pair, gear, ξ, b), single
        )  # fmt: skip


def radius_at(pair: GearPair, gear: int, ξ: Floats) -> Floats:
    """Radius [mm] at which a gear's flank is touched at roll distances ξ."""
    base = pair.gears[gear].base_radius
    return np.sqrt(base**2 + 2.0 * base * line_arc(pair, gear, ξ))


def roll_distance_at(pair: GearPair, gear: int, radius: float | Floats) -> Floats:
    """ξ [mm] at which a gear's flank is touched at radii [mm]."""
    ρ = np.sqrt(np.square(radius) - pair.gears[gear].base_radius ** 2)
    return np.asarray((1.0 - 2.0 * gear) * (ρ - pair.pitch_point_roll_lengths[gear]))


def sliding(pair: GearPair, gear: int, ξ: Floats, half_width: Floats) -> Floats:
    """∫|v_s|dt [mm] of the points at roll distances ξ while a contact of half-width b [mm] goes over them; with the
    sliding velocity (1 + 1/u)|ξ| per radian of the pinion, which is not constant and at the pitch point not zero."""
    base, pitch = pair.gears[gear].base_radius, pair.pitch_point_roll_lengths[gear]
    arc = line_arc(pair, gear, ξ)
    ends = [np.sqrt(2.0 * base * np.maximum(arc + side * half_width, 0.0)) - pitch for side in (-1.0, 1.0)]
    swept = ends[1] * np.abs(ends[1]) - ends[0] * np.abs(ends[0])
    return np.asarray(swept * (1.0 + 1.0 / pair.ratio) / (2.0 * pair.pinion.base_radius))


def line_load(run: RunData, ξ: Floats) -> Floats:
    """F/L [N/mm] that the solution has at roll distances ξ; 0 beyond the engagement."""
    curve = engagement(run, 0)
    own = curve.angle * run.pair.pinion.base_radius
    return np.interp(ξ, own, curve.force / run.pair.face_width, left=0.0, right=0.0)


@dataclass(frozen=True)
class Depths:
    """What one mesh takes off a gear's flank at radii (k,) [mm]: own, as gathered from the solved pitch; line: the
    formula of the line contact for the solution's own load; peak_times_sliding: He et al. 2022, Eq. 24, with Hertz'
    stress and width [mm]."""

    radius: Floats
    own: Floats
    line: Floats
    peak_times_sliding: Floats

    @staticmethod
    def of(pair: WornPair, gear: int, coefficient: float) -> Depths:
        """Of a plane pair, between the tip-edge zones; coefficient: K/H [mm²/N]."""
        run, inner = pair.run, pair.inner(gear)
        radius = pair.worn[gear].diameters[inner] / 2.0
        ξ = roll_distance_at(run.pair, gear, radius)
        load, ζ = line_load(run, ξ), np.abs(run.pair.specific_sliding(ξ)[gear])
        R, modulus = run.pair.relative_curvature_radius(ξ), contact_modulus(*run.scene.materials())
        product = line_peak_pressure(load, R, modulus) * 2.0 * line_half_width(load, R, modulus) * ζ
        own = coefficient * gathered(pair)[gear][inner]
        return Depths(radius, own, coefficient * load * ζ, coefficient * product)


def gathered(pair: WornPair) -> tuple[Floats, Floats]:
    """Depths [mm at K/H = 1 mm²/N] that one mesh takes off pinion and wheel at their charts' diameters, plane pairs."""
    run = pair.run
    grids = chart_grid(pair, 0), chart_grid(pair, 1)
    points = [each[0].result.contact for each in run.positions]
    found = passage(run.pair, points, grids, run.pitch / len(points))
    pinion, wheel = (np.asarray(depths @ found.pressure) for depths in found.depths)
    return pinion, wheel


def chart_grid(pair: WornPair, gear: int) -> FlankGrid:
    """The nodes of a gear's chart."""
    own, chart = pair.run.pair.gears[gear], pair.worn[gear]
    return FlankGrid.regular(chart.arcs(own), chart.heights, own.base_helix_angle)


def pitch_point_depth(run: RunData, gear: int, coefficient: float) -> float:
    """Depth [mm] a mesh at the pitch point of a gear, where the line contact's formula has none: a Hertz ridge of the
    load there passes while the sliding goes through zero, (K/H)(1 + 1/u)(r_b²/r_b1 ρ²)·⅔ p0 b², K/H [mm²/N]."""
    pair, zero = run.pair, np.zeros(1)
    load, R = line_load(run, zero), pair.relative_curvature_radius(zero)
    modulus = contact_modulus(*run.scene.materials())
    p0, b = line_peak_pressure(load, R, modulus), line_half_width(load, R, modulus)
    lever = (pair.gears[gear].base_radius / pair.pitch_point_roll_lengths[gear]) ** 2 / pair.pinion.base_radius
    return float(coefficient * (1.0 + 1.0 / pair.ratio) * lever * 2.0 / 3.0 * p0[0] * b[0] ** 2)


@dataclass(frozen=True)
class PointPassage:
    """A point of the pinion's flank while the contact goes over it, entries (n,): own rotation [rad] of the tooth, 0 at
    the pitch point; bears: bool; pressure: averaged about the nodes, which keeps the force, while that of single
    quadrature points goes up and down beside the rim of the contact, wherever that lies in a cell; hertz: p for the
    own load [MPa]; sliding: distance so far [mm]."""

    radius: float
    rotation: Floats
    bears: np.ndarray
    pressure: Floats
    hertz: Floats
    sliding: Floats

    @staticmethod
    def of(run: RunData, radius: float, count: int = 1201) -> PointPassage:
        """At a radius [mm] of a plane pair's pinion: the ridges of the positions around are interpolated linearly in
        the rotation at equal distance from the contact line, as wear is gathered."""
        pair, base = run.pair, run.pair.pinion.base_radius
        ξ = roll_distance_at(pair, 0, radius)
        load, R, modulus = line_load(run, ξ), pair.relative_curvature_radius(ξ), contact_modulus(*run.scene.materials())
        b = float(line_half_width(load, R, modulus))
        lasts = b / (pair.pitch_point_roll_lengths[0] + float(ξ))  # half of it; the line moves by ρ over the flank
        rotation = float(ξ) / base + WIDER * lasts * np.linspace(-1.0, 1.0, count)
        s = line_arc(pair, 0, ξ) - line_arc(pair, 0, base * rotation)
        bears = _between(run, rotation, s, _ridge) > 0.0
        speed = (1.0 + 1.0 / pair.ratio) * base * np.abs(rotation) * bears
        hertz = line_peak_pressure(load, R, modulus) * np.sqrt(np.maximum(0.0, 1.0 - (s / b) ** 2))
        p = _between(run, rotation, s, _averaged)
        return PointPassage(radius, rotation, bears, p, hertz, cumulative_trapezoid(speed, rotation, initial=0.0))

    @property
    def lasts(self) -> float:
        """Rotation [rad] over which it bears."""
        return float(np.ptp(self.rotation[self.bears])) if self.bears.any() else 0.0


def _between(run: RunData, rotation: Floats, s: Floats, ridge: Ridge) -> Floats:
    """(n,) pressure [MPa] at distances s (n,) across the contact line when a tooth stands at `rotation` (n,)."""
    stands = sorted(
        (float(each[0].result.stand.angle + tooth * run.pitch), k, int(tooth))
        for k, each in enumerate(run.positions)
        for tooth in np.unique(each[0].result.contact.tooth)
    )
    angles = np.array([angle for angle, *_ in stands])
    table = np.array([ridge(run, run.positions[k][0].result, tooth, s) for _, k, tooth in stands])
    k = np.clip(np.searchsorted(angles, rotation) - 1, 0, len(angles) - 2)
    t = np.clip((rotation - angles[k]) / (angles[k + 1] - angles[k]), 0.0, 1.0)
    column = np.arange(len(rotation))
    return np.asarray((1.0 - t) * table[k, column] + t * table[k + 1, column])


def _averaged(run: RunData, result: PositionResult, tooth: int, s: Floats) -> Floats:
    """(n,) pressure [MPa] of a tooth at distances s (n,) from the contact line, from averages about the nodes."""
    return flank_field(run, result, tooth).at(s[:, None], np.zeros(1))[:, 0]


def _ridge(_: RunData, result: PositionResult, tooth: int, s: Floats) -> Floats:
    """The same from the quadrature points; each bears over its weight, so that the pressure ends half the outermost
    weights beyond the outermost points."""
    contact = result.contact
    own = np.flatnonzero(contact.tooth == tooth)
    own = own[np.argsort(contact.across[own])]
    x, p, half = contact.across[own], contact.pressure[own], contact.weights[own] / 2.0
    return np.interp(s, [x[0] - half[0], *x, x[-1] + half[-1]], [0.0, *p, 0.0], left=0.0, right=0.0)
