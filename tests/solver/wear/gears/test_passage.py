"""A tooth's passage, from ridges of known pressure and from solved pitches, against the line-contact formula."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import trapezoid

from evolvent.contact.hertz import line_half_width, line_pressure
from evolvent.fem.material import contact_modulus
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent.wear.gears.passage import mesh_passage
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import spur_scene
from tests.support.gear_wear_cases import K, solved_pitch

LINE_LOAD, HALF_WIDTH = 60.0, 0.13  # N/mm, mm


def ridges(pair: GearPair, positions: int) -> list[ContactPoints]:
    """Hertz' pressure under LINE_LOAD on every tooth pair on the path of contact, at equally spaced positions."""
    start, end = pair.path_of_contact
    s = HALF_WIDTH * np.cos(np.pi * (np.arange(40) + 0.5) / 40)
    w = np.pi * HALF_WIDTH / 40 * np.sqrt(1.0 - (s / HALF_WIDTH) ** 2)
    λ = 2.0 * LINE_LOAD / (np.pi * HALF_WIDTH) * np.sqrt(1.0 - (s / HALF_WIDTH) ** 2)
    found = []
    for k in range(positions):
        φ = 2.0 * np.pi / pair.pinion.z * k / positions
        own = [i for i in range(-3, 4) if start <= float(pair.roll_distance(φ, i)) <= end]
        n, tooth = len(own), np.repeat(own, len(s))
        ξ = pair.roll_distance(φ, tooth)
        sliding = (1.0 + 1.0 / pair.ratio) * ξ
        zero, flags = np.zeros(n * len(s)), np.zeros(n * len(s), dtype=bool)
        traction = np.column_stack([np.tile(λ, n), zero])
        across = np.tile(s, n)
        weights, rate = np.tile(w, n), np.zeros((n * len(s), 2))
        found.append(ContactPoints(tooth, zero, ξ, across, -across, weights, traction, rate, sliding, flags, flags))
    return found


def grid(pair: GearPair, gear: Member) -> FlankGrid:
    """1000 nodes from the base circle to beyond the tip."""
    arcs = np.linspace(0.5, 12.0, 1000)
    areas = np.full(1000, arcs[1] - arcs[0])
    areas[[0, -1]] /= 2.0
    return FlankGrid(arcs, np.zeros(1), np.arange(1000)[None], areas)


def line_contact(pair: GearPair, gear: Member, u: Floats, load: float) -> tuple[Floats, Floats]:
    """ξ at arcs u of a gear, and h = (K/H)(F/L)|1 − v_2/v_1| per passage there, v the speeds of the contact."""
    ρ = np.sqrt(2.0 * pair.gears[gear].base_radius * u)
    ξ = (ρ - pair.pitch_point_roll_lengths[gear]) * (1.0 - 2.0 * gear)
    ρ_1, ρ_2 = pair.curvature_radii(ξ)
    speeds = ρ_1, ρ_2 / pair.ratio
    return ξ, K * load * np.abs(1.0 - speeds[gear.mate] / speeds[gear])


@pytest.mark.parametrize("gear", Member)
@pytest.mark.parametrize("positions", [10, 20, 80])
def test_passage_of_a_constant_ridge_is_the_line_contact_depth(gear: Member, positions: int) -> None:
    """Problem: Hertzian ridges of constant load, 40 points each. Exact: h = (K/H)(F/L)|1 − v_2/v_1| within 0.3 % of its
    maximum, between the ends of the path less one step and a half-width, except for a half-width about the pitch point,
    which is up to 4 times as much in ξ; there below 2 % of the maximum. Work: F' ∫|v_s| dφ."""
    pair = spur_scene().gear_pair()
    grids = grid(pair, Member.PINION), grid(pair, Member.WHEEL)
    found = mesh_passage(pair, ridges(pair, positions), grids, 2.0 * np.pi / pair.pinion.z / positions)
    u, h = grids[gear].arcs, K * (found.depths[gear] @ found.pressure)
    ξ, exact = line_contact(pair, gear, u, LINE_LOAD)
    start, end = pair.path_of_contact
    edge = 5.0 * HALF_WIDTH + pair.pinion.base_radius * 2.0 * np.pi / pair.pinion.z / positions
    inner = (ξ > start + edge) & (ξ < end - edge) & (np.abs(ξ) > 4.0 * HALF_WIDTH)
    assert np.abs(h - exact)[inner].max() < 3e-3 * exact[inner].max()
    assert h[np.argmin(np.abs(ξ))] < 0.02 * h.max()
    assert K * found.work == pytest.approx(float(grids[gear].areas @ h), rel=1e-12)
    whole = LINE_LOAD * (1.0 + 1.0 / pair.ratio) * (start**2 + end**2) / (2.0 * pair.pinion.base_radius)
    assert found.work == pytest.approx(whole, rel=1.5 / positions)


