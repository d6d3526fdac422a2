"""Branches over the speed, their folds, and what a pair does that runs up and down."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from evidence.verification.references.time_integration import integrate
from evolvent.dynamics.oscillator import speed_sweep
from evolvent.dynamics.oscillator.continuation import Branch
from evolvent.dynamics.oscillator.mesh_law import MeshLaw, linear_side, no_side
from evolvent.dynamics.oscillator.mesh_speed import speeds_to_periods
from evolvent.dynamics.oscillator.settling import settled
from evolvent.dynamics.oscillator.speed_sweep import OnBranch, Running, SpeedSweep, sweep_speeds
from evolvent.dynamics.oscillator.steady_state import NoSteadyState, SteadyState, steady_state
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel, history

MASS, STIFFNESS, LOAD, TEETH = 0.77e-3, 258.6e3, 2412.0, 50
NATURAL, STATIC = float(np.sqrt(STIFFNESS / MASS)), LOAD / STIFFNESS
RESONANCE = NATURAL / (2.0 * np.pi) * 60.0 / TEETH


def softening(swing: float, share: float = 0.03) -> TorsionalModel:
    """Stiffness with one harmonic: flanks part near resonance, which leans to lower speeds."""
    k = STIFFNESS * (1.0 + swing * np.cos(2.0 * np.pi * np.arange(16) / 16))
    return TorsionalModel(MASS, LOAD, MeshLaw(linear_side(k, np.zeros(16)), no_side()), 2.0 * share * MASS * NATURAL)


@cache
def swept() -> SpeedSweep:
    speeds = np.linspace(0.6, 1.3, 141) * RESONANCE
    return sweep_speeds(softening(0.15), speeds_to_periods(speeds, TEETH))


def fold_speeds(branch: Branch) -> list[float]:
    return [60.0 / (TEETH * branch.points[i].period) for i in branch.folds]


def test_resonance_leans_to_lower_speeds() -> None:
    """Two folds; between them three steady states, stable, unstable, stable; elsewhere one."""
    found = swept()
    down, up = sorted(fold_speeds(found.branch))
    speeds = 60.0 / (TEETH * found.periods)
    assert 0.6 * RESONANCE < down < up < RESONANCE
    for speed, states in zip(speeds, found.coexisting):
        stable = [each.state.stable for each in states]
        assert stable == ([True, False, True] if down < speed < up else [True])
    jumps = [[speeds[i] for i, motion in enumerate(runs) if motion.jumped] for runs in (found.up, found.down)]
    assert [len(each) for each in jumps] == [1, 1]
    assert 0.0 <= jumps[0][0] - up < speeds[1] - speeds[0]
    assert 0.0 <= down - jumps[1][0] < speeds[1] - speeds[0]


def test_jumps_are_at_the_folds() -> None:
    """Running up the pair leaves the branch at the upper fold, running down at the lower one: exactly those mesh
    periods, wherever the speeds of the sweep are."""
    found = swept()
    down, up = sorted(fold_speeds(found.branch))
    left = [[60.0 / (TEETH * run.left_at) for run in runs if run.left_at] for runs in (found.up, found.down)]
    assert left == [[pytest.approx(up, rel=1e-12)], [pytest.approx(down, rel=1e-12)]]


def test_a_motion_that_doubles_its_period_leaves_without_a_fold() -> None:
    """Near twice the resonance a stiffness that varies by a quarter makes the steady state lose its stability by a
    multiplier of −1. Where the pair leaves the branch, both ways, the multipliers of the steady states 1e-6 of the
    speed before and behind are below and above 1 in size; the motion beyond repeats after two meshes."""
    model, speeds = softening(0.25), np.linspace(1.5, 2.6, 56) * RESONANCE
    found = sweep_speeds(model, speeds_to_periods(speeds, TEETH))
    for runs in (found.up, found.down[::-1]):
        (at,) = [i for i, run in enumerate(runs) if run.jumped]
        before, run = runs[at - 1], runs[at]
        assert run.repeats == 2 and run.left_at is not None
        state, inside = before.motion.state, []
        for factor in (-1e-6, 1e-6):
            one = steady_state(model, run.left_at * (1.0 + factor), state)
            inside.append(float(np.abs(one.multipliers).max()) < 1.0)
        assert sorted(inside) == [False, True]


@pytest.mark.parametrize("window", [(0.6, 0.9), (0.9, 1.3)], ids=["ends in the fold", "begins in it"])
def test_speeds_within_a_fold_have_all_motions(window: tuple[float, float]) -> None:
    """Speeds of which one end lies between both folds: with the branch followed beyond them each has the motions of the
    whole sweep, and a pair that runs down from within is on the upper one. 1e-8 of the deflection."""
    whole = swept()
    speeds = 60.0 / (TEETH * whole.periods)
    inside = (speeds >= window[0] * RESONANCE) & (speeds <= window[1] * RESONANCE)
    ends = float(whole.periods[0]), float(whole.periods[-1])
    found = sweep_speeds(softening(0.15), whole.periods[inside], ends)
    down, up = sorted(fold_speeds(whole.branch))
    assert down < window[0] * RESONANCE < up or down < window[1] * RESONANCE < up
    scale = np.array([1.0, NATURAL]) * STATIC
    for one, other in zip(found.coexisting, np.array(whole.coexisting, dtype=object)[inside]):
        assert [each.state.stable for each in one] == [each.state.stable for each in other]
    for way in ("up", "down"):
        whole_runs = [run for run, kept in zip(getattr(whole, way), inside) if kept]
        for one, other in zip(getattr(found, way), whole_runs):
            assert one.motion.state / scale == pytest.approx(other.motion.state / scale, abs=1e-8)


def test_steady_states_repeat_by_scipy() -> None:
    """One more mesh period by SciPy's integrator leads back to each state, stable or not, to 1e-8 of the deflection."""
    model, found, scale = softening(0.15), swept(), np.array([1.0, NATURAL]) * STATIC
    for states in found.coexisting[::7]:
        for each in states:
            after = integrate(model, each.state.period, each.state.state)
            assert after / scale == pytest.approx(each.state.state / scale, abs=1e-8)


