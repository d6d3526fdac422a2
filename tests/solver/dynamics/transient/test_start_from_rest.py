"""Transients of a spur pair in plane strain that begin with a blow."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator

from evolvent.dynamics.transient.divided_steps import DividedSteps
from evolvent.dynamics.transient.kept_contacts import ContactStore, KeptContacts
from evolvent.dynamics.transient.pair_state import PairState
from evolvent.dynamics.transient.pair_step import PairStep
from evolvent.dynamics.transient.pair_transient import MovingMoment, PairTransient
from evolvent.dynamics.transient.start_from_rest import start_from_rest
from evolvent.dynamics.transient.steady_state import until_steady
from evolvent.gears.contact.pair_contact import gear_contact
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.arrays import Floats
from tests.support.gear_cases import helical_scene, spur_scene
from tests.support.running.transient_pairs import moving, started

RPM, POSITIONS = 30.0, 6000


def resting(friction: float = 0.0, positions: int = POSITIONS) -> tuple[PairTransient, PairState]:
    """All inertia at the bores, where the pair has one degree of freedom."""
    slow = moving("spur", friction, RPM, count=0)
    case = replace(slow, contacts=KeptContacts(slow.pair, positions, slow.contacts.components))
    problem = gear_problem(spur_scene("mesh.level=quick"))
    return case, start_from_rest(case.pair, problem, case.speed.rad_s, friction)


def first(case: PairTransient, start: PairState, count: int) -> list[MovingMoment]:
    return [moment for moment, _ in zip(case.run(start, 1), range(count))]


@cache
def restoring() -> PchipInterpolator:
    """Static mesh force [N/mm] over the transmission error [mm] at rotation 0, by sweeps under other torques."""
    model = moving("spur", 0.0, RPM, count=0).pair.model
    shares, errors = np.geomspace(0.02, 3.0, 40), []
    for share in shares:
        loaded = replace(model, load=replace(model.load, torque=share * model.load.torque))
        (position,) = sweep_pitch(loaded, Pitch((0.0,)), [0.0], initial_state([0.0]))
        errors.append(position.results[0].transmission_error)
    load = model.load.torque / model.pair.gears[model.load.on].base_radius
    return PchipInterpolator(errors, shares * load)


def test_flanks_just_touch() -> None:
    """Exact: no contact point overlaps, and one has no gap, to 0.1 µm of the meshed flanks. The transmission error
    grows at the speed of the line of action."""
    case, start = resting()
    pair, ψ = case.pair, float(start.motion.position[-1])
    stand = PairRotation(pair.model.pair, 0.0, pair.drive.rotations(ψ))
    gaps = gear_contact(pair.model.bodies, stand, list(pair.model.teeth), np.inf).operator.gap
    assert abs(float(np.min(gaps))) < 1e-4
    rate = float(start.motion.velocity[-1]) * pair.lever
    assert rate == pytest.approx(case.speed.rad_s * pair.model.pair.pinion.base_radius, rel=1e-12)


def test_blow_is_that_of_an_oscillator_on_the_static_force() -> None:
    """Problem: no modes, a rotation of 0.07° in all. Exact: m ẍ + c ẋ + F(x) = F_0 with the static force F(x) at
    rotation 0, from x = e at the speed of the line of action, by SciPy to 1e-9. The rotation changes F(x) on these
    elements by up to 2 %, and the way by less."""
    case, start = resting()
    pair, lever = case.pair, case.pair.lever
    found = first(case, start, 60)
    m, load, F = pair.drive.inertia / lever**2, pair.drive.torque / lever, restoring()
    least = float(start.motion.position[-1]) * lever

    def force(x: float) -> float:
        return float(F(x)) if x > F.x[0] else max(0.0, float(F(F.x[0])) * (x - least) / (F.x[0] - least))

    def rates(_: float, state: Floats) -> list[float]:
        return [state[1], (load - force(state[0]) - pair.mesh_damping * state[1]) / m]

    times = np.array([moment.time for moment in found])
    begin = [least, float(start.motion.velocity[-1]) * lever]
    exact = solve_ivp(rates, (0.0, times[-1]), begin, t_eval=times, rtol=1e-9, atol=1e-12).y[0]
    forces = np.array([force(x) for x in exact])
    assert forces.max() > 2.0 * load
    errors = [moment.result.transmission_error for moment in found]
    np.testing.assert_allclose(errors, exact, atol=0.005 * exact.max())
    np.testing.assert_allclose([moment.mesh_force for moment in found], forces, atol=0.025 * forces.max())


def test_load_acts_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: the pair pushed apart, at rest, undamped: no flank touches. Exact: the load moves it as from the first
    instant on, ẋ = (F_0/m) t. No compliance is put together for that; solved with it, the motion is the same."""
    case, _ = resting(positions=1500)
    pair = replace(case.pair, mesh_damping=0.0)
    case = replace(case, pair=pair, contacts=replace(case.contacts, pair=pair, store=ContactStore()))
    begin = start_from_rest(pair, gear_problem(spur_scene("mesh.level=quick")), 0.0, 0.0)
    apart = begin.motion.position - np.append(np.zeros(pair.count), 0.05 / pair.lever)
    begin = replace(begin, motion=replace(begin.motion, position=apart))
    found = first(case, begin, 6)
    pushed = pair.drive.torque / pair.lever / (pair.drive.inertia / pair.lever**2)
    times = np.array([moment.time for moment in found])
    assert not any(moment.mesh_force for moment in found)
    rates = [moment.rate for moment in found]
    np.testing.assert_allclose(rates, pushed * times, rtol=1e-9)
    assert not any(at.is_condensed for at in case.contacts.store.kept.values())
    monkeypatch.setattr(PairStep, "in_flight", lambda *_: None)
    np.testing.assert_allclose([moment.rate for moment in first(case, begin, 6)], rates, rtol=1e-12)
    assert all(at.is_condensed for at in case.contacts.store.kept.values())


