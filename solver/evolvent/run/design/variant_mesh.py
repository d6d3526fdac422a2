"""Variants of a scene's flanks in line contact, on gears that are condensed once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from evolvent.contact.newton.snes import NotConverged
from evolvent.dynamics.excitation.harmonics import mesh_harmonics
from evolvent.dynamics.excitation.line_mesh import LineFigures, figures_at
from evolvent.dynamics.excitation.loaded_mesh import COLUMNS
from evolvent.gears.gear_model import GearModel
from evolvent.gears.line.line_gears import LineGears, LinePosition
from evolvent.gears.line.line_result import LineResult, TooWide
from evolvent.gears.unloaded_error import RigidFlanks
from evolvent.results.position_figures import pitch_loss_percent
from evolvent.scene.gear_pair import ImpossibleGears
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair

PEAK_TO_PEAK, FACE_LOAD, PRESSURE, LOST, FIRST_HARMONIC, ON_EDGES = range(6)
"""Columns of the figures of a variant under a torque: peak-to-peak transmission error [µm], K_Hβ (NaN in the plane),
largest p_0 away from edges and kinks [MPa], friction loss [%] (NaN where it is not asked for), amplitude of the first
mesh harmonic of the transmission error [µm], and the largest part of the load that edges of tips bear. All but the loss
are without friction."""
FIGURES = 6
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
    friction: float = 0.0
    """Friction coefficient of the loss; 0: there is no loss."""

    @staticmethod
    def of(
        model: GearModel, pair_of: Callable[[Floats], GearPair], torques: tuple[float, ...], angles: Floats,
        friction: float = 0.0,
    ) -> VariantMesh:
        """Variants on gears that were condensed for line contact."""
        return VariantMesh(LineGears.of(model, friction > 0.0), pair_of, torques, angles, friction)

    def figures(self, variant: Floats) -> tuple[Floats, str]:
        """Figures (m, `FIGURES`) of a variant (k,) under each torque, and why there are none; empty where there are."""
        try:
            flanks = RigidFlanks(self.pair_of(variant), self.gears.flanks.charts)
            gears = replace(self.gears, flanks=flanks)
            positions = [gears.position(float(angle)) for angle in self.angles]
            rows = np.array([figures_at(gears, each, self.torques) for each in positions])
            loss = self._loss_percent(gears, positions)
        except (ImpossibleGears, TooWide, NotConverged) as error:
            return np.full((len(self.torques), FIGURES), np.nan), str(error)
        line = LineFigures.of(rows[..., COLUMNS:])
        pressure = np.where(line.largest_pressure_MPa > 0.0, line.largest_pressure_MPa, np.nan)
        errors = 1e3 * rows[..., 0]
        peak_to_peak = np.ptp(errors, axis=0)
        harmonic = [mesh_harmonics(each, 1)[0][0] for each in errors.T]
        factor = np.where(line.is_plane, np.nan, line.face_load_factor)
        return np.column_stack([peak_to_peak, factor, pressure, loss, harmonic, line.on_edges.max(axis=0)]), ""

    def _loss_percent(self, gears: LineGears, positions: Sequence[LinePosition]) -> Floats:
        """Friction loss (m,) over the input of the pitch under each torque [%]; NaN without friction. Raises
        NotConverged, TooWide."""
        if self.friction == 0.0:
            return np.full(len(self.torques), np.nan)
        forces = np.array(self.torques) / gears.base_radius / gears.width_factor
        found = [[LineResult.of(each, force, self.friction, gears.free) for force in forces] for each in positions]
        lost = [[each.friction_power for each in row] for row in found]
        given = [[each.forces[gears.driving] * gears.pair.pinion.base_radius for each in row] for row in found]
        return pitch_loss_percent(lost, given)