def passing_hertz(pair: GearPair, gear: Member, u: Floats, path: tuple[Floats, Floats], modulus: float) -> Floats:
    """Depth h (n,) [mm] per passage at arcs u (n,) of a gear: K/H ∫p|v_s| dt while Hertz' pressure passes, for the line
    loads [N/mm] at the roll distances of `path`."""
    ξ = np.linspace(path[0][0], path[0][-1], 20001)
    load, arc = np.interp(ξ, *path), line_arc(pair, gear, ξ)
    b = line_half_width(load, pair.relative_curvature_radius(ξ), modulus)
    sliding = (1.0 + 1.0 / pair.ratio) * np.abs(ξ) / pair.pinion.base_radius
    p0 = 2.0 * load / (np.pi * b)
    return np.array([K * trapezoid(p0 * line_pressure((a - arc) / b, 1.0, 1.0) * sliding, ξ) for a in u])


def over_hats(grid_: FlankGrid, depth: Callable[[Floats], Floats]) -> Floats:
    """Means (m,) of a depth over the hat functions of a grid's inner nodes, that of the node itself at both ends."""
    x, w = np.polynomial.legendre.leggauss(4)
    arcs = grid_.arcs
    half = 0.5 * np.diff(arcs)
    values = np.stack([depth(arcs[:-1] + half * (1.0 + each)) for each in x])
    rising, falling = (np.einsum("q,q...->...", w * (1.0 + sign * x) / 2.0, values) * half for sign in (1.0, -1.0))
    means = depth(arcs)
    means[1:-1] = (rising[:-1] + falling[1:]) / (half[:-1] + half[1:])
    return means


@pytest.mark.parametrize("spacing", [0.02, 0.05])
def test_depth_at_the_pitch_point_is_a_mean_over_a_hat(spacing: float) -> None:
    """Problem: Hertzian ridges of constant load on a grid with a node at the pitch point. Depths at nodes are means
    over their hat functions, as the volume wants. Exact: the depth of a passing Hertzian pressure, (K/H)(F/L) c 4b/3π
    there with c the slope of the specific sliding over the arc, has h'' = 3h/b², so that the mean is (Δ/b)²/4 higher:
    0.6 and 3.7 %, within a tenth of that and 0.2 % of curvature."""
    pair = spur_scene().gear_pair()
    pitch = float(line_arc(pair, Member.PINION, np.zeros(1))[0])
    arcs = pitch + spacing * np.arange(-40, 41)
    own = FlankGrid(arcs, np.zeros(1), np.arange(81)[None], np.full(81, spacing))
    found = mesh_passage(pair, ridges(pair, 80), (own, own), 2.0 * np.pi / pair.pinion.z / 80)
    ρ = pair.pitch_point_roll_lengths
    slope = (1.0 + 1.0 / pair.ratio) * (pair.pinion.base_radius / ρ[0]) ** 2 / pair.pinion.base_radius
    exact = K * LINE_LOAD * slope * 4.0 * HALF_WIDTH / (3.0 * np.pi)
    higher = K * (found.depths[0] @ found.pressure)[40] / exact - 1.0
    assert higher == pytest.approx((spacing / HALF_WIDTH) ** 2 / 4.0, rel=0.1, abs=2e-3)


def test_line_contact_depth_of_the_paper() -> None:
    """Problem: He's pair at r = 77 mm under half the load. Exact: 2.885 µm in a million mesh cycles."""
    pair = spur_scene().gear_pair()
    u = (77.0**2 - pair.pinion.base_radius**2) / (2.0 * pair.pinion.base_radius)
    half = 170e3 / pair.pinion.base_radius / 20.0 / 2.0
    assert 1e9 * line_contact(pair, Member.PINION, np.array([u]), half)[1][0] == pytest.approx(2.885, abs=5e-4)


