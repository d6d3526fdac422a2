"""Scales of a wearing contact: its elastic deformation, and the decay of ripples in the worn depth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from evolvent.contact.problem.definition import Contact, Problem, Side
from evolvent.fem.material import contact_modulus
from evolvent.fem.surface import Surface
from evolvent.wear.archard import Archard
from evolvent.wear.cycle import SlidingContact


def deformation(problem: Problem, states: Sequence[Sequence[SlidingContact]]) -> float:
    """Largest p̄ ℓ/E* [mm] of all contacts: the deformation of an elastic half-space, π/2 times b²/2R under a Hertzian
    line contact.

    p̄ is the mean pressure on the pressed length ℓ (2D) or area ℓ² (3D). states: per contact, its sliding states.
    """
    largest = 0.0
    for contact, sliding in zip(problem.contacts, states):
        for result in (state.result for state in sliding):
            pressed = float(result.weights[result.pressure > 0.0].sum())
            length = pressed ** (1.0 / (result.points.shape[1] - 1))
            mean = float(result.weights @ result.pressure) / pressed if pressed else 0.0
            largest = max(largest, mean * length / _modulus(problem, contact))
    return largest


def ripple_decay(
    problem: Problem,
    laws: Sequence[Archard],
    states: Sequence[Sequence[SlidingContact]],
    surfaces: Mapping[Side, Surface],
) -> float:
    """Cycles in which the shortest ripple of the depth decays to 1/e, 1/((K/H)(πE*/ℓ) s), at the fastest contact.

    ℓ is the wavelength of two nodes of these surfaces, s the sliding distance per cycle. states: per contact, its
    sliding states. Infinite where nothing wears.
    """
    fastest = 0.0
    for contact, law, sliding in zip(problem.contacts, laws, states):
        sides = [(side, K) for side, K in zip((contact.first, contact.second), law.coefficients) if side in surfaces]
        nodes = [float(np.median(surfaces[side].weights())) for side, _ in sides]
        dimension = max((surfaces[side].points.shape[1] - 1 for side, _ in sides), default=1)
        slid = sum(float(state.sliding[state.result.pressure > 0.0].max(initial=0.0)) for state in sliding)
        wavelength = 2.0 * min(nodes, default=np.inf) ** (1.0 / dimension)
        fastest = max(fastest, sum(K for _, K in sides) * slid * np.pi * _modulus(problem, contact) / wavelength)
    return 1.0 / fastest if fastest else np.inf


def _modulus(problem: Problem, contact: Contact) -> float:
    """Contact modulus E* [MPa] of a contact's two materials."""
    return contact_modulus(*(problem.bodies[index].material for index, _ in (contact.first, contact.second)))
