"""The mesh force as piecewise polynomials: what it goes through, and the sides that are made of it."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.oscillator.equation import force_at, interval_at, offset_at
from evolvent.dynamics.oscillator.mesh_law import (
    Jammed,
    MeshLaw,
    MeshSide,
    backwards,
    behind,
    force_side,
    linear_side,
    mirrored,
    no_side,
)

DEPTHS = np.array([0.0, 0.5, 1.2, 2.0])
PHASES = np.arange(8) / 8
ERROR = 0.1 * np.cos(2.0 * np.pi * PHASES) + 0.05 * np.sin(4.0 * np.pi * PHASES)
FORCE = np.outer(1.0 + 0.3 * np.sin(2.0 * np.pi * PHASES), DEPTHS * (1.0 + 0.2 * DEPTHS))


def side() -> MeshSide:
    return force_side(DEPTHS, FORCE, ERROR)


def at(one: MeshSide, τ: float, x: float) -> tuple[float, float, float]:
    """F, ∂F/∂x and e at a phase from 0 to 1."""
    cell = min(int(np.searchsorted(one.phases, τ, side="right")) - 1, len(one.phases) - 2)
    return (*force_at(one, cell, interval_at(one, x), τ, x), offset_at(one, cell, τ)[0])


def test_force_side_goes_through_its_values() -> None:
    """F and e at their knots, 1e-14; no force without depth; straight on beyond the last depth, without a step."""
    for i, τ in enumerate(PHASES):
        for j, x in enumerate(DEPTHS):
            force, _, error = at(side(), float(τ), float(x))
            assert (force, error) == pytest.approx((FORCE[i, j], ERROR[i]), abs=1e-14)
        force, slope, _ = at(side(), float(τ), 2.0)
        assert at(side(), float(τ), 5.0)[:2] == pytest.approx((force + 3.0 * slope, slope), rel=1e-12)
    assert at(side(), 0.37, 0.0)[0] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("meeting", [0.0, 0.31, 0.77, 1.4])
def test_mirrored_side_has_the_mirrored_phase(meeting: float) -> None:
    """F and e at τ are those at `meeting` − τ, e with the backlash, at 50 phases: 1e-13."""
    found = mirrored(side(), meeting, 0.4)
    assert found.sign == -1.0
    for τ in np.linspace(0.01, 0.99, 50):
        for x in (0.3, 1.0, 1.9, 2.5):
            force, slope, error = at(side(), (meeting - τ) % 1.0, x)
            assert at(found, float(τ), x) == pytest.approx((force, slope, error + 0.4), abs=1e-13)


def test_law_backwards_is_that_of_the_opposite_phase() -> None:
    """F and e of both sides at τ are those at −τ, at 50 phases: 1e-13; each side stays where it touches. Backwards
    twice is the law itself."""
    law = MeshLaw(side(), mirrored(side(), 0.31, 0.4))
    back, twice = backwards(law), backwards(backwards(law))
    for name in ("front", "back"):
        own, found, again = (getattr(each, name) for each in (law, back, twice))
        assert found.sign == own.sign
        for τ in np.linspace(0.01, 0.99, 50):
            for x in (0.3, 1.9):
                assert at(found, float(τ), x) == pytest.approx(at(own, (-τ) % 1.0, x), abs=1e-13)
                assert at(again, float(τ), x) == pytest.approx(at(own, float(τ), x), abs=1e-12)


def test_side_behind_touches_beyond_the_backlash() -> None:
    """x = −(s − e) − backlash, with the same force at the same phase: exact."""
    found = behind(side(), 0.4)
    force, slope, error = at(side(), 0.3, 0.7)
    assert at(found, 0.3, 0.7) == pytest.approx((force, slope, 0.4 - error), abs=1e-15)


def test_stops_are_the_phases_of_both_sides() -> None:
    """Those of front and back and further ones, each once, with the interval of each side between them."""
    law = MeshLaw(side(), mirrored(side(), 0.03, 0.4))
    stops, cells = law.stops((0.5, 0.6))
    assert {0.0, 0.125, 0.6, 1.0} <= set(stops.tolist()) and (np.diff(stops) > 1e-14).all()
    middle = 0.5 * (stops[1:] + stops[:-1])
    for one, cell in zip((law.front, law.back), cells.T):
        assert (one.phases[cell] < middle).all() and (middle < one.phases[cell + 1]).all()


def test_stiffest_of_a_linear_side() -> None:
    """The largest of a cosine's knots and middles: exact at a knot."""
    stiffness = 3.0 + np.cos(2.0 * np.pi * PHASES)
    assert MeshLaw(linear_side(stiffness, 0.0 * PHASES), no_side()).stiffest == pytest.approx(4.0, abs=1e-12)


def test_teeth_that_jam_are_refused() -> None:
    """Flanks that stand 2 µm proud at one phase: 1.9 µm of backlash leave an overlap of 0.1 µm, which is said; 2.1 µm
    are room enough."""
    front = linear_side(np.full(8, 1e5), np.where(np.arange(8) == 3, -2e-3, 0.0))

    def back(backlash: float) -> MeshSide:
        return linear_side(np.full(8, 1e5), np.full(8, backlash), -1.0)

    MeshLaw(front, back(2.1e-3))
    with pytest.raises(Jammed, match=r"overlap.*by 0\.1 µm"):
        MeshLaw(front, back(1.9e-3))
