"""A tooth's passage, from ridges of known pressure and from solved pitches, against the line-contact formula."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.wear.gears.flank_grid import FlankGrid
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
