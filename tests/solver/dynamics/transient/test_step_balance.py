"""The balances of time steps: what they are in a run, that each of them can fail, and that a failure is an error."""

from __future__ import annotations

from dataclasses import astuple, fields, replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, TimeScheme
from evolvent.dynamics.transient import pair_transient
from evolvent.dynamics.transient.certificates import EXACT, LIMITS, Unbalanced, certify_motion, certify_step
from evolvent.dynamics.transient.kept_contacts import ContactStore, KeptContacts
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_step import PairStep, SearchedContact
from evolvent.dynamics.transient.steady_state import MeshPeriods, until_steady
from evolvent.dynamics.transient.step_balance import Residuals, StepBalance, StepEnd
from tests.support.running.transient_pairs import POSITIONS, moments, moving, started

Balanced = tuple[StepBalance, StepEnd]
GOOD = Residuals(0.0, 0.0, 0.0, 0.0, 0.0)


@cache
def steady() -> MeshPeriods:
    """2000 r/min, both gears free, μ = 0.2, four modes of each harmonic: periodic to 1e-5."""
    fast = moving("spur", 0.2, 2000.0, count=4, free=True)
    return until_steady(fast, started(fast), 60, 1e-5)


@pytest.fixture
def balanced(monkeypatch: pytest.MonkeyPatch) -> Balanced:
    """The balance of a fast pair's third step, with friction and modes, and what it begins with."""
    seen: list[StepBalance] = []

    def kept(*parts: object) -> StepBalance:
        seen.append(StepBalance(*parts))  # type: ignore[arg-type]
        return seen[-1]

    monkeypatch.setattr(pair_transient, "StepBalance", kept)
    fast = moving("spur", 0.2, 2000.0, count=2)
    states = [moment.state for _, moment in zip(range(3), fast.run(started(fast), 1))]
    before = states[1].before
    assert before is not None
    return seen[2], before


def test_balances_of_a_steady_motion() -> None:
    """Momentum, reaction and the motion's energy hold to 1e-12 at every step, moments to 1e-4, each step accounts for
    all but 0.5 % of the energy that passes, the mesh period for all but 0.02 %."""
    found = steady()
    worst = found.residuals
    assert max(worst.momentum, worst.reaction, worst.motion) < 1e-12
    assert 0.0 < worst.moment < 1e-4
    assert 0.0 < worst.exchange < 5e-3
    assert abs(found.energies.left) < 2e-4 * found.energies.passed


def test_losses_of_a_steady_motion() -> None:
    """Over a mesh period the contact gives the motion what damping and time scheme take out, as none is left over, both
    above zero; friction is that of the positions in the nominal sliding, a sum over tractions and sliding, and 0.03 %
    in the slip beyond it."""
    found = steady()
    energies, step = found.energies, 2.0 * np.pi / 50.0 / POSITIONS
    assert found.is_steady
    assert energies.damping > 0.0
    assert energies.numerical > 0.0
    assert energies.given == pytest.approx(energies.damping + energies.numerical, rel=1e-2)
    friction = sum(moment.result.friction_loss * step for moment in found.moments)
    assert 2e-4 < energies.friction / friction - 1.0 < 5e-4
    assert 0.01 < energies.friction / energies.passed < 0.05


def test_without_numerical_damping_nothing_is_taken_out() -> None:
    """ρ_∞ = 1: the scheme takes exactly nothing, and the balance of the motion is as exact."""
    fast = replace(moving("spur", 0.0, 2000.0, count=2, free=True), scheme=TimeScheme(1.0))
    found = moments(fast, 1)[1:]
    assert all(moment.energies.numerical == 0.0 for moment in found)
    assert max(moment.residuals.motion for moment in found) < 1e-12


def test_friction_through_separation() -> None:
    """A lightly damped pair near its natural speed loses contact for whole time steps, and comes back with friction:
    the balances hold there, too."""
    fast = moving("spur", 0.2, 4200.0, count=2, free=True)
    pair = replace(fast.pair, mesh_damping=0.05 * fast.pair.mesh_damping)
    fast = replace(fast, pair=pair, contacts=replace(fast.contacts, pair=pair, store=ContactStore()))
    found = moments(fast, 12)
    apart = [len(moment.result.contact.tooth) == 0 for moment in found]
    assert any(apart)
    assert any(one and not other for one, other in pairwise(apart))
    assert max(moment.residuals.momentum for moment in found) < 1e-10
    assert max(moment.residuals.exchange for moment in found[1:]) < 1e-2


@pytest.mark.parametrize("kind", ["spur", "helical"])
def test_energy_that_creeping_contact_gives_back(kind: str) -> None:
    """Problem: time steps 2000 times as short as those of the other tests. Points that stuck slip back by and by.
    Exact: the energy that flanks and motion give back goes to friction, more than eight times what the nominal sliding
    has. Less than 7 % of it is left over; by the nominal sliding it would be more than nine tenths."""
    slow = moving(kind, 0.5, 30.0)
    slow = replace(slow, contacts=KeptContacts(slow.pair, 20000, slow.contacts.components))
    for moment in [moment for _, moment in zip(range(6), slow.run(started(slow), 1))][1:]:
        energies = moment.energies
        nominal = moment.result.friction_loss * slow.contacts.step_angle
        assert energies.stored + energies.given < 0.0
        assert energies.friction > 8.0 * nominal
        assert abs(energies.left) < 0.07 * energies.friction