def test_folds_are_where_slow_sweeps_jump() -> None:
    """Time integration at steps of 1 r/min, each from the last one's end: it jumps within 2 r/min of the folds."""
    model, found = softening(0.15), swept()
    for fold, step in ((max(fold_speeds(found.branch)), 1.0), (min(fold_speeds(found.branch)), -1.0)):
        speeds = fold + step * np.arange(-12.0, 6.0)
        i = int(np.argmin(np.abs(60.0 / (TEETH * found.periods) - speeds[0])))
        state = (found.up if step > 0.0 else found.down)[i].motion.state
        sizes = []
        for speed in speeds:
            period = 60.0 / (TEETH * speed)
            state = settled(model, period, state).state
            sizes.append(np.ptp(history(model, period, state, np.linspace(0.0, 1.0, 100)).displacement))
        jump = int(np.argmax(np.abs(np.diff(sizes)))) + 1
        assert abs(speeds[jump] - fold) <= 2.0
        assert np.abs(np.diff(sizes)).max() > 5.0 * np.sort(np.abs(np.diff(sizes)))[-2]


def test_multipliers_of_a_linear_oscillator() -> None:
    """Of a constant stiffness without separation: e^(−ζωT ± iω_d T), 1e-10."""
    share, period = 0.03, 2.0 * np.pi / (0.9 * NATURAL)
    found: SteadyState = steady_state(softening(0.0, share), period, np.array([STATIC, 0.0]))
    exact = np.exp(NATURAL * period * (-share + 1j * np.sqrt(1.0 - share**2)))
    multipliers = sorted(found.multipliers, key=lambda μ: float(np.imag(μ)))
    assert sorted([exact, exact.conjugate()], key=lambda μ: float(np.imag(μ))) == pytest.approx(multipliers, abs=1e-10)
    assert found.stable


@pytest.mark.parametrize("rising", [True, False])
def test_a_branch_that_cannot_be_followed_further_is_left_at_its_end(rising: bool) -> None:
    """Mesh periods of 5, 4 and 3 s, and 1 and 0.5 s of a piece that is not connected, with an unstable state on it
    at 2 s: a pair that follows the first piece from 4.5 s leaves it at 3 s, one that comes down from 0.7 s at 1 s."""

    def state(period: float, growth: float) -> SteadyState:
        return SteadyState(period, np.zeros(2), np.diag([growth, 0.5])[:, [0, 1, 1]])

    branch = Branch(tuple(state(period, 0.5) for period in (5.0, 4.0, 3.0, 1.0, 0.5)), (), gaps=(2,))
    known = speed_sweep._Steady.__new__(speed_sweep._Steady)
    known.branch, known.periods = branch, np.array([4.5, 2.0])
    known.model, known.coexisting = softening(0.1), [[], [OnBranch(1.5 if not rising else 3.5, state(2.0, 1.5))]]
    before = Running(state(4.5, 0.5), 0.5, None) if rising else Running(state(0.7, 0.5), 3.6, None)
    assert speed_sweep._left_at(known, before, 1, rising) == (3.0 if rising else 1.0)


def test_each_motion_is_shown_once_it_is_known() -> None:
    """Five speeds, both ways: ten calls."""
    shown: list[None] = []
    speeds = speeds_to_periods(np.linspace(0.6, 1.3, 5) * RESONANCE, TEETH)
    sweep_speeds(softening(0.15), speeds, computed=lambda: shown.append(None))
    assert len(shown) == 10


@pytest.mark.parametrize(("teeth", "place"), [(TEETH, "2000 r/min"), (None, "a mesh period of 0.0006 s")])
def test_messages_name_the_speed_of_the_pinion(teeth: int | None, place: str) -> None:
    """A start from which Newton's method finds nothing: the message says at which speed, where the teeth are known. The
    mesh period stands in no file of the user's."""
    with pytest.raises(NoSteadyState, match=f"steady state at {place}:"):
        steady_state(replace(softening(0.15), teeth=teeth), 6e-4, np.full(2, np.nan))
