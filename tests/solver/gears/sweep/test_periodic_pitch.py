"""A pitch with friction is the same wherever its sweep began, and positions are solved again only until it is."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from mpi4py import MPI

from evidence.robustness.campaigns.random_scenes import random_scene
from evidence.robustness.campaigns.scene_outcomes import some_positions
from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.gear_model import GearModel
from evolvent.gears.ring.ring_compliance import ChainedCompliance
from evolvent.gears.sweep import friction_history, periodic_pitch
from evolvent.gears.sweep.friction_history import PreviousJump, previous_jumps
from evolvent.gears.sweep.periodic_pitch import (
    TOLERANCE,
    is_periodic,
    one_pitch,
    sweep_until_periodic,
    transmission_errors,
)
from evolvent.gears.sweep.pitch_sweep import SweptPosition, initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_search import shared_position
from evolvent_meshes.arrays import Floats
from tests.support.gear_cases import helical_scene, model_of

POSITIONS = 6
STRONG = 0.5


@pytest.fixture(scope="module")
def helical() -> GearModel:
    """Its first position differs by 0.04 of the peak-to-peak transmission error from that a pitch later, the next by
    0.01, the third by 0.001."""
    return model_of(helical_scene())


@pytest.fixture(scope="module")
def cold(helical: GearModel) -> list[SweptPosition]:
    """A sweep that begins at the pitch's own first position, without a friction history."""
    return solved(helical, STRONG)


@pytest.fixture(scope="module")
def later(helical: GearModel) -> list[SweptPosition]:
    """The second of two pitches of one sweep, a whole pitch away from where that begins."""
    pitch = uniform_pitch(helical.pair.pinion.z, POSITIONS, 2)
    return list(sweep_pitch(helical, pitch, [STRONG], initial_state([STRONG])))[POSITIONS:]


def solved(model: GearModel, friction: float) -> list[SweptPosition]:
    """In the order in which they were solved."""
    pitch = uniform_pitch(model.pair.pinion.z, POSITIONS)
    return list(sweep_until_periodic(model, pitch, [friction], initial_state([friction]), MPI.COMM_SELF))


def errors(swept: list[SweptPosition]) -> Floats:
    """Their transmission errors [mm]."""
    return np.array([position.results[0].transmission_error for position in swept])


def test_periodic_pitch_does_not_depend_on_where_its_sweep_began(
    cold: list[SweptPosition], later: list[SweptPosition]
) -> None:
    """Problem: a pitch with friction begun at its own first position, without a history, or a pitch before. Exact: the
    same, as all positions have a history. Within the tolerance; as first solved, its first is three times further off.
    """
    allowed = TOLERANCE * np.ptp(errors(later))
    assert np.abs(errors(one_pitch(cold)) - errors(later)).max() < allowed
    assert np.abs(errors(cold[:POSITIONS]) - errors(later)).max() > 3.0 * allowed


def test_positions_solved_again_are_those_of_the_next_pitch(
    cold: list[SweptPosition], later: list[SweptPosition]
) -> None:
    """Problem: positions solved again, against those of one sweep over two pitches. Exact: the same, all teeth being
    alike."""
    again = [position for position in cold if position.again]
    later = later[: len(again)]
    assert errors(again) == pytest.approx(errors(later), rel=1e-8)
    assert [p.results[0].torques[1] for p in again] == pytest.approx([p.results[0].torques[1] for p in later], rel=1e-7)


def test_order_of_positions_solved_again(cold: list[SweptPosition]) -> None:
    """The pitch, some of it again, the last of which closes it; `one_pitch` has each once, in order."""
    again = len(cold) - POSITIONS
    assert [position.again for position in cold] == [False] * POSITIONS + [True] * again
    assert [position.closes for position in cold] == [False] * (len(cold) - 1) + [True]
    pitch = one_pitch(cold)
    assert len(pitch) == POSITIONS and all(a.angle < b.angle for a, b in pairwise(pitch))
    renewed = [position.results[0] for position in pitch[:again]]
    assert all(a is b.results[0] for a, b in zip(renewed, cold[POSITIONS:], strict=True))


