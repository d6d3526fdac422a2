"""A tooth's passage, from ridges of known pressure and from solved pitches, against the line-contact formula."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.sweep.periodic_pitch import FORGOTTEN
from evolvent.gears.sweep.pitch_sweep import Pitch, uniform_pitch
from evolvent.wear.archard import Archard
from evolvent.wear.gears.flank_grid import FlankGrid
from evolvent.wear.gears.gear_wear import GearWear, PitchState
from evolvent.wear.gears.passage import mesh_passage
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import helical_scene, model_of, spur_scene

K = 1.3832e-10  # mm²/N, He 2022
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


def line_contact(pair: GearPair, gear: Member, u: np.ndarray, load: float) -> tuple[np.ndarray, np.ndarray]:
    """ξ at arcs u of a gear, and h = (K/H)(F/L)|1 − v_2/v_1| per passage there, v the speeds of the contact."""
    ρ = np.sqrt(2.0 * pair.gears[gear].base_radius * u)
    ξ = (ρ - pair.pitch_point_roll_lengths[gear]) * (1.0 - 2.0 * gear)
    ρ_1, ρ_2 = pair.curvature_radii(ξ)
    speeds = ρ_1, ρ_2 / pair.ratio
    return ξ, K * load * np.abs(1.0 - speeds[gear.mate] / speeds[gear])


@pytest.mark.parametrize("gear", Member)
@pytest.mark.parametrize("positions", [10, 20, 80])
def test_ridge_of_constant_load(gear: Member, positions: int) -> None:
    """h = (K/H)(F/L)|1 − v_2/v_1| within 0.3 % of the largest one (a ridge has 40 points here), between the ends of the
    path less one step and a half-width, but for a half-width about the pitch point, which is up to 4 times as much in
    ξ; there below 2 % of the largest. Work: F' ∫|v_s| dφ."""
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


def test_number_of_the_paper() -> None:
    """He's pair at r = 77 mm under half the load: 2.885 µm in a million meshes, as the exact formula says."""
    pair = spur_scene().gear_pair()
    u = (77.0**2 - pair.pinion.base_radius**2) / (2.0 * pair.pinion.base_radius)
    half = 170e3 / pair.pinion.base_radius / 20.0 / 2.0
    assert 1e9 * line_contact(pair, Member.PINION, np.array([u]), half)[1][0] == pytest.approx(2.885, abs=5e-4)


@cache
def solved(positions: int, friction: float = 0.0, scene: str = "spur") -> tuple[GearWear, PitchState]:
    """A pitch of unworn flanks."""
    make = spur_scene if scene == "spur" else helical_scene
    model = model_of(make(f"contact.friction={friction}"))
    pitch = uniform_pitch(model.pair.pinion.z, positions)
    study = GearWear(model, pitch, friction, Archard(K, 2.0 * K))
    return study, study.evaluate(study.begin)


def test_solved_pitch_against_line_contact() -> None:
    """He's pair, frictionless: the depth along the profile is (K/H)(F/L)|1 − v_2/v_1| for the solution's own load share
    within 1 % of the largest one, 1 mm from the ends of the path and half a millimetre from the pitch point, where a
    contact of some width wears off up to 4 % of the largest while the formula has nothing."""
    study, state = solved(40)
    pair, grid_ = study.model.pair, study.grids[0]
    h = study.by_gear(state.rate)[0][grid_.node[0]]
    path = np.concatenate([p.contact.ξ for p in state.positions])
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


@pytest.mark.parametrize("scene", ["spur", "helical"])
def test_volume_of_both_gears(scene: str) -> None:
    """Pinion and wheel lose K/H ∫∫p|v_s| dA dt to rounding, the wheel's tooth 1/u times as often; with friction it is
    the solutions' friction loss over μ within 1 %."""
    study, state = solved(8, 0.1, scene)
    depths = study.by_gear(state.rate)
    for gear, K_own, often in ((0, K, 1.0), (1, 2.0 * K, 1.0 / study.model.pair.ratio)):
        volume = study.model.bodies[gear].flank.weights() @ depths[gear]
        assert volume == pytest.approx(K_own * often * state.work, rel=1e-12)
    step = 2.0 * np.pi / study.model.pair.pinion.z / len(state.positions)
    loss = step * sum(p.friction_loss for p in state.positions)
    assert state.work == pytest.approx(abs(loss) / 0.1, rel=0.02)


