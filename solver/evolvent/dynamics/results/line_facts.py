"""Figures that an excitation has in line contact alone, with their errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.results.curves import CoarseExcitation
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True, eq=False)
class LineFacts:
    """Figures under m torques; NaN where the contact is resolved, errors also without a companion."""

    face_load_factor: Floats
    """(m,) face load factor K_Hβ; NaN in the plane."""
    face_load_factor_error: Floats
    """(m,) its errors."""
    largest_pressure_MPa: Floats
    """(m,) largest p_0 away from edges of tips and from starts of linear reliefs."""
    largest_pressure_MPa_error: Floats
    """(m,) its errors."""


def line_facts(excitation: MeshExcitation, companion: CoarseExcitation) -> LineFacts:
    """Figures of an excitation with their errors."""
    own, unknown = excitation.loaded.line, np.full(len(excitation.loaded.torques), np.nan)
    coarse = None if companion.excitation is None else companion.excitation.loaded.line
    if own is None:
        return LineFacts(unknown, unknown, unknown, unknown)
    factor = unknown if own.is_plane else own.face_load_factor
    factor_error = unknown if own.is_plane or coarse is None else own.face_load_error(coarse)
    error = unknown if coarse is None else own.pressure_error(coarse)
    return LineFacts(factor, factor_error, own.largest_pressure_MPa, error)
