"""How tooth pairs in contact share the load, without computing the contact."""

from __future__ import annotations

import math

import numpy as np

from evolvent_meshes.arrays import Floats

ROUNDING = 1e-12
"""Tolerance of places on the path of contact, over the base pitch."""


def pairs_in_contact(phase: float, contact_ratio: float) -> Floats:
    """Places of the tooth pairs in contact along the path of contact, in base pitches from its start: one at `phase`,
    others whole pitches from it. A pair at either end counts.

    phase: from 0 to ε_α. contact_ratio: ε_α.
    """
    first = math.ceil(-phase - ROUNDING)
    last = math.floor(contact_ratio - phase + ROUNDING)
    return phase + np.arange(first, last + 1)


def pedrero_share(phase: float, contact_ratio: float) -> float:
    """Share of a spur tooth pair by least elastic energy: v/Σv with v = cos[b_0 (ξ − ξ_m)], b_0 = [½ (1 + ε_α/2)² −
    1]^(−½) (Pedrero et al., Mech. Mach. Theory 45, 2010, 780-794); of the inner zone where pairs begin or end.

    phase, contact_ratio: see `pairs_in_contact`.
    """
    middle = 0.5 * contact_ratio
    b0 = 1.0 / math.sqrt(0.5 * (1.0 + middle) ** 2 - 1.0)
    places = pairs_in_contact(phase, contact_ratio)
    own = np.abs(places - phase) < 0.5
    inner = ((places > ROUNDING) & (places < contact_ratio - ROUNDING)) | own
    stiffness = np.cos(b0 * (places[inner] - middle))
    return float(math.cos(b0 * (phase - middle)) / stiffness.sum())
