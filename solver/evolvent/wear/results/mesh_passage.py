"""Contact stress, sliding and wear of the flank points in one mesh passage of a plane pair, computed and by formulas.

A point is in contact while the contact, 2b wide, passes over it. The single-point observation takes load and specific
sliding ζ as constant meanwhile (He et al. 2022, Eqs 21, 22): the point slides 2b|ζ|, and a line load F/L wears off

    h = (K/H)(F/L)|ζ|

whatever the width; the product of the largest stress and the sliding distance (Eq. 24) is 4/π times that.

Source: Z. He, Y. Hu, X. Zheng, Y. Yu, Machines 10 (2022) 69.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid

from evolvent.contact.hertz import line_half_width, line_peak_pressure
from evolvent.fem.material import contact_modulus
from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.engagement import engagement
from evolvent.results.fields.flank_field import flank_field
from evolvent.results.run_data import RunData
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent.wear.gears.passage import mesh_passage
from evolvent.wear.results.report import WornPair
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

Ridge = Callable[[RunData, PositionResult, int, Floats], Floats]
"""Pressure (n,) [MPa] of a tooth pair at a position, at distances (n,) [mm] from the contact line."""
OBSERVATION = 1.6  # rotation over which a point is observed, over that of the passage of Hertz' width


@dataclass(frozen=True)
class ContactProfile:
    """The contacts of a pitch along a gear's flank, away from the tip edges, ascending with the roll distance.

    roll_distance: (n,) [mm].
    radius: (n,) on the gear [mm].
    peak: (n,) fitted peak pressure [MPa].
    hertz: (n,) Hertz' peak pressure for the solution's own line load [MPa].
    half_width: (n,) fitted [mm].
    hertz_half_width: (n,) Hertz' for the same load [mm].
    sliding: (n,) sliding distance of the point at the middle of the contact, with the fitted width [mm].
    single_point: (n,) the same by the single-point observation, 2b|ζ| with Hertz' b [mm].
    """

    roll_distance: Floats
    radius: Floats
    peak: Floats
    hertz: Floats
    half_width: Floats
    hertz_half_width: Floats
    sliding: Floats
    single_point: Floats

    @staticmethod
    def of(run: RunData, gear: Member) -> ContactProfile:
        """Contact profile of a plane pair's pitch at its first friction coefficient."""
        cut = Slices.joined([each[0].cut for each in run.positions])
        ξ, load, peak, hertz, b = cut.roll_distance, cut.line_load, cut.peak, cut.hertz, cut.half_width
        fitted = np.flatnonzero(np.isfinite(peak) & np.isfinite(b) & (hertz > 0.0))
        fitted = fitted[np.argsort(ξ[fitted])]
        ξ, load, peak, hertz, b = (values[fitted] for values in (ξ, load, peak, hertz, b))
        hertz_b = 2.0 * load / (np.pi * hertz)
        single_point = 2.0 * hertz_b * np.abs(run.pair.specific_sliding(ξ)[gear])
        slid = sliding_distance(run.pair, gear, ξ, b)
        return ContactProfile(ξ, radius_at(run.pair, gear, ξ), peak, hertz, b, hertz_b, slid, single_point)


def radius_at(pair: GearPair, gear: Member, ξ: Floats) -> Floats:
    """Radii (n,) [mm] of the contact on a gear's flank at roll distances ξ (n,) [mm]."""
    base = pair.gears[gear].base_radius
    return np.sqrt(base**2 + 2.0 * base * line_arc(pair, gear, ξ))


def roll_distance_at(pair: GearPair, gear: Member, radius: float | Floats) -> Floats:
    """Roll distances ξ [mm] of the contact at radii [mm] of a gear's flank."""
    ρ = np.sqrt(np.square(radius) - pair.gears[gear].base_radius ** 2)
    return np.asarray(gear.sign * (ρ - pair.pitch_point_roll_lengths[gear]))