def test_positions_solved_again_start_from_their_last_solution(cold: list[SweptPosition]) -> None:
    """Only the friction history has changed: all of them together take fewer iterations than the first time, as the
    state without friction is there already, and none takes more but the first one, which had the history of flanks
    that slide everywhere, as they nearly do."""
    counts = [position.results[0].iterations for position in cold]
    first, again = counts[: len(counts) - POSITIONS], counts[POSITIONS:]
    assert sum(again) < sum(first)
    assert all(after <= before for before, after in zip(first[1:], again[1:], strict=True))


def test_nothing_is_solved_again_without_friction(helical: GearModel) -> None:
    """There is no history that it depends on."""
    assert [position.closes for position in solved(helical, 0.0)] == [False] * (POSITIONS - 1) + [True]


@pytest.mark.parametrize("done", [3, POSITIONS, POSITIONS + 1])
def test_a_resumed_pitch_is_the_same(done: int, helical: GearModel, cold: list[SweptPosition]) -> None:
    """Stopped after some positions, of the pitch or of those solved again: the rest is as if never stopped."""
    pitch = uniform_pitch(helical.pair.pinion.z, POSITIONS)
    state = replace(cold[done - 1].state, patch=None)
    before = [transmission_errors(position, [STRONG]) for position in cold[:done]]
    rest = list(sweep_until_periodic(helical, pitch, [STRONG], state, MPI.COMM_SELF, before))
    assert [position.angle for position in rest] == [position.angle for position in cold[done:]]
    assert errors(rest) == pytest.approx(errors(cold[done:]), rel=1e-8)
    assert rest[-1].closes


