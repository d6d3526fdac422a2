"""What goes on from time steps of one length to those of another, and the error of a step."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

from evolvent.contact.transient.time_schemes.scheme_energy import SchemeEnergy
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, LinearSystem, TimeScheme, TimeStep
from evolvent.dynamics.transient.changed_length import motion_energy, step_error, stretched
from evolvent_meshes.arrays import Floats

COUNT = 4
LENGTHS = (0.4, 0.4, 0.2, 0.1, 0.1, 0.2, 0.05, 0.4, 0.4, 0.2)
RATE = 2.0
OSCILLATOR = LinearSystem(np.eye(1), np.zeros(1), np.array([RATE**2]))


def random_system() -> LinearSystem:
    """A full mass matrix, damping and stiffness at random."""
    random = np.random.default_rng(3)
    root = random.standard_normal((COUNT, COUNT))
    return LinearSystem(root @ root.T + np.eye(COUNT), random.random(COUNT), 10.0 * random.random(COUNT))


@dataclass(frozen=True)
class Step:
    """Under forces at both ends, from a state with the acceleration one step before."""

    energy: SchemeEnergy
    begin: KinematicState
    before: Floats
    end: KinematicState
    forces: Floats

    def imbalance(self, begin: KinematicState, before: Floats) -> float:
        """Change of E from this begin less work, plus what damping and the method take out, over E."""
        at, end = self.energy, self.end
        kept = at.of(end, self.begin.acceleration), at.of(begin, before)
        moved = end.position - begin.position
        damped = 0.5 * (begin.velocity + end.velocity) @ (at.system.damping * moved)
        lost = float(damped) + at.taken(before, end)
        return abs(kept[0] - kept[1] - float(self.forces @ moved) + lost) / sum(kept)


@pytest.mark.parametrize("spectral_radius", [0.0, 0.5, 1.0])
def test_energy_balance_is_exact_where_lengths_change(spectral_radius: float) -> None:
    """Random forces in steps of different lengths: with the energy that the state at the begin of a step has in steps
    of its length, each balances to 1e-12. With the accelerations of the old length none does whose length is another
    one, unless ρ_∞ = 1, where nothing lags."""
    random, system, scheme = np.random.default_rng(5), random_system(), TimeScheme(spectral_radius)
    state, before = KinematicState(*random.standard_normal((3, COUNT))), random.standard_normal(COUNT)
    last = system.mass @ ((1.0 - scheme.alpha) * state.acceleration + scheme.alpha * before)
    last += system.damping * state.velocity + system.stiffness * state.position
    for h_before, h in pairwise(LENGTHS):
        begin, past = stretched(scheme, state, before, h / h_before)
        force, step = 5.0 * random.standard_normal(COUNT), TimeStep(system, scheme, begin, h)
        end = step.after(np.linalg.solve(step.matrix, force + step.known))
        done = Step(SchemeEnergy(system, scheme, h), begin, past, end, 0.5 * (last + force))
        assert done.imbalance(begin, past) < 1e-12
        assert (done.imbalance(state, before) < 1e-12) == (h == h_before or spectral_radius == 1.0)
        state, before, last = end, begin.acceleration, force


def test_equation_of_motion_stays() -> None:
    """(1 − α) a'_n + α a'_{n−1} is what it was, position and velocity likewise; the same length changes nothing."""
    scheme, state = TimeScheme(0.3), KinematicState(*np.random.default_rng(1).standard_normal((3, COUNT)))
    before, α = np.arange(COUNT, dtype=float), scheme.alpha
    found, past = stretched(scheme, state, before, 0.25)
    assert (1.0 - α) * found.acceleration + α * past == pytest.approx((1.0 - α) * state.acceleration + α * before)
    assert found.acceleration - past == pytest.approx(0.25 * (state.acceleration - before))
    assert found.position is state.position
    assert found.velocity is state.velocity
    assert stretched(scheme, state, before, 1.0) == (state, before)


def swung(divisor: int, is_stretched: bool) -> float:
    """Error at t = 2 of an oscillator from z = 1, v = 0, in steps of 0.1 and 0.05 in turn over the divisor."""
    scheme, state = TimeScheme(0.3), KinematicState(np.ones(1), np.zeros(1), np.array([-(RATE**2)]))
    before, lengths, time = state.acceleration, [0.1 / divisor, 0.05 / divisor], 0.0
    for n in range(14 * divisor):
        h, h_before = lengths[n % 2], lengths[(n - 1) % 2]
        if n and is_stretched:
            state, before = stretched(scheme, state, before, h / h_before)
        step = TimeStep(OSCILLATOR, scheme, state, h)
        before, state, time = state.acceleration, step.after(step.known / step.matrix[0, 0]), time + h
    return abs(float(state.position[0]) - float(np.cos(RATE * time)))


def test_second_order_in_steps_of_different_lengths() -> None:
    """Halving all steps divides the error by four; by two without what is done here."""
    assert swung(32, True) / swung(64, True) == pytest.approx(4.0, rel=0.1)
    assert swung(32, False) / swung(64, False) == pytest.approx(2.0, rel=0.1)


def consistent(scheme: TimeScheme, h: float, time: float) -> KinematicState:
    """The oscillator's exact motion, with the acceleration that the scheme keeps: z̈ at t + αh."""
    position = np.array([np.sin(RATE * time)])
    lagging = np.array([-(RATE**2) * np.sin(RATE * (time + scheme.alpha * h))])
    return KinematicState(position, np.array([RATE * np.cos(RATE * time)]), lagging)


def test_error_of_a_step() -> None:
    """From the exact motion of an oscillator: the distance to it after a step, over the step and over its largest
    speed, is estimated within 5 %, and with four times the energy half as large."""
    scheme, h, time = TimeScheme(0.5), 0.01, 0.3
    state: KinematicState = consistent(scheme, h, time)
    step = TimeStep(OSCILLATOR, scheme, state, h)
    end, energy = step.after(step.known / step.matrix[0, 0]), motion_energy(OSCILLATOR, state)
    assert np.sqrt(2.0 * energy) == pytest.approx(RATE)
    missed: Floats = end.position - np.sin(RATE * (time + h))
    assert step_error(step, end, energy) == pytest.approx(abs(float(missed[0])) / h / RATE, rel=0.05)
    assert step_error(step, end, 4.0 * energy) == pytest.approx(0.5 * step_error(step, end, energy))
