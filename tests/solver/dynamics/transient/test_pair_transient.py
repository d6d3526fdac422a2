"""A gear pair over time: its static limit, slow and fast rotation, its modes."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.transient.kept_contacts import ContactStore, KeptContacts
from evolvent.dynamics.transient.pair_state import SolvedStep
from evolvent.dynamics.transient.steady_state import until_steady
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats
from tests.support.running.samples import sampled
from tests.support.running.transient_pairs import POSITIONS, condensed, moments, moving, started


def static(kind: str, friction: float) -> list[PositionResult]:
    """The same positions, the second of two pitches, so that friction has its history."""
    model = condensed(kind)
    pitch = uniform_pitch(model.pair.pinion.z, POSITIONS, 2)
    return [p.results[0] for p in sweep_pitch(model, pitch, [friction], initial_state([friction]))][POSITIONS:]


def errors(results: list[PositionResult]) -> Floats:
    return np.array([result.transmission_error for result in results])


@pytest.mark.parametrize("count", sampled([0, 1, 4], every=2))
@pytest.mark.parametrize(("kind", "friction"), [("spur", 0.0), ("spur", 0.2), ("helical", 0.2)])
def test_slow_rotation_is_the_quasi_static_sweep(kind: str, friction: float, count: int) -> None:
    """30 r/min, with none, one and four modes of each harmonic: transmission errors and torques of the second mesh
    period are those of the quasi-static sweep within 0.5 % of their largest. A step is eight periods of the pair on its
    mesh here: ρ_∞ = 0."""
    slow = replace(moving(kind, friction, 30.0, count), scheme=TimeScheme(0.0))
    last = [moment.result for moment in moments(slow, 2)[-POSITIONS:]]
    wanted = static(kind, friction)
    found = np.roll(errors(last), 1)
    assert found == pytest.approx(errors(wanted), abs=0.005 * np.abs(errors(wanted)).max())
    for gear in range(2):
        torque = np.array([result.torques[gear] for result in wanted])
        moved = np.roll([result.torques[gear] for result in last], 1)
        assert moved == pytest.approx(torque, abs=0.005 * np.abs(torque).max())


@pytest.mark.parametrize("count", [0, 4])
def test_long_steps_are_statics(count: int) -> None:
    """Time steps of 1e6 s each, without friction: on the same searched contacts the equilibrium of statics to 1e-10,
    for any number of modes."""
    slow = moving("spur", 0.0, 1.0, count)
    slow = replace(slow, speed=MeshSpeed.of_period(1e6 * slow.contacts.positions, slow.pair.model.pair.pinion.z))
    frozen = moving("spur", 0.0, 1.0, 0)
    frozen = replace(frozen, speed=slow.speed, contacts=replace(frozen.contacts, store=ContactStore()))
    for one, other in zip(moments(slow, 1), moments(frozen, 1)):
        assert one.result.transmission_error == pytest.approx(other.result.transmission_error, rel=1e-10)
        assert one.mesh_force == pytest.approx(slow.pair.drive.torque / slow.pair.lever, rel=1e-10)
        assert np.abs(one.state.vibration).max(initial=0.0) < 1e-10 * np.abs(one.state.motion.position).max()


def test_mean_force_of_a_steady_state_is_the_load() -> None:
    """2000 r/min, both gears free, no friction: the motion comes to repeat with the mesh to 1e-4, and the mean mesh
    force is then the torque over its lever to 1e-3, as no momentum is left over."""
    fast = moving("spur", 0.0, 2000.0, free=True)
    found = until_steady(fast, started(fast), 60, 1e-4)
    force = np.array([moment.mesh_force for moment in found.moments])
    assert found.is_steady
    assert found.periods == len(found.changes) + 1 < 60
    assert found.mean_force == pytest.approx(fast.pair.drive.torque / fast.pair.lever, rel=1e-3)
    assert np.ptp(force) > 0.2 * force.mean()
    assert [moment.result.stand.angle for moment in found.moments] == sorted(
        moment.result.stand.angle for moment in found.moments
    )


def test_contacts_that_are_not_kept_are_searched_again() -> None:
    """Without room for any, and with room for some: the same forces to the last digit."""
    fast = moving("spur", 0.2, 2000.0)
    wanted = [moment.mesh_force for moment in moments(fast, 2)]
    one = max(each.counted_bytes for each in fast.contacts.store.kept.values())
    for most, count in ((0.0, 0), (3.5 * one, 3)):
        kept = KeptContacts(fast.pair, POSITIONS, fast.contacts.components, ContactStore(most))
        assert [moment.mesh_force for moment in moments(replace(fast, contacts=kept), 2)] == wanted
        assert len(kept.store.kept) in (count, count + 1)


def test_contacts_are_counted_as_solved() -> None:
    """Two mesh periods: the memory of every contact, when others were searched after it, has all that solutions derived
    from it, several times its matrix."""
    fast = moving("helical", 0.2, 2000.0)
    moments(fast, 2)
    contacts = fast.contacts.store.kept.values()
    counted = [each.counted_bytes for each in contacts]
    for each in contacts:
        vars(each).pop("_condensed_bytes")
    assert [each.counted_bytes for each in contacts] == counted
    assert all(size > 2 * each.compliance.nbytes for size, each in zip(counted, contacts))


def test_teeth_are_renumbered_after_a_pitch() -> None:
    """The same start, seen a pitch later with the other teeth: the motion that follows is the same to 1e-9."""
    fast = moving("helical", 0.0, 3000.0, count=2)
    start = started(fast)
    once = [moment.mesh_force for moment in fast.run(start, 1)]
    pair, motion = fast.pair, start.motion
    rounded = type(motion)(*(pair.earlier(pair.earlier(each, 1), -1) for each in (
        motion.position, motion.velocity, motion.acceleration)))
    again = [moment.mesh_force for moment in fast.run(replace(start, motion=rounded), 1)]
    assert again == pytest.approx(once, rel=1e-9)


@pytest.mark.parametrize(
    ("damped_touches", "free_touches", "guess", "taken"),
    [
        (True, True, True, True), (True, True, False, True), (False, False, True, False),
        (False, False, False, False), (False, True, True, False), (False, True, False, False),
    ],
)
def test_damping_is_that_of_the_end(damped_touches: bool, free_touches: bool, guess: bool, taken: bool) -> None:
    """Problem: whether flanks touch at the end of a step with the damping of the mesh and without, and what is tried
    first. Exact: the damped end if flanks touch there, else the free one, also where only damping would keep them
    apart; whatever is tried first."""
    touches = {True: damped_touches, False: free_touches}

    def ended(damped: bool) -> SolvedStep:
        return cast(SolvedStep, SimpleNamespace(touches=touches[damped], damped=damped))

    found = moving("spur", 0.0, 30.0, count=0)._damped_in_contact(guess, ended)
    assert cast(SimpleNamespace, found).damped is taken
