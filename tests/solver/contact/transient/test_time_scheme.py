"""The time scheme on linear systems."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.contact.transient.time_scheme import LinearSystem, MotionState, TimeScheme, TimeStep

MASS, DAMPING, STIFFNESS = 2.0, 0.3, 50.0


def steps(spectral_radius: float, count: int, time: float) -> MotionState:
    """The forced oscillator m z̈ + d ż + k z = sin 3t from z = 1, ż = 0 after equal steps."""
    system = LinearSystem(np.array([[MASS]]), np.array([DAMPING]), np.array([STIFFNESS]))
    state = MotionState(np.array([1.0]), np.array([0.0]), np.array([-STIFFNESS / MASS]))
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
        state = MotionState(start[:1], start[1:2] / h, start[2:] / h**2)
        step = TimeStep(system, TimeScheme(spectral_radius), state, h)
        after = step.after(np.linalg.solve(step.matrix, step.known))
        columns.append([after.position[0], h * after.velocity[0], h**2 * after.acceleration[0]])
    # the three-step matrix is defective at ρ_∞: its eigenvalues scatter by the square root of rounding
    found = np.abs(np.linalg.eigvals(np.array(columns).T)).max()
    assert found == pytest.approx(spectral_radius, abs=2e-3)
