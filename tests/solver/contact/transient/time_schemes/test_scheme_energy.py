"""The energy that the time scheme keeps: an identity under any forces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest

from evolvent.contact.transient.time_schemes.scheme_energy import SchemeEnergy
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, LinearSystem, TimeScheme, TimeStep
from evolvent_meshes.arrays import Floats

STEP, COUNT = 0.37, 4


@dataclass(frozen=True)
class Step:
    """From a state to the next one, with the forces at both ends and the acceleration one step before."""

    before: Floats
    begin: KinematicState
    end: KinematicState
    forces: tuple[Floats, Floats]


def energy(spectral_radius: float, step: float = STEP) -> SchemeEnergy:
    """Four coordinates with a full random mass matrix, random damping and stiffness."""
    random = np.random.default_rng(3)
    root = random.standard_normal((COUNT, COUNT))
    system = LinearSystem(root @ root.T + np.eye(COUNT), random.random(COUNT), 10.0 * random.random(COUNT))
    return SchemeEnergy(system, TimeScheme(spectral_radius), step)


def steps(at: SchemeEnergy, count: int = 40) -> Iterator[Step]:
    """Under random forces from a random state, from the second step on."""
    random = np.random.default_rng(5)
    position, velocity, acceleration = random.standard_normal((3, COUNT))
    state, last = KinematicState(position, velocity, acceleration), None
    for _ in range(count):
        force, step = 5.0 * random.standard_normal(COUNT), TimeStep(at.system, at.scheme, state, at.length)
        reached = step.after(np.linalg.solve(step.matrix, force + step.known))
        if last is not None:
            yield Step(last[0], state, reached, (last[1], force))
        state, last = reached, (state.acceleration, force)


def imbalance(at: SchemeEnergy, step: Step) -> float:
    """Change of E less work, plus what damping and the method take out."""
    moved, mean = step.end.position - step.begin.position, 0.5 * (step.forces[0] + step.forces[1])
    change = at.of(step.end, step.begin.acceleration) - at.of(step.begin, step.before)
    damped = 0.5 * (step.begin.velocity + step.end.velocity) @ (at.system.damping * moved)
    lost = float(damped) + at.taken(step.before, step.end)
    return change - float(mean @ moved) + lost


@pytest.mark.parametrize("spectral_radius", [0.0, 0.3, 0.8, 1.0])
def test_balance_is_exact_under_any_forces(spectral_radius: float) -> None:
    """Forces at random, a full mass matrix: every step balances to 1e-12 of its energy; the energy and what the method
    takes out are never negative, and it takes out nothing at ρ_∞ = 1."""
    at = energy(spectral_radius)
    for step in steps(at):
        kept = at.of(step.end, step.begin.acceleration)
        assert kept > 0.0
        assert abs(imbalance(at, step)) < 1e-12 * (kept + at.of(step.begin, step.before))
        taken = at.taken(step.before, step.end)
        assert taken > 0.0 if spectral_radius < 1.0 else taken == 0.0


@pytest.mark.parametrize("part", ["position", "velocity", "acceleration"])
def test_a_wrong_state_is_out_of_balance(part: str) -> None:
    """A millionth more of position, velocity or acceleration at the end of a step is seen."""
    at = energy(0.5)
    step = list(steps(at, 6))[-1]
    wrong = replace(step, end=replace(step.end, **{part: getattr(step.end, part) * (1.0 + 1e-6)}))
    assert abs(imbalance(at, wrong)) > 1e-9 > 1e3 * abs(imbalance(at, step))


def test_energy_is_kinetic_plus_elastic_for_short_steps() -> None:
    """Of the same state, with accelerations before and after that differ as those of a smooth motion do: the difference
    falls as h²."""
    state, jerk = KinematicState(*np.random.default_rng(7).standard_normal((3, COUNT))), np.ones(COUNT)
    found = []
    for h in (1e-2, 5e-3):
        at = energy(0.5, h)
        exact = 0.5 * state.velocity @ at.system.mass @ state.velocity
        exact += 0.5 * state.position @ (at.system.stiffness * state.position)
        found.append(at.of(state, state.acceleration - h * jerk) - exact)
    assert found[0] / found[1] == pytest.approx(4.0, rel=0.05)
