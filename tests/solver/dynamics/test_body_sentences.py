"""Sentences on gear bodies: where they vibrate by themselves, and that they are rigid."""

from __future__ import annotations

from dataclasses import replace

from evolvent.dynamics.body_sentences import bodies_said, body_resonances
from evolvent.dynamics.pair_model import drive
from tests.support.running.hub_and_rim import LOAD, PAIR, excitation, settings


def test_resonances_of_the_bodies_are_said() -> None:
    """Problem: one degree of freedom leaves out that bodies vibrate by themselves. Up to speeds at which the third mesh
    harmonic comes within a tenth of that frequency nothing is said, beyond it that speed, then that of the second one,
    too; at a single speed only the harmonics that are near there."""
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
    assert body_resonances(pair, 1.11 * third, 0.89 * second) == []


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