def test_friction_acts_from_the_first_step() -> None:
    """Away from the pitch point flanks slide from the start on: friction takes energy in the first time step."""
    case, start = resting(0.2)
    (moment,) = first(case, start, 1)
    assert moment.mesh_force > 0.0
    assert moment.result.friction_loss > 0.0


def test_friction_of_a_fast_start() -> None:
    """Problem: a helical pair at 300 r/min, μ = 0.2, its first blow, in which the wheel turns back and forth as fast as
    it turns nominally, and slip with it. Exact: all energy has an account; 3 % of what friction takes is left over in
    twenty time steps, and 2 % of what the load passes on in any of them. The nominal sliding has less than half of this
    friction, and the balance would be missed."""
    slow = moving("helical", 0.2, 300.0, count=0)
    case = replace(slow, contacts=KeptContacts(slow.pair, 300, slow.contacts.components))
    start = start_from_rest(case.pair, gear_problem(helical_scene()), case.speed.rad_s, 0.2)
    found = first(case, start, 20)[1:]
    assert max(moment.mesh_force for moment in found) > 1.5 * case.pair.drive.torque / case.pair.lever
    friction = sum(moment.energies.friction for moment in found)
    nominal = sum(moment.result.friction_loss for moment in found) * case.contacts.step_angle
    assert friction > 2.0 * nominal
    assert sum(abs(moment.energies.left) for moment in found) < 0.03 * friction
    assert max(moment.residuals.exchange for moment in found) < 0.02


def test_motion_ends_as_from_statics() -> None:
    """Problem: the same pair from rest and from statics, until it repeats. Exact: one motion; each has time steps of
    its own, whose tolerance leaves some of it."""
    case, start = resting(positions=40)
    case = replace(case, division=DividedSteps(3e-3, 8))
    rest, statics = (until_steady(case, each, 40, 1e-3) for each in (start, started(case)))
    assert rest.is_steady
    assert statics.is_steady
    one, other = (np.array([each.result.transmission_error for each in found.moments]) for found in (rest, statics))
    assert np.abs(one - other).max() < 0.01 * np.ptp(other)


@pytest.mark.parametrize("damping_in_separation", [False, True])
def test_free_flight(damping_in_separation: bool) -> None:
    """Problem: the pair after its teeth have parted. Exact: m ẍ = F_0, a parabola, as the damping of the mesh does not
    act, or m ẍ + c ẋ = F_0 where it does. The energy of the motion is in balance where it begins to act or ends."""
    case, start = resting(positions=1500)
    pair = replace(case.pair, damping_in_separation=damping_in_separation, mesh_damping=0.2 * case.pair.mesh_damping)
    case = replace(case, pair=pair, contacts=replace(case.contacts, pair=pair, store=ContactStore()))
    found = first(case, start, 60)
    touching = [bool(moment.mesh_force) for moment in found]
    parted = touching.index(False)
    apart = found[parted : touching.index(True, parted)]
    assert len(apart) > 4
    assert found[-1].mesh_force > 0.0
    m, load = pair.drive.inertia / pair.lever**2, pair.drive.torque / pair.lever
    c = pair.mesh_damping if damping_in_separation else 0.0
    rates = np.array([moment.rate for moment in apart])
    accelerations = (load - c * rates) / m
    spans = np.diff([moment.time for moment in apart])
    changes = np.diff(rates) / spans
    wanted = 0.5 * (accelerations[:-1] + accelerations[1:])
    np.testing.assert_allclose(changes[1:], wanted[1:], rtol=0.01)  # the first step has the contact's in it
    assert max(moment.residuals.motion for moment in found[1:]) < 1e-10
