"""What a contact's wear is measured by: how far its bodies give way, and how fast wear evens out what is uneven."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from evolvent.contact.problem.definition import Contact, Problem, Side
from evolvent.fem.material import contact_modulus
from evolvent.fem.surface import Surface
from evolvent.wear.archard import Archard
from evolvent.wear.cycle import Rubbing


def deformation(problem: Problem, states: Sequence[Sequence[Rubbing]]) -> float:
    """Largest p̄ ℓ/E* [mm] of all contacts, p̄ the mean pressure on the pressed length or area ℓ or ℓ²: what an elastic
    half-space gives way, π/2 times b²/2R under a Hertzian line."""
    found = 0.0
    for contact, own in zip(problem.contacts, states):
        for result in (state.result for state in own):
            pressed = float(result.weights[result.pressure > 0.0].sum())
            length = pressed ** (1.0 / (result.points.shape[1] - 1))
            mean = float(result.weights @ result.pressure) / pressed if pressed else 0.0
            found = max(found, mean * length / _modulus(problem, contact))
    return found


def ripple_decay(
    problem: Problem, laws: Sequence[Archard], states: Sequence[Sequence[Rubbing]], surfaces: Mapping[Side, Surface]
) -> float:
    """Cycles in which a ripple from node to node of these surfaces decays to 1/e: 1/(K/H πE*/ℓ s), ℓ two nodes, of the
    contact where it does so fastest."""
    fastest = 0.0
    for contact, law, own in zip(problem.contacts, laws, states):
        sides = [(side, K) for side, K in zip((contact.first, contact.second), law.both) if side in surfaces]
        nodes = [float(np.median(surfaces[side].weights())) for side, _ in sides]
        dimension = max((surfaces[side].points.shape[1] - 1 for side, _ in sides), default=1)
        slid = sum(float(state.sliding[state.result.pressure > 0.0].max(initial=0.0)) for state in own)
        ripple = 2.0 * min(nodes, default=np.inf) ** (1.0 / dimension)
        fastest = max(fastest, sum(K for _, K in sides) * slid * np.pi * _modulus(problem, contact) / ripple)
    return 1.0 / fastest if fastest else np.inf


def _modulus(problem: Problem, contact: Contact) -> float:
    """E* [MPa] of a contact's two materials."""
    return contact_modulus(*(problem.bodies[index].material for index, _ in (contact.first, contact.second)))
