"""Tooth loss factor of a gear pair, from its geometry alone."""

from __future__ import annotations

import math

from evolvent_meshes.gears.pair import GearPair

FEWEST, MOST = 1.0, 2.0
"""Transverse contact ratios from and to which the formula holds."""


def ohlendorf_loss_factor(pair: GearPair) -> float:
    """Tooth loss factor H_V = π (1/z_1 + 1/z_2)/cos β_b · (1 − ε_α + ε_1² + ε_2²): friction loss over input and
    coefficient, of teeth that share the load equally. ε_1, ε_2: tip contact ratios of pinion and wheel.

    NaN where the transverse contact ratio is not from 1 to 2. Source: H. Ohlendorf, dissertation, TH München 1958; G.
    Niemann, H. Winter, Maschinenelemente II; ISO/TR 14179-2.

    >>> from evolvent_meshes.gears.gear import GearParameters
    >>> rack = dict(normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=70.0)
    >>> gear = GearParameters.from_rack(z=50, **rack)
    >>> print(f"{ohlendorf_loss_factor(GearPair(gear, gear, 150.0)):.4f}")
    0.0986
    """
    pitch = pair.pinion.transverse_base_pitch
    recess, approach = pair.path_of_contact[1] / pitch, -pair.path_of_contact[0] / pitch
    if not FEWEST <= recess + approach <= MOST:
        return math.nan
    shared = 1.0 - recess - approach + recess**2 + approach**2
    return math.pi * (1.0 / pair.pinion.z + 1.0 / pair.wheel.z) / math.cos(pair.pinion.base_helix_angle) * shared
