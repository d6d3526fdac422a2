"""Error bars of curves whose errors are known."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.dynamics.results.transient.compared import FINER, STEP_FACTOR, ComparedMotion
from evolvent.results.error_bars.compared import Compared, Curve
from evolvent_meshes.arrays import Floats

ANGLE = 0.1 * np.arange(8)
FINE = 0.1 / FINER * np.arange(8 * FINER)


def smooth(angle: Floats) -> Floats:
    return np.asarray(2.0 + np.cos(2.0 * np.pi * angle / 0.8))


def sizes(values: Floats) -> Floats:
    """At least the root mean square of 2 + cos, the root of 4.5."""
    return np.maximum(values, np.sqrt(4.5))


def test_first_order_in_the_step_is_extrapolated() -> None:
    """A curve off by step times a constant, 8 per step, on meshes without error: the bar of its largest value is the
    true error; that of each value is at least it, and with the root mean square at most the error over the smallest
    value of 1 times the largest of 3."""
    off = 0.03
    same, finer = Curve(ANGLE, smooth(ANGLE) + off), Curve(FINE, smooth(FINE) + off / FINER)
    found = ComparedMotion(1.0, same, same, finer)
    apart = STEP_FACTOR * (off - off / FINER)
    assert apart == pytest.approx(off)
    assert found.of_figure(np.max) == pytest.approx(apart, rel=0.5) and found.of_figure(np.max) >= apart - 1e-12
    assert (found.of_each() >= off - 1e-12).all() and (found.of_each() <= 3.0 * off).all()


def test_the_mesh_counts_with_its_factor() -> None:
    """Twice as large on larger elements, in any step: the factor times the value itself, at least the root mean square
    of all."""
    own = Curve(ANGLE, smooth(ANGLE))
    same, finer = Curve(ANGLE, 2.0 * smooth(ANGLE)), Curve(FINE, 2.0 * smooth(FINE))
    found = ComparedMotion(0.5, own, same, finer)
    assert found.of_figure(np.max) == pytest.approx(0.5 * 3.0)
    assert found.of_each() == pytest.approx(0.5 * sizes(smooth(ANGLE)))


def test_a_mean_has_no_part_in_what_varies() -> None:
    """Curves that differ by a constant have the same peak-to-peak value, and a bar of zero."""
    curves = Curve(ANGLE, smooth(ANGLE)), Curve(ANGLE, smooth(ANGLE) + 1.0), Curve(ANGLE, smooth(ANGLE) - 1.0)
    assert ComparedMotion(1.0, *curves).of_varying(np.ptp) == pytest.approx(0.0, abs=1e-12)
    assert ComparedMotion(1.0, *curves).of_figure(np.max) > 1.0


def test_a_value_that_the_other_lacks_has_the_bar_of_the_curve() -> None:
    """One of eight is not known on larger elements: its bar is its size times the relative root mean square; so it is
    where the two motions there have none."""
    other = Curve(ANGLE[1:], 1.1 * smooth(ANGLE[1:]))
    own = Curve(ANGLE, smooth(ANGLE))
    assert Compared(own, other).of_each() == pytest.approx(0.1 * sizes(smooth(ANGLE)))
    assert np.isnan(other.at(ANGLE).values[0]) and np.isfinite(other.at(ANGLE).values[1:]).all()
    assert np.isfinite(ComparedMotion(1.0, own, other, Curve(FINE, smooth(FINE))).of_each()).all()


def test_curves_without_a_common_rotation_have_no_bar() -> None:
    """Not known, and not zero."""
    own, apart = Curve(ANGLE, smooth(ANGLE)), Curve(ANGLE + 0.01, smooth(ANGLE))
    assert np.isnan(Compared(own, apart).of_each()).all()