def test_where_a_pitch_begins_is_forgotten() -> None:
    """Problem: a helical pitch with strong friction, begun at two of its positions. Exact: the same pitch, transmission
    errors within what may be left of either beginning; without going on from its own end the first position is off by
    six times as much."""
    model, found = model_of(helical_scene("contact.friction=0.5")), []
    step = 2.0 * np.pi / model.pair.pinion.z / 6
    for begin in (0, 3):
        gears = GearWear(model, Pitch(tuple(step * (k - begin) for k in range(6))), 0.5, Archard(K, K))
        errors = [p.transmission_error for p in gears.evaluate(gears.begin).positions]
        found.append(np.roll(errors, -begin))
    assert np.abs(found[0] - found[1]).max() < FORGOTTEN * np.ptp(found[1])


def test_worn_flanks_open_the_gap() -> None:
    """Both flanks worn by 5 and 3 µm everywhere: the transmission error grows by 8 µm within 0.1 %, as the flanks are
    parallel curves of what they were, which are involutes of the same base circle."""
    study, fresh = solved(8)
    pinion, wheel = study.by_gear(study.begin)
    worn = study.evaluate(np.concatenate([np.full_like(pinion, 5e-3), np.full_like(wheel, 3e-3)]))
    for old, new in zip(fresh.positions, worn.positions):
        assert new.transmission_error - old.transmission_error == pytest.approx(8e-3, rel=1e-3)


def test_kept_positions_are_as_good_as_searched_ones() -> None:
    """Flanks worn by 1 µm together, from the positions kept of unworn ones and searched anew: the same transmission
    error within 3e-4 of the wear and the same rates within 1 %, and nothing was searched in between."""
    study, fresh = solved(8)
    depth = np.full_like(study.begin, 0.5e-3)
    kept, anew = study.evaluate(depth, fresh), study.evaluate(depth)
    assert kept.searched == 0 and anew.searched == 8
    for one, other in zip(kept.positions, anew.positions):
        assert one.transmission_error == pytest.approx(other.transmission_error, abs=3e-7)
    assert study.areas @ np.abs(kept.rate - anew.rate) < 0.01 * study.areas @ anew.rate


def test_implicit_block_against_many_explicit_ones() -> None:
    """60,000 meshes in one implicit block, and in 24 explicit ones: their difference is what the block's error says,
    within a factor of two, no depth is negative, and the volume is that of the linearised pressures."""
    study, fresh = solved(20)
    length = 6e4
    gained, end = study.implicit_block(study.begin, fresh, length)
    depth, now = study.begin, fresh
    for _ in range(24):
        half = study.evaluate(depth + length / 48.0 * now.rate, now)
        depth, now = depth + length / 24.0 * half.rate, half
    assert gained.min() >= -1e-6 * gained.max()
    volume = study.areas @ depth
    error = study.areas @ np.abs(gained - 0.5 * length * (fresh.rate + end.rate)) / volume
    assert study.areas @ np.abs(gained - depth) / volume < 2.0 * error + 0.01


def test_positions_have_to_be_a_pitch() -> None:
    """Half a pitch, and unequal steps, are refused."""
    model, law = solved(8)[0].model, Archard(K)
    whole = uniform_pitch(model.pair.pinion.z, 8)
    for angles in (whole.angles[:4], (*whole.angles[:7], whole.angles[7] + 1e-3), whole.angles[:1]):
        with pytest.raises(ValueError, match="wanted at least two positions in equal steps over one pitch"):
            GearWear(model, Pitch(angles), 0.0, law)