def sliding_distance(pair: GearPair, gear: Member, ξ: Floats, half_width: Floats) -> Floats:
    """Sliding distance ∫|v_s|dt [mm] of the points at roll distances ξ (n,) [mm] while a contact of this half-width
    (n,) [mm] passes over them, |v_s| = (1 + 1/u)|ξ| per radian of the pinion; at the pitch point it is not zero."""
    base, pitch = pair.gears[gear].base_radius, pair.pitch_point_roll_lengths[gear]
    arc = line_arc(pair, gear, ξ)
    ends = [np.sqrt(2.0 * base * np.maximum(arc + side * half_width, 0.0)) - pitch for side in (-1.0, 1.0)]
    swept = ends[1] * np.abs(ends[1]) - ends[0] * np.abs(ends[0])
    return np.asarray(swept * (1.0 + 1.0 / pair.ratio) / (2.0 * pair.pinion.base_radius))


def line_load(run: RunData, ξ: Floats) -> Floats:
    """Line load F/L [N/mm] of the solution at roll distances ξ (n,) [mm]; 0 beyond the engagement."""
    curve = engagement(run, 0)
    solved = curve.angle * run.pair.pinion.base_radius
    return np.interp(ξ, solved, curve.force / run.pair.face_width, left=0.0, right=0.0)


@dataclass(frozen=True)
class DepthProfile:
    """Depth that one mesh passage wears off a gear's flank, over the radius.

    radius: (k,) [mm].
    computed: (k,) from the solved pitch [mm].
    line: (k,) by the formula of the line contact for the solution's own load [mm].
    peak_times_sliding: (k,) by He et al. 2022, Eq. 24, with Hertz' stress and width [mm].
    """

    radius: Floats
    computed: Floats
    line: Floats
    peak_times_sliding: Floats

    @staticmethod
    def of(pair: WornPair, gear: Member, coefficient: float) -> DepthProfile:
        """Depth profiles of a plane pair, between the edge margins. coefficient: K/H [mm²/N]."""
        run, inner = pair.run, pair.inner(gear)
        radius = pair.worn[gear].diameters[inner] / 2.0
        ξ = roll_distance_at(run.pair, gear, radius)
        load, ζ = line_load(run, ξ), np.abs(run.pair.specific_sliding(ξ)[gear])
        R, modulus = run.pair.relative_curvature_radius(ξ), contact_modulus(*run.scene.materials())
        product = line_peak_pressure(load, R, modulus) * 2.0 * line_half_width(load, R, modulus) * ζ
        computed = coefficient * passage_depths(pair)[gear][inner]
        return DepthProfile(radius, computed, coefficient * load * ζ, coefficient * product)


def passage_depths(pair: WornPair) -> tuple[Floats, Floats]:
    """Depths (k,) [mm at K/H = 1 mm²/N] that one mesh passage of a plane pair wears off pinion and wheel, at their
    charts' diameters."""
    run = pair.run
    grids = chart_grid(pair, Member.PINION), chart_grid(pair, Member.WHEEL)
    points = [each[0].result.contact for each in run.positions]
    passage = mesh_passage(run.pair, points, grids, run.pitch / len(points))
    pinion, wheel = (np.asarray(depths @ passage.pressure) for depths in passage.depths)
    return pinion, wheel


def chart_grid(pair: WornPair, gear: Member) -> FlankGrid:
    """The grid of a gear's chart."""
    geometry, chart = pair.run.pair.gears[gear], pair.worn[gear]
    return FlankGrid.regular(chart.arcs(geometry), chart.heights, geometry.base_helix_angle)


def pitch_point_depth(run: RunData, gear: Member, coefficient: float) -> float:
    """Depth [mm] per mesh passage at the pitch point of a gear, where the formula of the line contact gives zero.

    The Hertzian pressure of the load there passes while the sliding changes its sign, which leaves
    (K/H)(1 + 1/u)(r_b²/r_b1 ρ²)·⅔ p0 b². coefficient: K/H [mm²/N].
    """
    pair, zero = run.pair, np.zeros(1)
    load, R = line_load(run, zero), pair.relative_curvature_radius(zero)
    modulus = contact_modulus(*run.scene.materials())
    p0, b = line_peak_pressure(load, R, modulus), line_half_width(load, R, modulus)
    lever = (pair.gears[gear].base_radius / pair.pitch_point_roll_lengths[gear]) ** 2 / pair.pinion.base_radius
    return float(coefficient * (1.0 + 1.0 / pair.ratio) * lever * 2.0 / 3.0 * p0[0] * b[0] ** 2)