def test_a_pitch_that_is_never_periodic_is_an_error(helical: GearModel, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a tolerance below rounding no pitch closes: NotConverged, with the error that is left."""
    monkeypatch.setattr(periodic_pitch, "TOLERANCE", 1e-20)
    monkeypatch.setattr(periodic_pitch, "ROUNDING", 1e-20)
    monkeypatch.setattr(periodic_pitch, "ROUNDS", 1)
    with pytest.raises(NotConverged, match="friction after 1 more pitches: wanted transmission errors that are"):
        solved(helical, STRONG)


def test_several_pitches_are_each_the_one_pitch(helical: GearModel, cold: list[SweptPosition]) -> None:
    """Problem: two pitches swept in place of one. Exact: each is the one pitch; the first is solved again until it is,
    not only until the second has come out alike."""
    pitch = uniform_pitch(helical.pair.pinion.z, POSITIONS, 2)
    swept = list(sweep_until_periodic(helical, pitch, [STRONG], initial_state([STRONG]), MPI.COMM_SELF))
    two, one = errors(one_pitch(swept)), errors(one_pitch(cold))
    assert np.abs(two.reshape(2, POSITIONS) - one).max() < TOLERANCE * np.ptp(one)


STRONGER = 0.8
MIXED = [0.0, 0.05, STRONGER]


@pytest.fixture(scope="module")
def mixed(helical: GearModel) -> list[SweptPosition]:
    """Without friction, with weak friction, and with strong friction, for which most positions are solved again."""
    pitch = uniform_pitch(helical.pair.pinion.z, POSITIONS)
    return list(sweep_until_periodic(helical, pitch, MIXED, initial_state(MIXED), MPI.COMM_SELF))


def test_only_coefficients_not_yet_periodic_are_solved_again(mixed: list[SweptPosition]) -> None:
    """Positions again: without friction none, each other coefficient until it has closed the pitch."""
    again = [[result.friction for result in position.results] for position in mixed[POSITIONS:]]
    weak = sum(0.05 in frictions for frictions in again)
    assert again == [[0.05, STRONGER]] * weak + [[STRONGER]] * (len(again) - weak)
    assert 0 < weak < len(again)
    assert all(len(position.results) == len(position.state.histories) for position in mixed)
    assert [[result.friction for result in position.results] for position in one_pitch(mixed)] == [MIXED] * POSITIONS


@pytest.mark.parametrize(("friction", "i"), [(0.05, 1), (STRONGER, 2)])
def test_coefficients_are_independent_of_each_other(
    friction: float, i: int, helical: GearModel, mixed: list[SweptPosition]
) -> None:
    """Problem: a friction coefficient alone, and beside others. Exact: the same results."""
    alone = errors(one_pitch(solved(helical, friction)))
    beside = [position.results[i].transmission_error for position in one_pitch(mixed)]
    assert beside == pytest.approx(alone, rel=1e-8)


def test_a_pitch_resumed_with_some_coefficients_is_the_same(helical: GearModel, mixed: list[SweptPosition]) -> None:
    """Stopped after any of the positions that are solved again: the rest is as if it had not been stopped."""
    pitch = uniform_pitch(helical.pair.pinion.z, POSITIONS)
    for done in range(POSITIONS, len(mixed)):
        before = [transmission_errors(position, MIXED) for position in mixed[:done]]
        state = replace(mixed[done - 1].state, patch=None)
        rest = list(sweep_until_periodic(helical, pitch, MIXED, state, MPI.COMM_SELF, before))
        found = [transmission_errors(position, MIXED) for position in rest]
        wanted = [transmission_errors(position, MIXED) for position in mixed[done:]]
        assert np.array(found) == pytest.approx(np.array(wanted), rel=1e-8, nan_ok=True)


@pytest.mark.parametrize(("begin", "ratio"), [(1.0, 0.7), (0.08, 0.9), (0.5, 0.2)])
def test_error_estimate_of_a_geometric_decay(begin: float, ratio: float) -> None:
    """Problem: transmission errors whose deviation falls by a constant ratio each pitch. Exact: a position's error a
    pitch before, its change over 1 − that ratio, has to be small enough, not the change; the fall from one position to
    the next gives the ratio before there are two changes."""
    pitch, shape = uniform_pitch(20, 4), np.array([5.0, 6.0, 7.0, 6.0])
    off = [begin * ratio ** (k / 4.0) for k in range(200)]
    swept = [np.array([shape[k % 4] + off[k]]) for k in range(200)]
    first = next(k for k in range(6, 200) if is_periodic(swept[:k], pitch))
    small = TOLERANCE * np.ptp(shape)
    assert off[first - 5] < 1.1 * small  # the last one's, a pitch before
    assert first == 6 or off[first - 6] > 0.9 * small


def test_history_a_pitch_earlier_has_no_teeth_without_load() -> None:
    """Problem: a spur pair at whose pitch's end a tooth faces another, without load, that would be one too many at its
    beginning. Exact: the history a pitch earlier has only teeth that the gears' compliances have, and the pitch
    closes."""
    scene = random_scene(403)
    model, pitch = model_of(scene), some_positions(scene, 403)
    frictions = scene.contact.friction
    swept = list(sweep_until_periodic(model, pitch, frictions, initial_state(frictions), MPI.COMM_SELF))
    assert swept[-1].closes
    history = swept[len(pitch.angles) - 1].state.histories[0]
    chain = model.bodies[0].chain
    assert history is not None and isinstance(chain, ChainedCompliance)
    assert history.rows[0][:, 0].max() + 1 not in chain.teeth
    assert set(history.earlier(1).rows[0][:, 0]) <= set(chain.teeth)


def earlier_jumps(model: GearModel) -> tuple[Floats, Floats]:
    """(n, d) jumps that a history gives at one position, and the same a pitch earlier, where its teeth have other
    numbers."""
    pitch = uniform_pitch(model.pair.pinion.z, POSITIONS, 2)
    swept = [position for position, _ in zip(sweep_pitch(model, pitch, [0.3], initial_state([0.3])), range(7))]
    history = swept[-1].state.histories[0]
    assert history is not None
    step, turn = 2.0 * np.pi / model.pair.pinion.z / POSITIONS, 2.0 * np.pi / model.pair.pinion.z
    angle = history.stand.angle + step
    jumps: list[PreviousJump] = []
    for at, known in ((angle, history), (angle - turn, history.earlier(1))):
        contact = shared_position(model, at, history.stand.beyond_nominal, [0.3], None).contact
        jumps += previous_jumps(contact.geometry, [known])
    return jumps[0].jump, jumps[1].jump


def test_history_a_pitch_earlier_gives_the_same_jumps(helical: GearModel, monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: a friction history interpolated to a position and, moved by a pitch, to the position a pitch earlier.
    Exact: the same jumps. Where the forces do not turn with their teeth it is seen to fail."""
    later, sooner = earlier_jumps(helical)
    size = np.abs(later).max()
    assert size > 1e-4
    assert np.abs(later - sooner).max() < 1e-6 * size
    monkeypatch.setattr(friction_history, "turn", lambda angle, d: np.eye(d))
    later, sooner = earlier_jumps(helical)
    assert np.abs(later - sooner).max() > 1e-2 * size
