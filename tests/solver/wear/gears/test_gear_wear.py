"""Wear of a solved pitch: volumes, friction history, depths in the gap, reused searches, implicit blocks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.gears.sweep.periodic_pitch import TOLERANCE
from evolvent.gears.sweep.pitch_sweep import Pitch, uniform_pitch
from evolvent.wear.archard import Archard
from evolvent.wear.gears.gear_wear import GearWear
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of
from tests.support.gear_wear_cases import K, smooth_wear, solved_pitch, wear_scene, wearing_gears


@pytest.mark.parametrize("scene", ["spur", "helical"])
def test_worn_volume_of_both_gears(scene: str) -> None:
    """Problem: a pitch with friction. Exact: pinion and wheel lose (K/H)∫∫p|v_s| dA dt to rounding, the wheel's tooth
    1/u times as often; the integral is the friction loss of the solutions over μ within 2 %."""
    study, state = solved_pitch(8, 0.1, scene)
    depths = study.by_gear(state.rate)
    for gear, K_own, often in ((0, K, 1.0), (1, 2.0 * K, 1.0 / study.model.pair.ratio)):
        volume = study.model.bodies[gear].flank.weights() @ depths[gear]
        assert volume == pytest.approx(K_own * often * state.work, rel=1e-12)
    step = 2.0 * np.pi / study.model.pair.pinion.z / len(state.positions)
    loss = step * sum(p.friction_loss for p in state.positions)
    assert state.work == pytest.approx(abs(loss) / 0.1, rel=0.02)


def test_friction_history_does_not_depend_on_the_first_position() -> None:
    """Problem: a helical pitch with strong friction, begun at two of its positions. Exact: the same periodic pitch,
    with transmission errors within the tolerance of its periodicity; without repeating the pitch the first position is
    off by six times as much."""
    model, found = model_of(helical_scene("contact.friction=0.5")), []
    step = 2.0 * np.pi / model.pair.pinion.z / 6
    for begin in (0, 3):
        gears = GearWear(model, Pitch(tuple(step * (k - begin) for k in range(6))), 0.5, Archard(K, K))
        errors = [p.transmission_error for p in gears.evaluate(gears.begin).positions]
        found.append(np.roll(errors, -begin))
    assert np.abs(found[0] - found[1]).max() < TOLERANCE * np.ptp(found[1])


def test_uniform_wear_adds_to_the_transmission_error() -> None:
    """Problem: both flanks worn by 5 and 3 µm everywhere. Exact: worn flanks are parallel curves, involutes of the same
    base circles, so the transmission error grows by 8 µm, within 0.1 %."""
    study, fresh = solved_pitch(8)
    pinion, wheel = study.by_gear(study.begin)
    worn = study.evaluate(np.concatenate([np.full_like(pinion, 5e-3), np.full_like(wheel, 3e-3)]))
    for old, new in zip(fresh.positions, worn.positions):
        assert new.transmission_error - old.transmission_error == pytest.approx(8e-3, rel=1e-3)


def test_reused_searches_give_the_same_rates() -> None:
    """Problem: flanks worn by 1 µm together, from the searches on unworn flanks and from new ones. Exact: the same
    transmission error within 3e-4 of the wear and the same rates within 1 %; no position is searched in the first
    case."""
    study, fresh = solved_pitch(8)
    depth = np.full_like(study.begin, 0.5e-3)
    kept, anew = study.evaluate(depth, fresh), study.evaluate(depth)
    assert kept.searched == 0 and anew.searched == 8
    for one, other in zip(kept.positions, anew.positions):
        assert one.transmission_error == pytest.approx(other.transmission_error, abs=3e-7)
    assert study.areas @ np.abs(kept.rate - anew.rate) < 0.01 * study.areas @ anew.rate


def test_implicit_block_against_many_explicit_ones() -> None:
    """Problem: 60,000 meshes in one implicit block and in 24 explicit ones. Exact: they differ by the block's error
    within a factor of two, and no depth is negative."""
    study, fresh = solved_pitch(20)
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


def test_positions_that_are_no_pitch_are_refused() -> None:
    """Half a pitch, unequal steps and a single position are refused."""
    model, law = solved_pitch(8)[0].model, Archard(K)
    whole = uniform_pitch(model.pair.pinion.z, 8)
    for angles in (whole.angles[:4], (*whole.angles[:7], whole.angles[7] + 1e-3), whole.angles[:1]):
        with pytest.raises(ValueError, match="wanted at least two positions in equal steps over one pitch"):
            GearWear(model, Pitch(angles), 0.0, law)


def test_implicit_block_on_other_meshes_is_refused() -> None:
    """An evaluation from before a mesh update cannot start a block after it."""
    scene = wear_scene("spur")
    gears = wearing_gears(scene)
    now = gears.evaluate(gears.begin)
    gears.update_meshes(smooth_wear(gears, 1e-3))
    with pytest.raises(ValueError, match="found one on others"):
        gears.implicit_block(gears.begin, now, 1e3)


def test_wear_of_a_driving_wheel_is_the_mirror_image_of_that_of_a_driving_pinion() -> None:
    """Problem: He's pair, both gears alike and alike in K/H, relieved, at μ = 0.3. Exact: where the wheel drives and
    has the torque it wears as the pinion where that drives and has it, and the other way round, 1.5 % of the deepest;
    the contact is on the pinion's mesh. The driving gear wears 20 % deeper at its deepest place."""
    gears = model_of(wear_scene("spur"))
    rates = []
    for driving in Member:
        own = replace(gears, load=replace(gears.load, on=driving, driving=driving))
        study = GearWear(own, uniform_pitch(gears.pair.pinion.z, 6), 0.3, Archard(K, K))
        rates.append(study.by_gear(study.evaluate(study.begin).rate))
    for gear in Member:
        one, image = rates[Member.PINION][gear], rates[Member.WHEEL][gear.mate]
        assert image == pytest.approx(one, abs=0.015 * one.max())
    for driving in Member:
        assert rates[driving][driving].max() > 1.2 * rates[driving][driving.mate].max()
