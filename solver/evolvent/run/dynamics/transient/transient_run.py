"""Transient contact of a scene's gears, from start to finish. `evolvent transient` calls only this."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.figures.all import TRANSIENT_PICTURES, TRANSIENT_SCENE
from evolvent.dynamics.of_scene import check_positions, drive_settings
from evolvent.dynamics.results.transient.beginning import TRANSIENT_START, beginnings, start_rows
from evolvent.dynamics.results.transient.cases import TransientCase, case_pressures, elements_across
from evolvent.dynamics.results.transient.errors import MovingCompanion, case_errors
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS, sentences, transient_facts
from evolvent.dynamics.results.transient.rows import TRANSIENT, TRANSIENT_TEETH, tooth_rows, transient_rows
from evolvent.dynamics.transient.own_frequency import own_frequency
from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Preparer, prepare_model
from evolvent.gears.pressure.contact_cells import coarse_contact
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.run.dynamics.transient.cases import PairCases, PairMeshes
from evolvent.run.dynamics.transient.checks import (
    ANIMATION,
    WRITTEN,
    prepared_folder,
    require_possible,
    transient_section,
    unused_keys,
)
from evolvent.run.dynamics.transient.kept_cases import KeptCases
from evolvent.run.dynamics.transient.moving_companion import companion_of
from evolvent.run.folder_checks import writing_to
from evolvent.run.progress import OUTPUT, Progress
from evolvent.scene.chart_warnings import chart_warnings
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent.scene.skips import wanted_output, with_deflected_flanks
from evolvent.scene.vibration_limits import doubtful

UNLIKE_STATICS = (
    "The pitch without inertia does not balance along normals before deflection: it was solved on deflected flanks "
    "(skip deflected-flanks). Motions are computed along normals before deflection; period_energy_error of "
    "transient.json is what they lose."
)


def run_transient(
    scene: Scene, out: Path, resume: bool = False, overwrite: bool = False, quiet: bool = False,
    prepare: Preparer = prepare_model,
) -> list[str]:
    """Computes the transient contact of the pair at each speed and friction coefficient until its motion repeats, and
    writes tables and picture to `out`. Returns warnings on the results, a sentence each. Collective: the ranks share
    speeds and coefficients.

    scene: with a section [transient]; its wear is left out.
    resume: go on from the statics and the cases that an earlier call has ended.
    overwrite: begin anew, and replace what an earlier call has written.
    prepare: prepares gears that other calls share.

    Raises InputError without that section; SceneError for a start from rest without a backlash or too many modes;
    FolderError, ArchiveError, MeshError, TooMuchRelief, NotConverged, SearchError, BalanceError, BackFlanks,
    Unbalanced, WriteError.
    """
    comm, hidden = MPI.COMM_WORLD, quiet or MPI.COMM_WORLD.rank > 0
    transient_section(scene)
    problem = gear_problem(scene)
    check_positions(scene)
    dynamics = scene.dynamics or DynamicsSection()
    require_possible(scene)
    settings = drive_settings(problem.pair, dynamics)

    def kept(kind: str = "") -> KeptCases:
        return KeptCases.of(scene, problem.pair, out, kind)

    dolfinx_compat.silence_logs()
    checked = writing_to(out, comm, lambda: prepared_folder(out, resume, overwrite))
    with checked as said, Progress(hidden=hidden) as progress:
        own = PairCases.of(scene, problem, settings, PairMeshes(), kept(), comm, progress, prepare)
        found = own.found(kept())
        companion = companion_of(scene, problem, settings, kept, comm, progress, prepare)
        progress.stage(OUTPUT)
        said += [*chart_warnings(scene), *unused_keys(dynamics), *doubtful(scene.planned_vibration())]
        said += filter(None, [companion.reason])
        return said + on_first(comm, lambda: _written(own, found, companion.value, out))


def _written(
    own: PairCases, found: Mapping[int, MeshPeriods], companion: MovingCompanion | None, out: Path
) -> list[str]:
    """Writes all files, in place of those of an earlier call. On rank 0 alone."""
    scene, pair, frictions = own.scene, own.pair, own.scene.contact.friction
    solved = with_deflected_flanks(scene) if own.static.deflected else scene
    loads = [each.drive.torque / each.lever for each in own.loaded()]
    cases = [
        TransientCase(speed, frictions[i], found[number], own.static.positions[i], loads[i])
        for number, (speed, i) in enumerate(own.tasks)
    ]
    pressures = case_pressures(pair.model, cases)
    errors = case_errors(pair.model, pressures, companion)
    begun = beginnings(pair.model, pressures, companion)
    natural = [own_frequency(pair, static) for static in own.static.positions]
    naturals = [natural[i] for _, i in own.tasks]
    facts = transient_facts(pair.model, pressures, errors, [bars for _, bars in begun], pair.frequencies, naturals)

    def animated() -> bytes:
        from evolvent.dynamics.figures.field_of_action import FieldOfAction  # matplotlib takes a second to import

        worst = int(np.argmax([fact.dynamic_factor for fact in facts]))
        return FieldOfAction(scene.title, pair.model.pair, pressures[worst]).animation()

    folder = RunFolder(out)
    folder.remove(WRITTEN)
    folder.write_text(TRANSIENT_SCENE.name, solved.resolved_toml())
    TRANSIENT.write(folder, transient_rows(pair.model, pressures, errors))
    TRANSIENT_TEETH.write(folder, tooth_rows(pair.model, pressures, errors))
    TRANSIENT_FACTS.write(folder, facts)
    TRANSIENT_START.write(folder, start_rows(pair.model, pressures, begun))
    output = wanted_output(scene)
    pictures = list(from_tables(TRANSIENT_PICTURES if output.pictures else (), out))
    pictures += [Picture(ANIMATION, animated)] if output.animation else []
    section, positions = transient_section(scene), scene.sweep.positions
    said = sentences(facts, positions, section.tolerance, section.spectral_radius)
    coarse = coarse_contact(elements_across(pair.model, pressures))
    unknown = [f"{each.case.name}: {bars.said}" for each, bars in zip(pressures, errors) if bars.said]
    mended = [] if solved is scene else [UNLIKE_STATICS]
    return [*draw(pictures, folder).failures, *said, *coarse, *unknown, *mended]
