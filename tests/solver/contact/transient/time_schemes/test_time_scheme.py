"""The time scheme: on linear systems, and with contact that stays closed."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent import (
    Body,
    Contact,
    Fixed,
    InitialState,
    Material,
    Problem,
    Step,
    Traction,
    Transient,
    TransientSettings,
)
from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, LinearSystem, TimeScheme, TimeStep
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import rectangle

MASS, DAMPING, STIFFNESS = 2.0, 0.3, 50.0


def steps(spectral_radius: float, count: int, time: float) -> KinematicState:
    """The forced oscillator m z̈ + d ż + k z = sin 3t from z = 1, ż = 0 after equal steps."""
    system = LinearSystem(np.array([[MASS]]), np.array([DAMPING]), np.array([STIFFNESS]))
    state = KinematicState(np.array([1.0]), np.array([0.0]), np.array([-STIFFNESS / MASS]))
    h = time / count
    for n in range(1, count + 1):
        step = TimeStep(system, TimeScheme(spectral_radius), state, h)
        state = step.after(np.linalg.solve(step.matrix, np.sin([3.0 * n * h]) + step.known))
    return state


def exact(time: float) -> float:
    """z of this oscillator."""
    drive = 1.0 / complex(STIFFNESS - MASS * 9.0, DAMPING * 3.0)
    δ = DAMPING / (2.0 * MASS)
    ω = np.sqrt(STIFFNESS / MASS - δ**2)
    first, rate = 1.0 - drive.imag, -3.0 * drive.real
    second = (rate + δ * first) / ω
    forced = (drive * np.exp(3j * time)).imag
    return float(forced + np.exp(-δ * time) * (first * np.cos(ω * time) + second * np.sin(ω * time)))


@pytest.mark.parametrize("spectral_radius", [0.0, 0.5, 0.8, 1.0])
def test_second_order_on_a_forced_oscillator(spectral_radius: float) -> None:
    """m z̈ + d ż + k z = sin 3t against its closed solution: errors fall fourfold when the step is halved."""
    errors = [abs(steps(spectral_radius, n, 2.0).position[0] - exact(2.0)) for n in (200, 400, 800)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("spectral_radius", [0.0, 0.5, 0.8])
def test_motions_too_fast_for_the_step_fall_by_the_spectral_radius(spectral_radius: float) -> None:
    """An undamped oscillator at ωh = 1e5: the amplification matrix of (z, hv, h²a) has ρ_∞ for its spectral radius."""
    h = 1.0
    system = LinearSystem(np.eye(1), np.zeros(1), np.array([1e10]))
    columns = []
    for start in np.eye(3):
        state = KinematicState(start[:1], start[1:2] / h, start[2:] / h**2)
        step = TimeStep(system, TimeScheme(spectral_radius), state, h)
        after = step.after(np.linalg.solve(step.matrix, step.known))
        columns.append([after.position[0], h * after.velocity[0], h**2 * after.acceleration[0]])
    # the three-step matrix is defective at ρ_∞: its eigenvalues scatter by the square root of rounding
    found = np.abs(np.linalg.eigvals(np.array(columns).T)).max()
    assert found == pytest.approx(spectral_radius, abs=2e-3)


def test_second_order_with_contact_that_stays_closed() -> None:
    """A block pressed on another one by a traction that rises and falls smoothly within 40 µs, three modes each, from
    statics: velocity, force and displacements at the end, against 256 steps. The error of 32 steps is four times that
    of 64."""

    def at_the_end(count: int) -> Floats:
        steel = Material(210e3, 0.3)
        load = (Traction("top", (0.0, -100.0)),)
        upper = Body(rectangle(10.0, 10.0, 3, 3, origin=(0.0, 10.0)), steel, (Fixed("left", "x"),), load)
        lower = Body(rectangle(10.0, 10.0, 2, 2), steel, (Fixed("left", "x"), Fixed("bottom")))
        problem = Problem((upper, lower), (Contact((0, "bottom"), (1, "top")),))
        run = Transient(problem, TransientSettings(4e-5 / count, 3, 0.02), InitialState(Step()))
        shares = 1.0 + 0.3 * np.sin(np.pi * np.arange(1, count + 1) / count) ** 4
        moments = list(run.run([Step(float(share)) for share in shares]))
        assert all((moment.solution.contacts[0].pressure > 0.0).all() for moment in moments)
        last = moments[-1].solution
        return np.concatenate(
            [moments[-1].velocities[0] / 100.0, last.contacts[0].force / 1e3, 1e3 * last.displacement(0).ravel()]
        )

    exact = at_the_end(256)
    coarse, fine = (np.linalg.norm(at_the_end(count) - exact) for count in (32, 64))
    assert coarse < 0.03 * np.linalg.norm(exact)
    assert np.log2(coarse / fine) == pytest.approx(2.05, abs=0.15)  # 2.07 for the error of the reference itself