@dataclass(frozen=True)
class PointPassage:
    """A point of the pinion's flank while the contact passes over it.

    radius: of the point [mm].
    rotation: (n,) of the tooth, 0 at the pitch point [rad].
    bears: (n,) whether the point is in contact.
    pressure: (n,) averaged about the nodes [MPa]; averages keep the force, while the pressure at single quadrature
        points near the edge of the contact oscillates with the position of that edge in a cell.
    hertz: (n,) Hertz' pressure for the solution's own load [MPa].
    sliding: (n,) sliding distance so far [mm].
    """

    radius: float
    rotation: Floats
    bears: Bools
    pressure: Floats
    hertz: Floats
    sliding: Floats

    @staticmethod
    def of(run: RunData, radius: float, count: int = 1201) -> PointPassage:
        """Passage of the contact over a point at a radius [mm] of a plane pair's pinion, at `count` rotations. The
        pressures of neighbouring positions are interpolated linearly in the rotation at the same distance from the
        contact line, as for wear."""
        pair, base = run.pair, run.pair.pinion.base_radius
        ξ = roll_distance_at(pair, Member.PINION, radius)
        load, R, modulus = line_load(run, ξ), pair.relative_curvature_radius(ξ), contact_modulus(*run.scene.materials())
        b = float(line_half_width(load, R, modulus))
        half = b / (pair.pitch_point_roll_lengths[0] + float(ξ))  # of the rotation: the line moves by ρ a radian
        rotation = float(ξ) / base + OBSERVATION * half * np.linspace(-1.0, 1.0, count)
        s = line_arc(pair, Member.PINION, ξ) - line_arc(pair, Member.PINION, base * rotation)
        bears = _interpolated(run, rotation, s, _quadrature_pressure) > 0.0
        speed = (1.0 + 1.0 / pair.ratio) * base * np.abs(rotation) * bears
        hertz = line_peak_pressure(load, R, modulus) * np.sqrt(np.maximum(0.0, 1.0 - (s / b) ** 2))
        p = _interpolated(run, rotation, s, _nodal_average)
        return PointPassage(radius, rotation, bears, p, hertz, cumulative_trapezoid(speed, rotation, initial=0.0))

    @property
    def lasts(self) -> float:
        """Rotation [rad] over which the point is in contact."""
        return float(np.ptp(self.rotation[self.bears])) if self.bears.any() else 0.0


def _interpolated(run: RunData, rotation: Floats, s: Floats, ridge: Ridge) -> Floats:
    """Pressures (n,) [MPa] at distances s (n,) across the contact line for tooth rotations (n,) [rad], interpolated
    between the solved positions."""
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


def _nodal_average(run: RunData, result: PositionResult, tooth: int, s: Floats) -> Floats:
    """Pressures (n,) [MPa] of a tooth at distances s (n,) from the contact line, from averages about the nodes."""
    return flank_field(run, result, tooth).at(s[:, None], np.zeros(1))[:, 0]


def _quadrature_pressure(_: RunData, result: PositionResult, tooth: int, s: Floats) -> Floats:
    """Pressures (n,) [MPa] of a tooth at distances s (n,) from the contact line, from the quadrature points, each on a
    strip as wide as its weight: the pressure ends half a weight beyond the outermost points."""
    contact = result.contact
    points = np.flatnonzero(contact.tooth == tooth)
    points = points[np.argsort(contact.across[points])]
    x, p, half = contact.across[points], contact.pressure[points], contact.weights[points] / 2.0
    return np.interp(s, [x[0] - half[0], *x, x[-1] + half[-1]], [0.0, *p, 0.0], left=0.0, right=0.0)
