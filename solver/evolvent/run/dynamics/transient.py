"""Transient contact of a scene's gears, from start to finish. `evolvent transient` calls only this."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.dynamics.pair_model import DriveSettings
from evolvent.dynamics.results.transient import TransientCase, case_pressures, tooth_rows, transient_rows, write_rows
from evolvent.dynamics.results.transient_facts import sentences, transient_facts, write_facts
from evolvent.dynamics.transient.back_flanks import require_backlash
from evolvent.dynamics.transient.certificates import certify_motion
from evolvent.dynamics.transient.driven_pair import driven_pair, loaded_as_static, resolved_modes
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_transient import PairTransient
from evolvent.dynamics.transient.quasi_static_start import quasi_static_starts
from evolvent.dynamics.transient.steady_state import MeshPeriods, until_steady
from evolvent.dynamics.transient.step_lengths.divided_steps import UNDIVIDED, DividedSteps
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.machine import machine_megabytes
from evolvent.fem.parallel.ranks import on_first, together
from evolvent.gears.gear_model import GearModel, Preparer, prepare_model
from evolvent.gears.solution.certificates import certify, certify_pitch
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import initial_state, uniform_pitch
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.run.dynamics.kept_cases import KeptCases, Statics
from evolvent.run.dynamics.transient_checks import (
    ANIMATION,
    PICTURE,
    WRITTEN,
    prepared_folder,
    transient_section,
)
from evolvent.run.folder_checks import writing_to
from evolvent.run.progress import CONDENSING, MESHING, OUTPUT, POSITIONS, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.pair_dynamics import check_positions, drive_settings
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection, TransientSection
from evolvent.scene.skips import wanted_output

MODES, STEPS = "natural modes", "mesh periods"
KEPT = 0.35
"""Of the machine's memory: what the contacts of positions may take, beside the gears."""


def run_transient(
    scene: Scene, out: Path, resume: bool = False, overwrite: bool = False, quiet: bool = False,
    prepare: Preparer = prepare_model,
) -> list[str]:  # fmt: skip
    """Moves the pair on at each speed and friction coefficient until its motion repeats, and writes tables and picture
    to `out`. Returns sentences on what a reader has to know. Collective: the ranks share speeds and coefficients.

    scene: with a section [transient]; its wear is left out.
    resume: go on from the statics and the cases that an earlier call has ended.
    overwrite: begin anew, and replace what an earlier call has written.
    prepare: prepares gears that other calls share.

    Raises InputError without that section; FolderError, ArchiveError, MeshError, TooMuchRelief, NotConverged,
    SearchError, BalanceError, BackFlanks, Unbalanced, WriteError.
    """
    comm, hidden = MPI.COMM_WORLD, quiet or MPI.COMM_WORLD.rank > 0
    section, problem = transient_section(scene), gear_problem(scene)
    check_positions(scene)
    dynamics = scene.dynamics or DynamicsSection()
    settings, kept = drive_settings(problem.pair, dynamics), KeptCases.of(scene, problem.pair, out)
    sampled = max(section.speeds_rpm) / 60.0 * problem.pair.pinion.z * scene.sweep.positions  # Hz
    dolfinx_compat.silence_logs()
    checked = writing_to(out, comm, lambda: prepared_folder(out, resume, overwrite))
    with checked as said, Progress(hidden=hidden) as progress:
        known = on_first(comm, kept.read_static)
        progress.stage(MESHING)
        model = prepare(problem, comm, meshed=lambda: progress.stage(CONDENSING)).model
        static = known or _statics(scene, model, kept, comm, progress)
        progress.stage(MODES)
        modes = together(
            comm, lambda: resolved_modes(problem, model, dynamics.density_kg_m3, sampled, section.modes_per_harmonic)
        )
        constant_speed = section.drive == "constant_speed"
        pair = driven_pair(model, modes, settings, static[0], section.mode_damping_ratio, constant_speed)
        progress.stage(STEPS)
        cases = _cases(scene, pair, static, settings, kept, comm)
        progress.stage(OUTPUT)
        return said + on_first(comm, lambda: _written(scene, pair, cases, out))


def _statics(scene: Scene, model: GearModel, kept: KeptCases, comm: MPI.Comm, progress: Progress) -> Statics:
    """The positions without inertia, at each friction coefficient. Collective. Raises BalanceError."""
    pitch, frictions = uniform_pitch(model.pair.pinion.z, scene.sweep.positions), list(scene.contact.friction)
    progress.stage(POSITIONS, len(pitch.angles))
    swept = []
    for position in sweep_until_periodic(model, pitch, frictions, initial_state(frictions), comm):
        swept.append(position)
        progress.reach(min(len(swept), len(pitch.angles)))
    positions = [position.results for position in one_pitch(swept)]
    for results in positions:
        certify(results)
    certify_pitch(positions)
    static = [tuple(column) for column in zip(*positions)]
    on_first(comm, lambda: kept.write_static(static))
    return static


