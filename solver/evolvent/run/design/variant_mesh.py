"""Variants of a scene's flanks in line contact, on gears that are condensed once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.newton.snes import NotConverged
from evolvent.dynamics.excitation.line_mesh import LineFigures, line_figures
from evolvent.dynamics.excitation.loaded_mesh import COLUMNS
from evolvent.gears.gear_model import GearModel
from evolvent.gears.line.line_gears import LineGears
from evolvent.gears.line.line_result import TooWide
from evolvent.gears.unloaded_error import RigidFlanks
from evolvent.scene.gear_pair import ImpossibleGears
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair

PEAK_TO_PEAK, FACE_LOAD, PRESSURE, ON_EDGES = range(4)
"""Columns of the figures of a variant under a torque: peak-to-peak transmission error [µm], K_Hβ (NaN in the plane),
largest p_0 away from edges and kinks [MPa], and the largest part of the load that edges of tips bear."""
FIGURES = 4
"""Number of these columns."""


@dataclass(frozen=True, eq=False)
class VariantMesh:
    """Condensed gears whose flanks are varied."""

    gears: LineGears
    """Gears in line contact, with the flanks of the scene as it stands."""
    pair_of: Callable[[Floats], GearPair]
    """Pair with the modifications of a variant (k,). Raises ImpossibleGears."""
    torques: tuple[float, ...]
    """(m,) torques, ascending [N·mm]."""
    angles: Floats
    """(n,) rotations of the pinion over a pitch [rad]."""

    @staticmethod
    def of(
        model: GearModel, pair_of: Callable[[Floats], GearPair], torques: tuple[float, ...], angles: Floats
    ) -> VariantMesh:
        """Variants on gears that were condensed for line contact."""
        return VariantMesh(LineGears.of(model), pair_of, torques, angles)

    def figures(self, variant: Floats) -> tuple[Floats, str]:
        """Figures (m, `FIGURES`) of a variant (k,) under each torque, and why there are none; empty where there are."""
        try:
            flanks = RigidFlanks(self.pair_of(variant), self.gears.flanks.charts)
            rows = np.array(list(line_figures(replace(self.gears, flanks=flanks), self.torques, self.angles)))
        except (ImpossibleGears, TooWide, NotConverged) as error:
            return np.full((len(self.torques), FIGURES), np.nan), str(error)
        line = LineFigures.of(rows[..., COLUMNS:])
        pressure = np.where(line.largest_pressure_MPa > 0.0, line.largest_pressure_MPa, np.nan)
        peak_to_peak = 1e3 * np.ptp(rows[..., 0], axis=0)
        factor = np.where(line.is_plane, np.nan, line.face_load_factor)
        return np.column_stack([peak_to_peak, factor, pressure, line.on_edges.max(axis=0)]), ""
