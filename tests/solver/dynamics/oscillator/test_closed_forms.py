"""The oscillator where its motion is known exactly."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from evolvent.dynamics.oscillator.mesh_law import MeshLaw, behind, linear_side, no_side, stepped_side
from evolvent.dynamics.oscillator.steady_state import steady_state
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel, history, period_map
from evolvent_meshes.arrays import Floats

MASS, STIFFNESS, LOAD = 0.77e-3, 258.6e3, 2412.0
NATURAL = float(np.sqrt(STIFFNESS / MASS))
STATIC = LOAD / STIFFNESS
KNOTS = 512  # of splines through a cosine: its interpolation error is 1e-10


def model(stiffness: Floats | float = STIFFNESS, error: Floats | float = 0.0, damping: float = 0.0) -> TorsionalModel:
    """Unlimited backlash; stiffness and error over the phase, at KNOTS equidistant phases."""
    k, e = np.broadcast_to(stiffness, KNOTS), np.broadcast_to(error, KNOTS)
    return TorsionalModel(MASS, LOAD, MeshLaw(linear_side(k, e), no_side()), damping)


def cosine(amplitude: float) -> Floats:
    return amplitude * np.cos(2.0 * np.pi * np.arange(KNOTS) / KNOTS)


@pytest.mark.parametrize("ratio", [0.11, 0.97, 2.6])
@pytest.mark.parametrize("share", [0.03, 0.3])
def test_free_vibration(share: float, ratio: float) -> None:
    """s = s_0 + A e^(−ζωt) cos(ω_d t), touching all the time, after a mesh period of any length: 1e-11 of s_0."""
    one = model(damping=2.0 * share * MASS * NATURAL)
    period, amplitude, damped = 2.0 * np.pi / (ratio * NATURAL), 0.7 * STATIC, NATURAL * np.sqrt(1.0 - share**2)
    rate = share * NATURAL
    after, _ = period_map(one, period, np.array([STATIC + amplitude, -rate * amplitude]))
    decay = amplitude * np.exp(-rate * period)
    s = STATIC + decay * np.cos(damped * period)
    v = -decay * (rate * np.cos(damped * period) + damped * np.sin(damped * period))
    assert after == pytest.approx([s, v], abs=1e-11 * STATIC * NATURAL, rel=1e-11)
    assert after[0] == pytest.approx(s, abs=1e-11 * STATIC)


@pytest.mark.parametrize("ratio", [0.2, 0.5, 0.98, 1.4])
def test_forced_vibration(ratio: float) -> None:
    """e = A cos τ on a constant stiffness: s − s_0 = Re[A (k + iωc) / (k − mω² + iωc) e^iωt], 1e-8 of s_0."""
    damping, amplitude, ω = 2.0 * 0.03 * MASS * NATURAL, 0.02 * STATIC, ratio * NATURAL
    one = model(error=cosine(amplitude), damping=damping)
    found = steady_state(one, 2.0 * np.pi / ω, np.array([STATIC, 0.0]))
    path = history(one, found.period, found.state)
    response = amplitude * (STIFFNESS + 1j * ω * damping) / (STIFFNESS - MASS * ω**2 + 1j * ω * damping)
    exact = STATIC + np.real(response * np.exp(2j * np.pi * path.phases))
    assert path.displacement == pytest.approx(exact, abs=1e-8 * STATIC)
    assert not path.separated.any()


@pytest.mark.parametrize(("amplitude", "ratio"), [(1.5, 0.918982), (2.0, 0.821021), (3.0, 0.662915)])
def test_backbone_with_free_flight(amplitude: float, ratio: float) -> None:
    """m ẍ + k x₊ = F, undamped, from the amplitude A x₀: the period is that of
    ω/ω₀ = π/[π − arccos(1/A) + √(A² − 1)], to 1e-8."""
    exact = np.pi / (np.pi - np.arccos(1.0 / amplitude) + np.sqrt(amplitude**2 - 1.0))
    assert exact == pytest.approx(ratio, abs=5e-7)
    one, start = model(), np.array([STATIC * (1.0 + amplitude), 0.0])

    def velocity(factor: float) -> float:
        return float(period_map(one, factor * 2.0 * np.pi / (exact * NATURAL), start)[0][1])

    assert brentq(velocity, 0.95, 1.05, xtol=1e-13) == pytest.approx(1.0, abs=1e-8)
    assert history(one, 2.0 * np.pi / (exact * NATURAL), start).separated_share > 0.0


MEISSNER = [(0.6, 0.5, 2.6), (0.35, 0.3, 2.0), (0.2, 0.7, 1.5)]


@pytest.mark.parametrize(("swing", "share", "ratio"), MEISSNER)
def test_meissner_equation(swing: float, share: float, ratio: float) -> None:
    """A stiffness of two levels: derivatives and steady state are those of two matrix exponentials, to 1e-8."""
    levels, parts = STIFFNESS * (1.0 + swing * np.array([1.0, -1.0])), np.array([share, 1.0 - share])
    damping, period = 2.0 * 0.02 * MASS * NATURAL, 2.0 * np.pi / (ratio * NATURAL)
    law = MeshLaw(stepped_side(np.array([0.0, share, 1.0]), levels), no_side())
    one = TorsionalModel(MASS, LOAD, law, damping)
    whole = np.eye(3)
    for k, part in zip(levels, parts):
        matrix = np.array([[0.0, 1.0, 0.0], [-k / MASS, -damping / MASS, LOAD / MASS], [0.0, 0.0, 0.0]])
        whole = expm(part * period * matrix) @ whole
    exact = np.linalg.solve(np.eye(2) - whole[:2, :2], whole[:2, 2])
    found = steady_state(one, period, np.array([STATIC, 0.0]))
    scale = np.array([1.0, NATURAL])
    assert not history(one, period, found.state).separated.any()
    assert found.state / scale == pytest.approx(exact / scale, abs=1e-8 * STATIC)
    assert found.derivatives[:, :2] / np.outer(scale, 1.0 / scale) == pytest.approx(
        whole[:2, :2] / np.outer(scale, 1.0 / scale), abs=1e-8
    )


@pytest.mark.parametrize("swing", [0.2, 0.6])
def test_borders_of_instability_of_meissners_equation(swing: float) -> None:
    """Undamped, equal parts: unstable between the speeds at which |cos α cos β − (α/β + β/α)/2 sin α sin β| = 1, the
    half trace of both exponentials with α, β = ω_i T/2. Both borders of the first tongue, to 1e-8 of the speed."""
    levels = STIFFNESS * (1.0 + swing * np.array([1.0, -1.0]))
    law = MeshLaw(stepped_side(np.array([0.0, 0.5, 1.0]), levels), no_side())
    one, touching = TorsionalModel(MASS, 1e9 * LOAD, law), np.array([1e9 * STATIC, 0.0])

    def exact(ratio: float) -> float:
        α, β = np.sqrt(levels / MASS) * np.pi / (ratio * NATURAL)
        return float(np.cos(α) * np.cos(β) - 0.5 * (α / β + β / α) * np.sin(α) * np.sin(β)) + 1.0

    def found(ratio: float) -> float:
        return 0.5 * float(np.trace(period_map(one, 2.0 * np.pi / (ratio * NATURAL), touching)[1][:, :2])) + 1.0

    for inside, outside in ((2.0, 1.6), (2.0, 2.6)):
        assert exact(inside) < 0.0 < exact(outside)
        border = brentq(exact, inside, outside, xtol=1e-12)
        assert brentq(found, inside, outside, xtol=1e-12) == pytest.approx(border, rel=1e-8)


@pytest.mark.parametrize("ratio", [0.7, 0.95, 1.2])
def test_onset_of_separation(ratio: float) -> None:
    """Constant stiffness, harmonic e: the flanks part where the amplitude mω²A/|k − mω² + iωc| of x is x₀, to 1e-6."""
    ω, damping = ratio * NATURAL, 2.0 * 0.05 * MASS * NATURAL
    exact = STATIC * abs(STIFFNESS - MASS * ω**2 + 1j * ω * damping) / (MASS * ω**2)
    for factor, parts in ((1.0 - 1e-6, False), (1.0 + 1e-6, True)):
        one = model(error=cosine(factor * exact), damping=damping)
        response = factor * exact * (STIFFNESS + 1j * ω * damping) / (STIFFNESS - MASS * ω**2 + 1j * ω * damping)
        start = np.array([STATIC + response.real, -ω * response.imag])
        found = steady_state(one, 2.0 * np.pi / ω, start)
        assert (history(one, found.period, found.state).separated_share > 0.0) == parts


@pytest.mark.parametrize("speed", [0.0, 1.2, 3.0])
def test_energy_with_free_flight_and_both_flanks(speed: float) -> None:
    """Constant stiffness, undamped: ½mv² + ½k x₊² + ½k (−x − j)₊² − F x, j the backlash, stays over 1000 mesh periods,
    to 1e-8; in contact, with free flight, and with blows on the back flanks."""
    front, backlash = linear_side(np.full(4, STIFFNESS), np.zeros(4)), 0.5 * STATIC
    one = TorsionalModel(MASS, LOAD, MeshLaw(front, behind(front, backlash)))
    y = np.array([1.2 * STATIC, speed * STATIC * NATURAL])

    def energy(state: Floats) -> float:
        x, v = state
        spring = max(x, 0.0) ** 2 + max(-x - backlash, 0.0) ** 2
        return float(0.5 * MASS * v**2 + 0.5 * STIFFNESS * spring - LOAD * x)

    begin, sides = energy(y), set()
    for count in range(1000):
        if count < 20:
            sides |= set(history(one, 1.0 / NATURAL, y, np.linspace(0.0, 1.0, 9)).side.tolist())
        y = period_map(one, 1.0 / NATURAL, y)[0]
        scale = abs(begin) + LOAD * STATIC
        assert abs(energy(y) - begin) < 1e-8 * scale
    assert sides == {0.0: {1}, 1.2: {0, 1}, 3.0: {-1, 0, 1}}[speed]


def test_work_and_energy_of_a_varying_stiffness() -> None:
    """E(t) − E(0) − ∫½ k̇ x² dt − ∫F v dt + ∫c v² dt = 0 over 1000 mesh periods, to 1e-8 of the work of the load, by
    Gauss' rule in each interval of k(t), which is a cubic there (Oh, Grosh and Barber 2005)."""
    intervals, share = 16, 0.01
    k = STIFFNESS * (1.0 + 0.3 * np.cos(2.0 * np.pi * np.arange(intervals) / intervals))
    side = linear_side(k, np.zeros(intervals))
    one = TorsionalModel(MASS, LOAD, MeshLaw(side, no_side()), 2.0 * share * MASS * NATURAL)
    nodes, weights = np.polynomial.legendre.leggauss(10)
    phases = (side.phases[:-1, None] + (nodes + 1.0) / (2.0 * intervals)).ravel()
    t = (phases - np.repeat(side.phases[:-1], len(nodes)))[:, None]
    c = np.repeat(side.force[:, 0, 1, :], len(nodes), axis=0)
    stiffness, slope = (c * t ** np.arange(4)).sum(axis=1), (c[:, 1:] * np.arange(1, 4) * t ** np.arange(3)).sum(axis=1)
    assert stiffness.min() < 0.75 * STIFFNESS
    period, y = 2.0 * np.pi / (1.5 * NATURAL), np.array([1.5 * STATIC, 0.0])
    rule, balance, work = period * np.tile(weights, intervals) / (2.0 * intervals), 0.0, 0.0

    def energy(state: Floats) -> float:
        return float(0.5 * MASS * state[1] ** 2 + 0.5 * side.force[0, 0, 1, 0] * state[0] ** 2)

    begin = energy(y)
    for _ in range(1000):
        path = history(one, period, y, phases)
        at = np.searchsorted(path.phases, phases - 1e-12)
        s, v = path.displacement[at], path.velocity[at]
        assert np.abs(path.phases[at] - phases).max() < 1e-12 and not path.separated.any()
        balance += rule @ (0.5 * slope / period * s**2 + LOAD * v - one.damping * v**2)
        work += rule @ np.abs(LOAD * v)
        y = np.array([path.displacement[-1], path.velocity[-1]])
    assert abs(energy(y) - begin - balance) < 1e-8 * work