def _cases(
    scene: Scene, pair: MovingPair, static: Statics, settings: DriveSettings, kept: KeptCases, comm: MPI.Comm
) -> list[TransientCase]:
    """All speeds and friction coefficients, those that are missing divided among the ranks; on rank 0 all of them.
    Collective."""
    frictions, section = list(scene.contact.friction), transient_section(scene)
    tasks = [(speed, index) for speed in section.speeds_rpm for index in range(len(frictions))]
    known = together(comm, lambda: kept.read(len(tasks)) if comm.rank == 0 else {})
    ended = comm.bcast(set(known))
    missing = [number for number in range(len(tasks)) if number not in ended]
    loaded = [loaded_as_static(pair, results) for results in static]

    def solved() -> dict[int, MeshPeriods]:
        own = missing[comm.rank :: comm.size]
        if not own:
            return {}
        contacts = _contacts(scene, pair, comm.size)
        starts, found = quasi_static_starts(pair, contacts.step_angle, frictions), {}
        for number in own:
            speed, index = tasks[number]
            omega, scheme = 2.0 * np.pi * speed / 60.0, TimeScheme(section.spectral_radius)
            transient = PairTransient(loaded[index], frictions[index], omega, scheme, contacts, _division(section))
            start = starts[index].at(transient.time_step)
            found[number] = until_steady(transient, start, section.mesh_periods, section.steady_change)
            _check(found[number], transient, settings.backlash)
            kept.write(number, found[number])
        return found

    gathered = comm.gather(together(comm, solved)) or []
    every = {number: found for part in (known, *gathered) for number, found in part.items()}
    loads = [each.drive.torque / each.lever for each in loaded]
    return [
        TransientCase(speed, frictions[i], every[number], static[i], loads[i])
        for number, (speed, i) in enumerate(tasks)
        if comm.rank == 0
    ]


def _contacts(scene: Scene, pair: MovingPair, ranks: int) -> KeptContacts:
    """Of the positions of a mesh period, for all cases of a rank."""
    components = pair.model.bodies[0].d if any(scene.contact.friction) else 1
    return KeptContacts(pair, scene.sweep.positions, components, KEPT * 1e6 * machine_megabytes() / ranks)


def _division(section: TransientSection) -> DividedSteps:
    """How steps between two positions are divided."""
    if section.tolerance is None:
        return UNDIVIDED
    return DividedSteps(section.tolerance, section.most_parts.bit_length() - 1)


def _check(found: MeshPeriods, transient: PairTransient, backlash: float) -> None:
    """Raises BackFlanks, Unbalanced."""
    require_backlash(found.lowest_error, backlash, transient.name)
    if found.is_steady:
        load, energies = transient.pair.drive.torque / transient.pair.lever, found.energies
        certify_motion(found.mean_force / load, energies.left / energies.passed, transient.name)


def _written(scene: Scene, pair: MovingPair, cases: Sequence[TransientCase], out: Path) -> list[str]:
    """Writes everything, in place of what an earlier call has written. On rank 0 alone."""
    pressures = case_pressures(pair.model, cases)
    rows, teeth = list(transient_rows(pair.model, pressures)), list(tooth_rows(pair.model, pressures))
    facts = transient_facts(pair.model, pressures, pair.frequencies, pair.drive.inertia / pair.lever**2)

    def drawn() -> bytes:
        from evolvent.dynamics.figures.transient import transient_picture  # matplotlib takes a second to import

        return transient_picture(scene.title, rows, teeth, facts)

    def animated() -> bytes:
        from evolvent.dynamics.figures.field_of_action import FieldOfAction

        worst = int(np.argmax([fact.dynamic_factor for fact in facts]))
        return FieldOfAction(scene.title, pair.model.pair, pressures[worst]).animation()

    folder = RunFolder(out)
    folder.remove(WRITTEN)
    write_rows(folder, rows, teeth)
    write_facts(folder, facts)
    output = wanted_output(scene)
    pictures = [Picture(PICTURE, drawn)] if output.pictures else []
    pictures += [Picture(ANIMATION, animated)] if output.animation else []
    said = sentences(facts, scene.sweep.positions, transient_section(scene).tolerance)
    return [*draw(pictures, folder).failures, *said]