def test_passage_of_a_solved_pitch_is_the_line_contact_depth() -> None:
    """Problem: He's pair without friction. Exact: the depth along the profile is (K/H)(F/L)|1 − v_2/v_1| for the
    solution's own load share within 1 % of its maximum, 1 mm from the ends of the path and half a millimetre from the
    pitch point, where a contact of finite width wears off up to 4 % of the maximum and the formula gives zero."""
    study, state = solved_pitch(40)
    pair, grid_ = study.model.pair, study.grids[0]
    h = study.by_gear(state.rate)[0][grid_.node[0]]
    path = np.concatenate([p.contact.roll_distance for p in state.positions])
    loads = np.concatenate([p.contact.weights * p.contact.pressure for p in state.positions])
    places, which = np.unique(np.round(path, 9), return_inverse=True)
    shares = np.bincount(which.reshape(-1), loads)
    ξ, unit = line_contact(pair, Member.PINION, grid_.arcs, 1.0)
    exact = unit * np.interp(ξ, places, shares)
    start, end = pair.path_of_contact
    inner, pitch_point = (ξ > start + 1.0) & (ξ < end - 1.0), np.abs(ξ) < 4.0 * HALF_WIDTH
    assert np.abs(h - exact)[inner & ~pitch_point].max() < 0.01 * exact[inner].max()
    assert np.abs(h - exact)[pitch_point].max() < 0.04 * exact[inner].max()
    at_77 = np.interp((77.0**2 - pair.pinion.base_radius**2) / (2.0 * pair.pinion.base_radius), grid_.arcs, h)
    assert 2.5 < 1e9 * at_77 < 2.885


def test_what_a_solved_pitch_adds_to_a_passing_hertzian_pressure() -> None:
    """Problem: He's pair at level standard, unworn. Depths in per cent over those of Hertz' pressure for the solution's
    loads passing at nominal speeds, both as means over hats. With nominal speeds they lie within 3.5 % about the pitch
    point, where the solved contact stands a fortieth of its half-width off the nominal line, and within 1.7 %
    elsewhere; the mean error about the pitch point is below 1 %. With the elastic part of the sliding they are 0.5 to
    4.5 % high there: creep slides where rigid flanks roll. Ripple from node to node is below 0.6 %."""
    study, state = solved_pitch(40)
    pair, grid_, positions = study.model.pair, study.grids[0], [each.contact for each in state.positions]
    path = np.concatenate([each.roll_distance for each in positions])
    places, which = np.unique(np.round(path, 9), return_inverse=True)
    forces = np.concatenate([each.weights * each.pressure for each in positions])
    loads: Floats = np.bincount(which.reshape(-1), forces).astype(np.float64)
    modulus = contact_modulus(*(body.material for body in study.model.bodies))
    wanted = over_hats(grid_, lambda u: passing_hertz(pair, Member.PINION, u, (places, loads), modulus))
    nominal = [replace(each, sliding=(1.0 + 1.0 / pair.ratio) * each.roll_distance) for each in positions]
    passage = mesh_passage(pair, nominal, study.grids, 2.0 * np.pi / pair.pinion.z / 40)
    rigid, elastic = K * (passage.depths[0] @ passage.pressure), study.by_gear(state.rate)[0]
    ξ, (start, end) = line_contact(pair, Member.PINION, grid_.arcs, 1.0)[0], pair.path_of_contact
    inner = (ξ > start + 1.0) & (ξ < end - 1.0)
    rigid, elastic = (100.0 * (each[grid_.node[0]] / wanted - 1.0)[inner] for each in (rigid, elastic))
    near = np.abs(ξ[inner]) < 1.0
    assert np.abs(rigid[near]).max() < 3.5 and np.abs(rigid[~near]).max() < 1.7 and abs(rigid[near].mean()) < 1.0
    assert elastic[near].min() > 0.5 and elastic[near].max() < 4.5 and np.abs(elastic[~near]).max() < 1.7
    assert 0.25 * np.abs(np.diff(elastic, 2)).max() < 0.6
