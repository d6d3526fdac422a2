"""p0, load sharing and transmission error on flanks in levels do not depend on Nitsche's γ.

Yang's pair, 4.6 mm wide under its line load, at standard: two levels. γ acts on the pinion's finest level, so that the
wheel is condensed once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from mpi4py import MPI

from evidence.claims import Claim, regression
from evidence.robustness.settings.independence import CHANGE
from evidence.scenes import helical_pair_of_width
from evolvent.contact.nitsche.flux_recovery import SAFETY
from evolvent.fem.condensation.schur_complement import NotPositiveDefinite
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.meshing.levelled_meshes import levelled_mesh
from evolvent.gears.pressure.contact_slices import slices
from evolvent.gears.pressure.pitch_pressure import facets_of
from evolvent.gears.problem.gear_problem import GearProblem, MeshSettings
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.two_level_gear import two_level_gear
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.member import Member

SAFETIES = (1.1, 1.25, 5.0, 20.0, 50.0)
WIDTH = 4.6
"""Face width [mm]."""
STANDARD = MeshSettings("standard", two_level=True)
POSITIONS = 4
FRICTION = 0.1
NEAR_END = 0.5
"""Slices nearer to a face end are left out [mm]: there the pressure is not that of a line contact."""
QUANTITIES = ("largest", "largest p0 [MPa]"), ("mean", "mean p0 [MPa]"), ("error", "TE [mm]"), ("share", "load share")


@dataclass(frozen=True)
class LevelFigures:
    """Means over the positions."""

    largest: float
    """Of the fitted p0 of all slices without a tip edge [MPa]."""
    mean: float
    """Of the same [MPa]."""
    error: float
    """Transmission error [mm]."""
    share: float
    """Largest share of the load that a tooth pair has."""


@cache
def problem(mesh: MeshSettings) -> GearProblem:
    """The pair's."""
    return replace(gear_problem(helical_pair_of_width(WIDTH)), mesh=mesh)


@cache
def _default_model(mesh: MeshSettings) -> GearModel:
    return prepare_model(problem(mesh), MPI.COMM_SELF).model


def levelled_pinion(mesh: MeshSettings, safety: float) -> GearBody:
    """With γ at `safety` times the inverse-trace constant. Raises NotPositiveDefinite."""
    sector = levelled_mesh(problem(mesh), Member.PINION)
    return two_level_gear(problem(mesh), Member.PINION, sector, safety=safety)


@cache
def level_figures(safety: float, mesh: MeshSettings = STANDARD) -> LevelFigures:
    """NaN where the stiffness is not positive definite, so that the claims fail."""
    try:
        pinion = levelled_pinion(mesh, safety)
    except NotPositiveDefinite:
        return LevelFigures(np.nan, np.nan, np.nan, np.nan)
    model = replace(_default_model(mesh), bodies=(pinion, _default_model(mesh).bodies[1]))
    pitch = uniform_pitch(model.pair.pinion.z, POSITIONS)
    swept = sweep_pitch(model, pitch, [FRICTION], initial_state([FRICTION]))
    results = [position.results[0] for position in swept]
    cuts = [slices(result, facets_of(model), problem(mesh).materials) for result in results]
    peaks = [cut.peak[~cut.edge & (np.abs(cut.z) < 0.5 * WIDTH - NEAR_END)] for cut in cuts]
    forces = [np.bincount(cut.tooth - cut.tooth.min(), cut.line_load * cut.width) for cut in cuts]
    return LevelFigures(
        float(np.mean([np.nanmax(peak) for peak in peaks])),
        float(np.mean([np.nanmean(peak) for peak in peaks])),
        float(np.mean([result.transmission_error for result in results])),
        float(np.mean([force.max() / force.sum() for force in forces])),
    )


def level_claims(safeties: tuple[float, ...] = SAFETIES, mesh: MeshSettings = STANDARD) -> list[Claim]:
    """Each figure at each γ against those at the default."""
    source, wanted = regression("the same problem with the default γ"), level_figures(SAFETY, mesh)
    claims = []
    for safety in safeties:
        found, where = level_figures(safety, mesh), f"helical pair in levels, {mesh.level}, γ = {safety:g} C"
        claims += [
            source.relative(f"{quantity}, {where}", getattr(found, name), getattr(wanted, name), CHANGE)
            for name, quantity in QUANTITIES
        ]
    return claims
