"""A gear pair in time steps that are divided where its motion needs it: He's spur pair in plane strain."""

from __future__ import annotations

from dataclasses import astuple, replace
from functools import cache

import numpy as np
import pytest

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.dynamics.transient.certificates import Unbalanced
from evolvent.dynamics.transient.divided_steps import DividedSteps
from evolvent.dynamics.transient.kept_contacts import ContactStore, KeptContacts
from evolvent.dynamics.transient.pair_state import SolvedStep
from evolvent.dynamics.transient.pair_transient import MovingMoment, PairTransient
from evolvent.dynamics.transient.steady_state import until_steady
from evolvent.dynamics.transient.step_balance import StepBalance, StepEnd
from evolvent_meshes.arrays import Floats
from tests.support.running.transient_pairs import POSITIONS, moments, moving, started

FINER, PERIODS = 8, 4


def lightly_damped(friction: float = 0.0) -> PairTransient:
    """Above its natural speed, so that its teeth part and meet within four mesh periods."""
    fast = moving("spur", friction, 4800.0, free=True)
    pair = replace(fast.pair, mesh_damping=0.05 * fast.pair.mesh_damping)
    return replace(fast, pair=pair, contacts=replace(fast.contacts, pair=pair, store=ContactStore()))


def run(positions: int, division: DividedSteps) -> list[MovingMoment]:
    """From the same start; at the positions of the coarse table."""
    fast = lightly_damped()
    contacts = KeptContacts(fast.pair, positions, fast.contacts.components)
    state = started(fast)
    every = positions // POSITIONS
    return list(replace(fast, contacts=contacts, division=division).run(state, PERIODS))[every - 1 :: every]


@cache
def divided() -> list[MovingMoment]:
    return run(POSITIONS, DividedSteps(3e-3, 6))


def errors(found: list[MovingMoment]) -> Floats:
    return np.array([moment.result.transmission_error for moment in found])


def test_divided_steps_find_what_fine_equal_steps_find() -> None:
    """Ten positions a mesh period through separation: the transmission error at them is within 1 % of the largest that
    of eight times as many equal steps; ten equal steps are off by more than 25 %."""
    fine, coarse = run(FINER * POSITIONS, DividedSteps()), run(POSITIONS, DividedSteps())
    assert any(len(moment.result.contact.tooth) == 0 for moment in fine)
    largest = np.abs(errors(fine)).max()
    assert np.abs(errors(divided()) - errors(fine)).max() < 0.01 * largest
    assert np.abs(errors(coarse) - errors(fine)).max() > 0.25 * largest


def test_positions_are_hit() -> None:
    """Whatever the lengths, which differ: moments are the multiples of the way's time, rotations those of the table, to
    the last digit; steps were rejected and are counted; the shortest is an exact part of the way."""
    fast, found = lightly_damped(), divided()
    assert [moment.time for moment in found] == [n * fast.time_step for n in range(1, len(found) + 1)]
    angles = [(n % POSITIONS) * fast.contacts.step_angle for n in range(1, len(found) + 1)]
    assert [moment.result.stand.angle for moment in found] == angles
    steps = [moment.steps for moment in found]
    assert len({each.accepted for each in steps}) > 3
    assert sum(each.rejected for each in steps) > 3
    assert max(each.error for each in steps) <= 3e-3
    for each in steps:
        assert np.log2(fast.time_step / each.shortest) == int(np.log2(fast.time_step / each.shortest)) <= 6
        assert each.accepted <= fast.time_step / each.shortest


def test_balances_hold_at_every_step() -> None:
    """The largest residuals of all steps, from the first one on: of the equations of motion, of the forces and of the
    motion's energy, also where lengths change, as of equal steps."""
    for moment in divided():
        worst = moment.residuals
        assert max(worst.momentum, worst.reaction) < 1e-10
        assert worst.motion < 1e-12
    assert max(moment.residuals.exchange for moment in divided()[1:]) < 1e-3


def test_energies_of_the_way() -> None:
    """Passed on is the load's torque times the rotation, however many steps it takes; over a steady period, in steps of
    different lengths with friction, the contact gives what damping and time scheme take out, and the mean mesh force
    is the load's, within 0.1 %."""
    fast = lightly_damped()
    passed = fast.pair.drive.torque / fast.pair.lever * fast.pair.base_radii[0] * fast.contacts.step_angle
    assert [moment.energies.passed for moment in divided()] == pytest.approx([passed] * len(divided()), rel=1e-12)
    smooth = replace(moving("spur", 0.2, 2000.0, free=True), division=DividedSteps(4e-3, 6))
    found = until_steady(smooth, started(smooth), 60, 1e-5)
    assert found.is_steady
    assert len({moment.steps.accepted for moment in found.moments}) > 1
    assert found.energies.given == pytest.approx(found.energies.damping + found.energies.numerical, rel=1e-3)
    assert found.energies.numerical > 0.0
    assert found.steps.accepted > 2 * POSITIONS
    load = smooth.pair.drive.torque / smooth.pair.lever
    assert found.mean_force == pytest.approx(load, rel=1e-3)  # of all steps; that of ten positions is not
    assert float(np.mean([moment.mesh_force for moment in found.moments])) != pytest.approx(load, rel=1e-3)
    assert found.lowest_error <= found.errors.min()
    assert found.steps.largest_force >= max(moment.mesh_force for moment in found.moments)


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_nothing_divided_is_the_equal_run(friction: float) -> None:
    """A tolerance above all errors: the same to the last digit."""
    fast = moving("spur", friction, 2000.0, free=True)
    equal, loose = moments(fast, 2), moments(replace(fast, division=DividedSteps(1.0, 6)), 2)
    for one, other in zip(equal, loose, strict=True):
        assert astuple(one.steps) == astuple(other.steps)
        assert (one.time, one.mesh_force, one.rate) == (other.time, other.mesh_force, other.rate)
        np.testing.assert_equal(astuple(one.residuals) + astuple(one.energies),
                                astuple(other.residuals) + astuple(other.energies))
        for a, b in zip(astuple(one.state.motion), astuple(other.state.motion)):
            assert np.array_equal(a, b)