def broken(part: str, balance: StepBalance) -> StepBalance:
    """With a millionth more of a part of it."""
    much, sums, state = 1.0 + 1e-6, balance.sums, balance.state
    if part in ("position", "velocity", "acceleration"):
        return replace(balance, state=replace(state, **{part: getattr(state, part) * much}))
    if part == "torque of the pinion":
        return replace(balance, sums=replace(sums, torques=(sums.torques[0] * much, sums.torques[1])))
    if part == "forces on modes":
        return replace(balance, sums=replace(sums, modal=sums.modal * much))
    if part == "forces on the wheel":
        return replace(balance, sums=replace(sums, resultants=sums.resultants * np.array([[1.0], [much]])))
    assert part == "moment of the wheel's forces"
    one, other = sums.about_pinion
    return replace(balance, sums=replace(sums, about_pinion=(one, other * 1.02)))


@pytest.mark.parametrize(("part", "missed"), [
    ("position", "momentum"), ("velocity", "motion"), ("acceleration", "momentum"),
    ("torque of the pinion", "momentum"), ("torque of the pinion", "reaction"), ("forces on modes", "momentum"),
    ("forces on the wheel", "reaction"), ("moment of the wheel's forces", "moment"),
])
def test_a_millionth_is_seen(balanced: Balanced, part: str, missed: str) -> None:
    """A state or a force that is wrong by 1e-6, a moment by 2 %: the balance that it enters is off, and refused."""
    balance, before = balanced
    certify_step(balance.residuals(before), False, "here")
    found = broken(part, balance).residuals(before)
    limit = next(each for each in LIMITS if each.name == missed)
    assert getattr(found, missed) > limit.most
    with pytest.raises(Unbalanced, match=r"^here: wanted "):
        certify_step(found, False, "here")


def test_energy_that_is_not_accounted_for_is_seen(balanced: Balanced) -> None:
    """Flanks that store a tenth of what passes from nowhere."""
    balance, before = balanced
    stored = balance.stored + 0.1 * balance.energies(before).passed
    found = replace(balance, stored=stored).residuals(before)
    with pytest.raises(Unbalanced, match=r"between rotation, contact and motion within 0\.05"):
        certify_step(found, False, "here")


@pytest.mark.parametrize("name", [field.name for field in fields(Residuals)])
def test_every_residual_has_its_limit(name: str) -> None:
    """None may be twice its limit or no number, but for energies of the first step."""
    limit = next(each for each in LIMITS if each.name == name)
    certify_step(replace(GOOD, **{name: limit.most}), False, "here")
    for wrong in (2.0 * limit.most, float("nan")):
        with pytest.raises(Unbalanced, match=f"found {wrong:.2e}"):
            certify_step(replace(GOOD, **{name: wrong}), False, "here")
    if limit.from_second:
        certify_step(replace(GOOD, **{name: float("nan")}), True, "here")


def test_steady_motion_that_gains() -> None:
    """A mean force 2 % above the load, energy of 2 % of what passes."""
    certify_motion(1.005, -0.005, "here")
    with pytest.raises(Unbalanced, match=r"mean mesh force within 1% .* found 1\.02"):
        certify_motion(1.02, 0.0, "here")
    with pytest.raises(Unbalanced, match=r"mesh period within 0\.01"):
        certify_motion(1.0, 0.02, "here")


def test_a_run_with_a_wrong_step_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """States whose modes are a millionth too large: the first step is refused, and speed, friction and position are
    named."""
    right = PairStep.state

    def wrong(step: PairStep, at: SearchedContact, found: object) -> KinematicState:
        state = right(step, at, found)  # type: ignore[arg-type]
        return replace(state, position=state.position * (1.0 + 1e-6))

    monkeypatch.setattr(PairStep, "state", wrong)
    fast = moving("spur", 0.2, 2000.0, count=2)
    with pytest.raises(Unbalanced, match=r"2000 r/min, μ = 0\.2, pinion at 0\.720°: wanted equations of motion"):
        moments(fast, 1)


def test_a_run_with_wrong_renumbering_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """Amplitudes that grow by 1 % where the teeth are numbered anew: energy comes from nowhere, at that step."""
    right = MovingPair.earlier
    monkeypatch.setattr(MovingPair, "earlier", lambda pair, z, pitches: 1.01 * right(pair, z, pitches))
    fast = moving("spur", 0.0, 2000.0, count=2)
    with pytest.raises(Unbalanced, match=r"pinion at 0\.000°: wanted an energy balance of the motion"):
        moments(fast, 1)


def test_first_step_has_no_energy_balance() -> None:
    """It begins from statics: its energies are not known, all others are."""
    fast = moving("spur", 0.2, 2000.0, count=2)
    first, second = [moment for _, moment in zip(range(2), fast.run(started(fast), 1))]
    assert np.isnan([first.residuals.motion, first.residuals.exchange]).all()
    assert np.isfinite([first.residuals.momentum, first.residuals.reaction, first.residuals.moment]).all()
    assert np.isfinite([*astuple(second.residuals), *astuple(second.energies)]).all()
    assert EXACT > first.residuals.larger(second.residuals).motion == second.residuals.motion
