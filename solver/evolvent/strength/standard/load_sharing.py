"""How tooth pairs in contact share the load, without computing the contact."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError

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


def stiffness_shares(stiffnesses: Sequence[float], deviations: Sequence[float], load: float) -> Floats:
    """Forces (n,) on n tooth pairs that deflect alike (Zhang et al. 2023, Eqs 7-11): F_i/K_i + δ_i is the same for all
    that bear load; the others do not touch.

    stiffnesses: K_i [N/mm].
    deviations: δ_i, modifications and errors that keep pair i apart [mm].
    load: sum of the forces [N].

    Raises InputError for stiffnesses or a load that are not above 0.
    """
    K, δ = np.asarray(stiffnesses, dtype=float), np.asarray(deviations, dtype=float)
    if len(K) == 0 or K.shape != δ.shape or not ((K > 0.0).all() and load > 0.0):
        raise InputError(
            f"load on tooth pairs: wanted as many stiffnesses above 0 as deviations, and a load above 0, found {K}, "
            f"{δ} and {load:g} N"
        )
    order = np.argsort(δ)
    for count in range(1, len(K) + 1):
        touching = order[:count]
        error = (load + K[touching] @ δ[touching]) / K[touching].sum()
        if count == len(K) or error <= δ[order[count]]:
            break
    return np.where(np.isin(np.arange(len(K)), touching), K * (error - δ), 0.0)
