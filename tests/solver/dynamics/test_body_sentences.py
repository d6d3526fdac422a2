"""Sentences on gear bodies: where they vibrate by themselves, and that they are rigid."""

from __future__ import annotations

from dataclasses import replace

import pytest

from evolvent.dynamics.body_sentences import bodies_said, body_resonances, near_body_vibration
from evolvent.dynamics.pair_model import drive
from tests.support.running.hub_and_rim import HUB, LOAD, PAIR, RIM, excitation, settings


def test_resonances_of_the_bodies_are_said() -> None:
    """Problem: one degree of freedom leaves out that bodies vibrate by themselves. Up to speeds at which the third mesh
    harmonic has 0.9 times that frequency nothing is said, beyond it that speed, then that of the second one,
    too; at a single speed only the harmonics that are near there, from 0.9 to 1.2 times the
    speed: larger forces reach further above it."""
    pair = drive(PAIR, excitation(), LOAD, settings())
    third, second = (60.0 * pair.body_frequency / (50.0 * harmonic) for harmonic in (3, 2))
    assert pair.body_frequency > 4.0 * pair.natural_speed * 50.0 / 60.0
    assert body_resonances(pair, 0.0, 0.89 * third) == []
    (said,) = body_resonances(pair, 0.0, 0.91 * third)
    assert f"{third:.0f} r/min (mesh harmonic 3)" in said and "harmonic 2" not in said
    (said,) = body_resonances(pair, 0.0, 0.91 * second)
    assert f"{second:.0f} r/min (mesh harmonic 2)" in said and "evolvent transient" in said
    (said,) = body_resonances(pair, second, second)
    assert "mesh harmonic 2" in said and "harmonic 3" not in said
    assert body_resonances(pair, 1.21 * third, 0.89 * second) == [] != body_resonances(pair, 1.19 * third, 1.19 * third)
    assert "bores whose centres cannot move" in said and "dynamic_factor is without the force of the damper" in said


def test_speeds_near_the_bodies_vibration_are_marked() -> None:
    """From 0.9 to 1.2 times the speed at which the first, second or third mesh harmonic has the bodies' frequency, and
    not at the fourth; never on rigid bodies."""
    pair = drive(PAIR, excitation(), LOAD, settings())
    first = 60.0 * pair.body_frequency / 50.0
    for parts, near in (((0.91, 1.0, 1.19), True), ((0.89, 1.21), False)):
        assert {near_body_vibration(pair, part * first / 3.0) for part in parts} == {near}
    assert near_body_vibration(pair, 1.19 * first) and not near_body_vibration(pair, first / 4.0)
    assert not near_body_vibration(drive(PAIR, excitation(), LOAD, replace(settings(), bodies=None)), first)


def test_inertia_beyond_the_bodies() -> None:
    """Exact: 1 of 8.4 t·mm² more than the body on the pinion, and rounding alone on the wheel."""
    given = replace(settings(), inertias=(HUB + RIM + 1.0, (HUB + RIM) * (1.0 + 1e-4)))
    assert given.added_inertias == (pytest.approx(1.0), 0.0)
    assert replace(given, bodies=None).added_inertias is None


def test_rigid_bodies_are_said() -> None:
    """Rigid bodies have no vibration of their own, and a sentence says at any speed what they do; elastic ones at low
    speeds say nothing."""
    rigid, elastic = (drive(PAIR, excitation(), LOAD, each) for each in (replace(settings(), bodies=None), settings()))
    assert body_resonances(rigid, 0.0, 1e6) == []
    (said,) = bodies_said(rigid, 100.0, 200.0)
    assert said.startswith('dynamics.bodies = "rigid": all inertia is at the bores')
    assert '"elastic", the default, has the inertia where it is' in said
    assert bodies_said(elastic, 100.0, 200.0) == []
    assert bodies_said(elastic, 0.0, 1e6) == body_resonances(elastic, 0.0, 1e6) != []