def test_what_lies_between_is_kept() -> None:
    """A run from the state at the end of another, over the same mesh period in time: nothing is searched again. With
    no room for any it is the same to the last digit."""
    fast = replace(moving("spur", 0.2, 2000.0, free=True), division=DividedSteps(4e-3, 6))
    wanted = moments(fast, 1)
    searched = dict(fast.contacts.store.kept)
    assert any(phase % 1.0 for phase, *_ in searched)
    assert [moment.mesh_force for moment in moments(fast, 1)] == [moment.mesh_force for moment in wanted]
    assert fast.contacts.store.kept.keys() == searched.keys()
    bare = replace(fast, contacts=KeptContacts(fast.pair, POSITIONS, fast.contacts.components, ContactStore(0.0)))
    assert [moment.mesh_force for moment in moments(bare, 1)] == [moment.mesh_force for moment in wanted]


def test_a_step_that_cannot_be_solved_is_halved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Position 3 is not found in one step: it is in two. Without a tolerance, and where no halves are left, the run
    ends."""
    right = PairTransient._solved

    def wrong(transient: PairTransient, state: object, n: int, reached: float, halvings: int) -> SolvedStep:
        if n == 3 and halvings == 0:
            raise NotConverged("here")
        return right(transient, state, n, reached, halvings)  # type: ignore[arg-type]

    monkeypatch.setattr(PairTransient, "_solved", wrong)
    fast = moving("spur", 0.0, 2000.0, free=True)
    found = moments(replace(fast, division=DividedSteps(1.0, 6)), 1)
    assert [(moment.steps.accepted, moment.steps.rejected) for moment in found[:4]] == [(1, 0), (1, 0), (2, 1), (1, 0)]
    with pytest.raises(NotConverged, match="here"):
        moments(fast, 1)

    def never(*given: object) -> SolvedStep:
        raise NotConverged("here")

    monkeypatch.setattr(PairTransient, "_solved", never)
    with pytest.raises(NotConverged, match="here"):
        moments(replace(fast, division=DividedSteps(1.0, 2)), 1)


def test_the_shortest_step_counts_with_any_error() -> None:
    """Halves at most under a tolerance that nothing reaches: two equal steps on every way, as with twice as many
    positions but for the numbering, and the error says so."""
    fast = replace(moving("spur", 0.0, 2000.0, free=True), scheme=TimeScheme(0.5))
    state = started(fast)
    halved = list(replace(fast, division=DividedSteps(1e-9, 1)).run(state, 1))
    contacts = KeptContacts(fast.pair, 2 * POSITIONS, fast.contacts.components)
    twice = list(replace(fast, contacts=contacts).run(state, 1))[1::2]
    assert [moment.steps.accepted for moment in halved] == [2] * POSITIONS
    assert [moment.steps.rejected for moment in halved] == [1] + [0] * (POSITIONS - 1)
    assert min(moment.steps.error for moment in halved) > 1e-9
    assert errors(halved) == pytest.approx(errors(twice), rel=1e-9)


def test_a_wrong_energy_at_a_changed_length_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The energy that a state had in steps of the old length, carried on: the balance of the motion is off there, and
    the position is named."""
    monkeypatch.setattr(StepEnd, "in_steps_of", lambda end, *given: end)
    with pytest.raises(Unbalanced, match=r"4800 r/min, μ = 0, pinion at .*°: wanted an energy balance of the motion"):
        run(POSITIONS, DividedSteps(3e-3, 6))


def test_steps_between_positions_are_certified(monkeypatch: pytest.MonkeyPatch) -> None:
    """The balance of each accepted step is asked: a force that is wrong between two positions alone ends the run."""
    right, angle = StepBalance._momentum, lightly_damped().contacts.step_angle
    assert isinstance(right, property) and right.fget is not None

    def wrong(balance: StepBalance) -> float:
        between = abs(balance.result.stand.angle / angle % 1.0 - 0.5) < 0.4
        return 1.0 if between else float(right.fget(balance))  # type: ignore[misc]

    monkeypatch.setattr(StepBalance, "_momentum", property(wrong))
    with pytest.raises(Unbalanced, match="wanted equations of motion"):
        run(POSITIONS, DividedSteps(3e-3, 6))
