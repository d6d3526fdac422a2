"""The stretched midpoint rule on linear systems, under any forces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.contact.transient.time_schemes.midpoint_step import MidpointStep
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, LinearSystem
from evolvent_meshes.arrays import Floats

H, SIZE = 0.3, 4


def step(stretch: float) -> MidpointStep:
    """Of four coordinates, from any state; the last one is free, and does not take part in the stretch."""
    rng = np.random.default_rng(3)
    root = rng.normal(size=(SIZE, SIZE))
    mass = root @ root.T + np.eye(SIZE)
    stiffness, damping = rng.uniform(1.0, 9.0, SIZE), rng.uniform(0.0, 0.5, SIZE)
    stiffness[-1] = damping[-1] = 0.0
    state = KinematicState(rng.normal(size=SIZE), rng.normal(size=SIZE), np.zeros(SIZE))
    return MidpointStep(LinearSystem(mass, damping, stiffness), state, H, stretch, np.zeros(SIZE))


def ended(step: MidpointStep, force: Floats) -> KinematicState:
    return step.after(np.linalg.solve(step.matrix, force + step.known))


def energy(system: LinearSystem, state: KinematicState) -> float:
    v, z = state.velocity, state.position
    return 0.5 * float(v @ system.mass @ v + z @ (system.stiffness * z))


@pytest.mark.parametrize("stretch", [0.2, 1.0, 3.0])
def test_energy_changes_by_the_work_the_correction_and_the_damping(stretch: float) -> None:
    """½vᵀMv + ½zᵀKz after a step less before it: p·Δz + κ(Δz − e)ᵀM Δz − hv̄ᵀDv̄, for any p and e, to rounding."""
    rng = np.random.default_rng(5)
    force, e = rng.normal(size=SIZE), rng.normal(size=SIZE)
    taken = replace(step(stretch), unstretched=e)
    after = ended(taken, force)
    moved = after.position - taken.state.position
    pushed = force + taken.correction * taken.system.mass @ (moved - e)
    change = energy(taken.system, after) - energy(taken.system, taken.state)
    assert change == pytest.approx(pushed @ moved - taken.damped(after), abs=1e-12)
    assert abs(change) > 0.1
    assert moved == pytest.approx(0.5 * H * (taken.state.velocity + after.velocity), abs=1e-12)


@pytest.mark.parametrize("stretch", [0.2, 3.0])
def test_no_correction_pushes_what_is_not_stretched(stretch: float) -> None:
    """The last coordinate, of its own mass, under a force that does not depend on it: with e its part of Δz it goes as
    far as by the midpoint rule, exactly, while the others go another way."""
    plain = step(1.0)
    mass = plain.system.mass.copy()
    mass[-1, :-1] = mass[:-1, -1] = 0.0
    plain = replace(plain, system=replace(plain.system, mass=mass))
    force = np.arange(1.0, SIZE + 1.0)
    by_rule = ended(plain, force)
    e = np.zeros(SIZE)
    e[-1] = by_rule.position[-1] - plain.state.position[-1]
    stretched = ended(replace(plain, stretch=stretch, unstretched=e), force)
    assert stretched.position[-1] == pytest.approx(by_rule.position[-1], rel=1e-13)
    assert np.abs(stretched.position[:-1] - by_rule.position[:-1]).min() > 1e-3


def test_second_order_on_an_oscillator() -> None:
    """m z̈ + d ż + k z = 0 from z = 1, ż = 0 against its closed solution: errors fall fourfold with half the step."""
    m, d, k, time = 2.0, 0.3, 50.0, 2.0
    system = LinearSystem(np.array([[m]]), np.array([d]), np.array([k]))
    δ = d / (2.0 * m)
    ω = np.sqrt(k / m - δ**2)
    exact = np.exp(-δ * time) * (np.cos(ω * time) + δ / ω * np.sin(ω * time))

    def error(count: int) -> float:
        state = KinematicState(np.array([1.0]), np.zeros(1), np.zeros(1))
        for _ in range(count):
            state = ended(MidpointStep(system, state, time / count, 1.0, np.zeros(1)), np.zeros(1))
        return abs(float(state.position[0]) - exact)

    errors = [error(count) for count in (200, 400, 800)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.1)


def test_nothing_moves_as_the_stretch_goes_to_zero() -> None:
    """The bodies stay where they are, and turn round: z_{n+1} → z_n, v_{n+1} → −v_n."""
    taken = step(1e-9)
    after = ended(taken, np.ones(SIZE))
    assert after.position == pytest.approx(taken.state.position, abs=1e-8)
    assert after.velocity == pytest.approx(-taken.state.velocity, abs=1e-7)
