"""The excitation of a scene's gears, solved on its meshes and on those of the coarse companion; its tables."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import (
    Figures,
    LoadedMesh,
    certify_torques,
    in_line_contact,
    mesh_of,
    solved_figures,
)
from evolvent.dynamics.results.curves import CoarseExcitation
from evolvent.dynamics.results.design_load import EXCITATION_FACTS, excitation_facts
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS, excitation_rows, harmonic_rows
from evolvent.gears.gear_model import GearModel
from evolvent.gears.solution.certified_pitch import ON_DEFLECTED, balanced
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent.results.archive.archive import COARSE
from evolvent.results.archive.run_cost import Timings
from evolvent.results.tables.table import Filled
from evolvent.run.call import Call
from evolvent.run.dynamics.excitation_lines import large_bars
from evolvent.run.dynamics.kept_positions import kept_positions
from evolvent.run.dynamics.scene_torques import SceneTorques
from evolvent.run.kept_pitch import COMPANION, OWN, Meshes, timings_of
from evolvent_meshes.arrays import Floats

EXCITATION_TABLES = EXCITATION, HARMONICS, EXCITATION_FACTS


@dataclass(frozen=True)
class SolvedExcitation:
    """Excitation of a scene's gears and, where it asks for error bars, that of the coarse companion."""

    excitation: MeshExcitation
    """Excitation on the meshes of the scene."""
    companion: CoarseExcitation
    """Excitation on the coarse meshes, at the same positions under the same torques."""
    timings: Timings
    """Wall time of both [s]."""
    warnings: tuple[str, ...]
    """Warnings on the excitation, a sentence each."""

    def tables(self, loads: SceneTorques, warnings: Iterable[str]) -> list[Filled]:
        """Tables of the excitation. warnings: that were known before it was computed."""
        scene, solved = loads.scene, (self.excitation, self.companion)
        pinion, wheel = (each.youngs_modulus for each in loads.problem.materials)
        pair, said = loads.problem.pair, (*warnings, *self.warnings)
        facts = excitation_facts(scene.title, scene.mesh.level, *solved, pair, (pinion, wheel), said)
        return [
            EXCITATION.of(excitation_rows(*solved, loads.cases)), HARMONICS.of(harmonic_rows(*solved, loads.cases)),
            EXCITATION_FACTS.of(facts),
        ]


def solved_excitation(call: Call, loads: SceneTorques, part: str = "") -> SolvedExcitation:
    """Excitation under each torque, on both kinds of meshes; each position is stored. Collective. part: of the results,
    see `Archive`; without one the folder of the call begins with the first position.

    Raises MeshError, TooMuchRelief, NotConverged, SearchError, BalanceError, ArchiveError, WriteError.
    """
    problem = loads.problem
    angles = np.array(uniform_pitch(problem.pair.pinion.z, loads.scene.sweep.positions).angles)
    unloaded = unloaded_error(RigidFlanks(problem.pair, problem.flanks), angles, problem.torque_on)
    whole, timings = timed_pitch(call, loads, angles, replace(OWN, part=part))
    coarse_meshes = replace(COMPANION, part=COARSE + part)
    loaded, left_out = in_line_contact(whole, min(loads.problem.torque, loads.torques[-1]))
    again = call.companion(loads.scene, lambda: loaded_pitch(call, loads, angles, coarse_meshes))
    coarse = None if again.value is None else MeshExcitation(unloaded, again.value.lightest(len(loaded.torques)))
    companion = CoarseExcitation(coarse, loads.scene.mesh.order, loads.elements, again.reason)
    mended = loaded.deflected and not problem.options.deflected_flanks
    own = MeshExcitation(unloaded, loaded)
    doubtful = large_bars(harmonic_rows(own, companion)) if coarse is not None and not part else ()
    said = loads.warnings, [ON_DEFLECTED] * mended, filter(None, [left_out, again.reason]), doubtful
    return SolvedExcitation(
        own, companion, replace(timings, error_bars=again.seconds), tuple(each for part in said for each in part)
    )


def loaded_pitch(call: Call, loads: SceneTorques, angles: Floats, meshes: Meshes) -> LoadedMesh:
    """The certified pitch of `timed_pitch`. Collective."""
    return timed_pitch(call, loads, angles, meshes)[0]


def timed_pitch(call: Call, loads: SceneTorques, angles: Floats, meshes: Meshes) -> tuple[LoadedMesh, Timings]:
    """The certified pitch under each torque, on deflected flanks where its energy does not balance otherwise, and the
    wall time of its solution. Collective. angles: (n,) rotations of the pinion [rad]."""
    asked = loads.problem.options.deflected_flanks
    kept = kept_positions(loads, call.folder, meshes.part)

    preparing, begin = Timings(), time.perf_counter()

    @cache
    def gears() -> GearModel:
        nonlocal preparing
        made = call.gears(loads.problem, meshes.mesh, shown=not meshes.part)
        preparing = timings_of(made)
        return made.model

    def solved(deflected: bool) -> LoadedMesh:
        store = kept.deflected if deflected > asked else kept
        found: Figures = call.on_first(store.read) if call.resume else {}

        def keep(solved: Figures) -> None:
            call.progress.reach(len(solved))
            call.on_first(lambda: store.write(solved))

        model = replace(gears(), deflected=deflected) if len(found) < len(angles) else None
        if not meshes.part and store is kept:
            call.on_first(lambda: call.begin(loads.scene, resumed=bool(found)))
        call.progress.stage(meshes.stage, len(angles), len(found))
        if model is not None:
            found = solved_figures(model, loads.torques, angles, call.comm, found, keep)
        certify_torques(found, loads.torques)
        return mesh_of(found, loads.torques, loads.problem.base_radius, angles, deflected)

    pitch = balanced(solved, asked)
    return pitch, preparing.then_solved(time.perf_counter() - begin)
