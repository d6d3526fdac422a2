"""Branches of steady states that are hard to follow: in pieces, with narrow resonances, with folds close together."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.oscillator.continuation import follow
from evolvent.dynamics.oscillator.mesh_law import MeshLaw, behind, linear_side, no_side, stepped_side
from evolvent.dynamics.oscillator.speed_sweep import OnBranch, sweep_speeds
from evolvent.dynamics.oscillator.steady_state import SteadyState, damped_less, steady_state
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel, history
from evolvent_meshes.arrays import Floats

MASS, STIFFNESS, LOAD, KNOTS = 0.77e-3, 258.6e3, 2412.0, 64
NATURAL, STATIC = float(np.sqrt(STIFFNESS / MASS)), LOAD / STIFFNESS
SCALE = STATIC * np.array([1.0, NATURAL])


def softening(swing: float, share: float) -> TorsionalModel:
    """Stiffness with one harmonic: flanks part near resonance, which leans to lower speeds."""
    k = STIFFNESS * (1.0 + swing * np.cos(2.0 * np.pi * np.arange(16) / 16))
    return TorsionalModel(MASS, LOAD, MeshLaw(linear_side(k, np.zeros(16)), no_side()), 2.0 * share * MASS * NATURAL)


def periods(*ratios: float) -> Floats:
    """[s] at mesh frequencies over the natural one."""
    return 2.0 * np.pi / (np.array(ratios) * NATURAL)


def test_branch_that_turns_back_is_taken_up_from_the_other_end() -> None:
    """Speeds that begin between both folds: from below the branch turns back to where it began, from above it comes to
    the upper motion there. Together they are the three motions at each speed below the upper fold that the branch has
    which begins far below: 1e-8."""
    model, ratios = softening(0.15, 0.03), np.linspace(0.86, 1.2, 18)
    found = sweep_speeds(model, periods(*ratios))
    whole = sweep_speeds(model, periods(*ratios), (float(periods(0.6)[0]), float(periods(1.3)[0])))
    assert found.branch.gaps and not whole.branch.gaps
    assert max(map(len, whole.coexisting)) == 3

    def states(coexisting: tuple[OnBranch, ...]) -> list[list[float]]:
        return sorted((each.state.state / SCALE).tolist() for each in coexisting)

    for one, other in zip(found.coexisting, whole.coexisting, strict=True):
        assert np.array(states(one)) == pytest.approx(np.array(states(other)), abs=1e-8)
    for run, other_run in zip((*found.up, *found.down), (*whole.up, *whole.down), strict=True):
        assert run.motion.state / SCALE == pytest.approx(other_run.motion.state / SCALE, abs=1e-8)


@pytest.mark.parametrize("share", [0.001, 0.003])
def test_narrow_resonance_is_not_stepped_over(share: float) -> None:
    """Constant stiffness and the fifth harmonic of an unloaded error: the largest amplitude on the branch around a
    fifth of the resonance is within 30 % of the exact one, e_5/(2ζ), a hundredth of the static deflection; a width of
    the resonance away half of it is left."""
    error = 0.02 * share * STATIC * np.cos(10.0 * np.pi * np.arange(KNOTS) / KNOTS)
    law = MeshLaw(linear_side(np.full(KNOTS, STIFFNESS), error), no_side())
    model = TorsionalModel(MASS, LOAD, law, 2.0 * share * MASS * NATURAL)
    begin, end = periods(0.19, 0.21)
    start: SteadyState = steady_state(model, float(begin), np.array([STATIC, 0.0]))
    branch = follow(model, start, float(end))
    size = [np.linalg.norm(point.state / SCALE - (1.0, 0.0)) for point in branch.points]
    assert max(size) == pytest.approx(0.01, rel=0.3)


def test_folds_close_to_each_other_are_found_from_both_ends() -> None:
    """A stiffness of four levels, weak damping and a backlash of a twentieth of the static deflection: at half and a
    fifth of the resonance the branch turns back and forth within 0.4 % and less of the speed. Followed up and followed
    down it has the same eight folds, 1e-9 of the speed."""
    levels = STIFFNESS * np.array([1.0, 0.93229711, 0.95771176, 0.89809197])
    side = stepped_side(np.array([0.0, 0.3344546, 0.40323408, 0.89703048, 1.0]), levels)
    law, c = MeshLaw(side, behind(side, 0.047852 * STATIC)), 2.0 * MASS * NATURAL
    model = TorsionalModel(MASS, LOAD, law, 0.00662335 * c, False, 0.00113106 * c)
    begin, end = (float(period) for period in np.array([38.39721793, 3.9997102]) / NATURAL)
    up = follow(model, steady_state(model, begin, np.array([STATIC, 0.0])), end)
    down = follow(model, up.points[-1], begin)
    one, other = up.periods[list(up.folds)], down.periods[list(down.folds)][::-1]
    assert len(one) == 8
    assert one == pytest.approx(other, rel=1e-9)


@pytest.mark.parametrize("swing", [0.6, 1.2])
def test_branch_with_corners(swing: float) -> None:
    """The harmonic of an unloaded error, begun at four phases: where flanks touch or part just at phase 0 the damper
    sets in or ends, and the state there has a corner over the speed. Each branch comes to its end, where the motions
    are one that is begun at other phases: s at 64 phases, 1e-8 of the deflection."""
    ends = []
    for phase in (0.0, 0.125, 0.25, 0.375):
        error = swing * STATIC * np.cos(2.0 * np.pi * (np.arange(KNOTS) / KNOTS - phase))
        law = MeshLaw(linear_side(np.full(KNOTS, STIFFNESS), error), no_side())
        model = TorsionalModel(MASS, LOAD, law, 0.4 * MASS * NATURAL)
        begin, end = (float(period) for period in periods(0.3, 1.6))
        branch = follow(model, steady_state(model, begin, np.array([STATIC, 0.0])), end)
        assert not branch.lost
        path = history(model, end, branch.points[-1].state, np.arange(KNOTS) / KNOTS)
        at = np.searchsorted(path.phases, (np.arange(KNOTS) / KNOTS + phase) % 1.0 - 1e-12)
        ends.append(path.displacement[at] / STATIC)
    assert ends[0] == pytest.approx(ends[1], abs=1e-8)
    assert ends[0] == pytest.approx(ends[2], abs=1e-8)
    assert ends[0] == pytest.approx(ends[3], abs=1e-8)


def test_steady_state_without_a_start_nearby() -> None:
    """Twice the natural speed, where a strongly varying stiffness shakes the pair at half of it: the motion that
    repeats with the mesh is found, and a real multiplier below −1."""
    model, period = softening(0.6, 0.02), float(periods(2.0)[0])
    found = damped_less(model, period, np.array([STATIC, 0.0]))
    assert not found.stable
    assert np.real(found.multipliers).min() < -1.0
