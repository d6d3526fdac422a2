"""The period map and its branches against SciPy's integrator, which shares no code with them."""

from __future__ import annotations

import numpy as np
import pytest

from evidence.verification.references.time_integration import integrate
from evolvent.dynamics.oscillator import torsional_model
from evolvent.dynamics.oscillator.mesh_law import MeshLaw, behind, force_side, linear_side, mirrored
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel, history, period_map
from evolvent_meshes.arrays import Floats

MASS, STIFFNESS, LOAD, POSITIONS = 0.77e-3, 258.6e3, 2412.0, 20
NATURAL, STATIC = float(np.sqrt(STIFFNESS / MASS)), LOAD / STIFFNESS
PHASES = np.arange(POSITIONS) / POSITIONS


def wavy(amplitude: float) -> Floats:
    """Two mesh harmonics."""
    return amplitude * (np.cos(2.0 * np.pi * PHASES) + 0.4 * np.sin(4.0 * np.pi * PHASES))


def surface(damping_in_separation: bool = False, image: bool = False) -> TorsionalModel:
    """A force that stiffens with its depth and varies over the phase, on flanks with an error and backlash; the hardest
    blows go beyond the last depth. image: on back flanks that are the loaded ones' mirror image."""
    depths = STATIC * np.array([0.0, 0.2, 0.6, 1.2, 2.0, 4.0])
    force = STIFFNESS * np.outer(1.0 + wavy(0.15), depths) * (1.0 + 0.2 * np.tanh(depths / STATIC))
    front = force_side(depths, force, wavy(0.05 * STATIC))
    back = mirrored(front, 0.3, 3.0 * STATIC) if image else behind(front, 3.0 * STATIC)
    return TorsionalModel(MASS, LOAD, MeshLaw(front, back), 0.06 * MASS * NATURAL, damping_in_separation, 2e-3)


def linear() -> TorsionalModel:
    side = linear_side(STIFFNESS * (1.0 + wavy(0.2)), wavy(0.02 * STATIC))
    return TorsionalModel(MASS, LOAD, MeshLaw(side, behind(side, 6.0 * STATIC)), 0.04 * MASS * NATURAL)


START = {
    "in contact": (1.0, 0.05, {1}),
    "with free flight": (1.0, -2.5, {0, 1}),
    "with blows on both sides": (1.0, -7.0, {-1, 0, 1}),
}


MODELS = pytest.mark.parametrize(
    "model",
    [
        linear(), surface(), surface(damping_in_separation=True), surface(image=True),
        surface(damping_in_separation=True, image=True),
    ],
    ids=["k x", "F(x)", "damped apart", "mirrored", "mirrored, damped apart"],
)


@MODELS
@pytest.mark.parametrize("start", START)
def test_period_map_is_that_of_scipy(model: TorsionalModel, start: str) -> None:
    """State after three mesh periods in contact, with free flight, and with blows on both flanks: 1e-8 of the static
    deflection; 1e-7 where F(x) is a spline, whose knots SciPy's steps pass over."""
    s, v, sides = START[start]
    y, scale = np.array([s * STATIC, v * STATIC * NATURAL]), np.array([1.0, NATURAL]) * STATIC
    period = 2.0 * np.pi / (0.8 * NATURAL)
    found, seen = y, set()
    for _ in range(3):
        seen |= set(history(model, period, found, np.linspace(0.0, 1.0, 200)).side.tolist())
        found, _ = period_map(model, period, found)
    assert seen == sides
    accuracy = 1e-8 if len(model.law.front.depths) == 2 else 1e-7
    assert found / scale == pytest.approx(integrate(model, period, y, 3) / scale, abs=accuracy)


@MODELS
@pytest.mark.parametrize("start", START)
def test_steps_of_half_the_length_find_the_same(
    model: TorsionalModel, start: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """State and derivatives after a mesh period, 1e-10: steps end wherever the force is not smooth, so that their order
    is the whole error."""
    s, v, _ = START[start]
    y, period = np.array([s * STATIC, v * STATIC * NATURAL]), 2.0 * np.pi / (0.8 * NATURAL)
    scale = np.array([1.0, NATURAL]) * STATIC
    coarse = period_map(model, period, y)
    monkeypatch.setattr(torsional_model, "STEP", 0.5 * torsional_model.STEP)
    fine = period_map(model, period, y)
    assert coarse[0] / scale == pytest.approx(fine[0] / scale, abs=1e-10)
    assert coarse[1] / scale[:, None] == pytest.approx(fine[1] / scale[:, None], rel=1e-10, abs=1e-10)


@MODELS
@pytest.mark.parametrize("start", START)
def test_derivatives_of_the_period_map(model: TorsionalModel, start: str) -> None:
    """By s, ṡ and ln T against central differences, 2e-6 of their size: with jumps of the damping where flanks part."""
    s, v, _ = START[start]
    y, period = np.array([s * STATIC, v * STATIC * NATURAL]), 2.0 * np.pi / (0.8 * NATURAL)
    scale, small = np.array([1.0, NATURAL]) * STATIC, 1e-5
    exact = period_map(model, period, y)[1]
    for column, step in enumerate(np.vstack([np.diag(scale), np.zeros(2)])):
        lengths = period * np.exp(small * np.array([1.0, -1.0])) if column == 2 else np.array([period, period])
        ahead, before = (period_map(model, T, y + sign * small * step)[0] for T, sign in zip(lengths, (1.0, -1.0)))
        difference, size = (ahead - before) / (2.0 * small) / scale, scale[column] if column < 2 else 1.0
        accuracy = 2e-6 * max(1.0, float(np.abs(difference).max()))
        assert exact[:, column] * size / scale == pytest.approx(difference, abs=accuracy)


@pytest.mark.parametrize("speed", [2.5, 7.0])
def test_no_backlash(speed: float) -> None:
    """Both sides of the teeth one after the other, without free flight between, over three mesh periods: 1e-8."""
    side = linear_side(STIFFNESS * (1.0 + wavy(0.2)), wavy(0.02 * STATIC))
    model = TorsionalModel(MASS, LOAD, MeshLaw(side, behind(side, 0.0)), 0.04 * MASS * NATURAL)
    y, scale, period = np.array([STATIC, -speed * STATIC * NATURAL]), np.array([1.0, NATURAL]) * STATIC, 7.0 / NATURAL
    found = y
    for _ in range(3):
        path = history(model, period, found, np.linspace(0.0, 1.0, 200))
        assert path.back_contact_share > 0.1 and path.separated_share < 1e-12
        found, _ = period_map(model, period, found)
    assert found / scale == pytest.approx(integrate(model, period, y, 3) / scale, abs=1e-8)
