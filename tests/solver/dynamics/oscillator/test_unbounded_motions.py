"""A mesh whose stiffness varies, with weak damping and no backlash: its motions grow beyond measure at some speeds."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from evolvent.dynamics.oscillator.mesh_law import MeshLaw, behind, stepped_side
from evolvent.dynamics.oscillator.settling import Settled, settled, static_state
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep, sweep_speeds
from evolvent.dynamics.oscillator.steady_state import NoSteadyState, steady_state
from evolvent.dynamics.oscillator.torsional_model import BEYOND_MEASURE, TorsionalModel
from evolvent_meshes.arrays import Reals

MASS, STIFFNESS, LOAD, SHARE = 0.77e-3, 258.6e3, 2412.0, 0.3
NATURAL = float(np.sqrt(STIFFNESS / MASS))
LEVELS, DAMPING = STIFFNESS * np.array([1.6, 0.4]), 2.0 * 0.01 * MASS * NATURAL
RATIOS = np.linspace(0.5, 1.6, 45)


def meissner() -> TorsionalModel:
    """A stiffness of two levels, the same on both sides without backlash: a linear equation."""
    side = stepped_side(np.array([0.0, SHARE, 1.0]), LEVELS)
    return TorsionalModel(MASS, LOAD, MeshLaw(side, behind(side, 0.0)), DAMPING)


def multipliers(ratio: float) -> Reals:
    """Floquet's (2,) at a mesh frequency over the natural one: of two matrix exponentials."""
    whole = np.eye(2)
    for k, part in zip(LEVELS, (SHARE, 1.0 - SHARE)):
        matrix = np.array([[0.0, 1.0], [-k / MASS, -DAMPING / MASS]])
        whole = expm(part * 2.0 * np.pi / (ratio * NATURAL) * matrix) @ whole
    return np.linalg.eigvals(whole)


def largest(ratio: float) -> float:
    return float(np.abs(multipliers(ratio)).max())


def to_1(ratio: float) -> float:
    """(1 − λ_1)(1 − λ_2)."""
    return float(np.real(np.prod(1.0 - multipliers(ratio))))


@cache
def swept() -> SpeedSweep:
    return sweep_speeds(meissner(), 2.0 * np.pi / (RATIOS * NATURAL))


def test_motions_grow_where_multipliers_are_above_1() -> None:
    """At all speeds but those within 1 % of a border: the motion has escaped just where Floquet's multiplier is above
    1; elsewhere it is steady."""
    seen = set()
    for ratio in RATIOS:
        if len({largest(ratio * factor) > 1.0 for factor in (0.99, 1.0, 1.01)}) > 1:
            continue
        motion = settled(meissner(), 2.0 * np.pi / (ratio * NATURAL), static_state(meissner()))
        assert motion.escaped == (largest(ratio) > 1.0)
        assert motion.repeats == (0 if motion.escaped else 1)
        seen.add(motion.escaped)
    assert seen == {True, False}


def test_branch_ends_at_the_speeds_at_which_it_grows_beyond_measure() -> None:
    """Steady states of a linear equation become infinite where a multiplier is 1. Followed from below and from above
    the branch ends just before both of these speeds, 2 %; at its ends the states are beyond measure, and both ends are
    said. Between them the motion escapes."""
    branch = swept().branch
    lower, upper = brentq(to_1, 0.8, 0.825), brentq(to_1, 0.825, 0.85)
    (gap,) = branch.gaps
    below, above = 2.0 * np.pi / (NATURAL * branch.periods[[gap, gap + 1]])
    assert 0.98 * lower < below < lower < upper < above < 1.02 * upper
    assert all(meissner().escaped(branch.points[i].state) for i in (gap, gap + 1))
    assert len(branch.lost) == 2 and all(f"{BEYOND_MEASURE:g} times" in each for each in branch.lost)


def test_every_speed_has_its_motion() -> None:
    """Run up and down: steady on the branch where the exact multipliers are below 1, escaped where they are above, at
    all speeds but those within 2 % of a border."""
    for runs in (swept().up, swept().down):
        for ratio, run in zip(RATIOS, runs, strict=True):
            near = [largest(factor * ratio) > 1.0 for factor in (0.98, 0.99, 1.0, 1.01, 1.02)]
            if not any(near):
                assert run.repeats == 1 and run.place is not None
            elif all(near):
                assert run.repeats == 0 and isinstance(run.motion, Settled) and run.motion.escaped


def test_start_without_bounds_is_no_steady_state() -> None:
    """A start whose period overflows: said, not a fault of linear algebra."""
    with pytest.raises(NoSteadyState):
        steady_state(meissner(), 2.0 * np.pi / NATURAL, np.array([1e305, 1e308]))
