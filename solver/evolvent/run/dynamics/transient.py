"""Transient contact of a scene's gears, from start to finish. `evolvent transient` calls only this."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.contact.transient.time_scheme import TimeScheme
from evolvent.dynamics.gear_inertia import TONNE_PER_MM3
from evolvent.dynamics.modes.gear_modes import GearModes, ModeChoice, gear_modes
from evolvent.dynamics.modes.mode_meshes import mode_mesh
from evolvent.dynamics.pair_model import DriveSettings
from evolvent.dynamics.results.transient import (
    TRANSIENT,
    TRANSIENT_FACTS,
    TRANSIENT_TEETH,
    TransientCase,
    TransientFacts,
    case_pressures,
    tooth_rows,
    transient_facts,
    transient_rows,
    write_transient,
)
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import Drive, MovingPair
from evolvent.dynamics.transient.pair_transient import PairTransient
from evolvent.dynamics.transient.quasi_static_start import quasi_static_starts
from evolvent.dynamics.transient.steady_state import MeshPeriods, until_steady
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.machine import machine_megabytes
from evolvent.fem.parallel.ranks import on_first, together
from evolvent.gears.gear_model import GearModel, Preparer, prepare_model
from evolvent.gears.meshing.levelled_meshes import is_two_level
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import initial_state, uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.run.folder_checks import writing_to
from evolvent.run.progress import CONDENSING, MESHING, OUTPUT, POSITIONS, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.pair_dynamics import check_positions, drive_settings
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection, TransientSection
from evolvent.scene.skips import wanted_output
from evolvent_meshes.errors import InputError, ResultError

PICTURE, MODES, STEPS = "transient.png", "natural modes", "mesh periods"
WRITTEN = TRANSIENT, TRANSIENT_TEETH, TRANSIENT_FACTS, f"pictures/{PICTURE}"
RESOLVED = 0.25
"""Of the frequency at which time steps sample: modes up to it have four steps a period, others answer at once."""
ENOUGH_STEPS = 8.0
"""A period of the pair's own vibration."""
KEPT = 0.35
"""Of the machine's memory: what the contacts of positions may take, beside the gears."""
MEAN_FORCE = 0.01
"""Of the load: what the mean mesh force of a steady state may differ from it."""


class Unbalanced(ResultError):
    """A motion that is called steady and still gains momentum."""


class BackFlanks(ResultError):
    """A motion in which the back flanks would touch, which are not modelled."""


def run_transient(
    scene: Scene, out: Path, overwrite: bool = False, quiet: bool = False, prepare: Preparer = prepare_model
) -> list[str]:
    """Moves the pair on at each speed and friction coefficient until its motion repeats, and writes tables and picture
    to `out`. Returns sentences on what a reader has to know. Collective: the ranks share speeds and coefficients.

    scene: with a section [transient]; its wear is left out. overwrite: replace what an earlier call has written.
    prepare: prepares gears that other calls share.

    Raises InputError without that section, and for gears whose flanks are meshed in levels; FolderError, MeshError,
    TooMuchRelief, NotConverged, SearchError, BackFlanks, Unbalanced, WriteError.
    """
    comm, hidden = MPI.COMM_WORLD, quiet or MPI.COMM_WORLD.rank > 0
    section, problem = _section(scene), gear_problem(scene)
    _check(scene, problem)
    settings = drive_settings(problem.pair, scene.dynamics or DynamicsSection())
    dolfinx_compat.silence_logs()
    with writing_to(out, comm, lambda: _check_folder(out, overwrite)), Progress(hidden=hidden) as progress:
        progress.stage(MESHING)
        model = prepare(problem, comm, meshed=lambda: progress.stage(CONDENSING)).model
        static = _statics(scene, model, comm, progress)
        progress.stage(MODES)
        modes = together(comm, lambda: _modes(scene, problem, model, section))
        pair = _moving_pair(model, modes, static, settings, section)
        cases = _cases(scene, pair, static, section, settings, comm, progress)
        progress.stage(OUTPUT)
        return on_first(comm, lambda: _written(scene, pair, cases, out))


def _section(scene: Scene) -> TransientSection:
    if scene.transient is None:
        raise InputError(
            "transient: found no section [transient]; wanted one with speeds; remedy: --set "
            "transient.speeds_rpm=[1500], or write [transient] into the scene"
        )
    return scene.transient


def _check(scene: Scene, problem: GearProblem) -> None:
    """Raises InputError, SceneError for what cannot be computed."""
    check_positions(scene)
    if is_two_level(problem):
        raise InputError(
            'transient: found flanks that are meshed in levels (mesh.level = "'
            f'{scene.mesh.level}", load.torque_Nm = {scene.load.torque_Nm:g}); wanted one mesh of each sector; remedy: '
            'mesh.level = "quick", or fewer mesh.elements_per_contact_width'
        )


def _check_folder(out: Path, overwrite: bool) -> None:
    RunFolder(out).require_free(WRITTEN)
    if (out / TRANSIENT).exists() and not overwrite:
        raise FolderError(
            f"{out}: found {TRANSIENT} of an earlier call; allowed: a folder without; remedy: --overwrite computes it "
            "anew, --out names another folder"
        )


def _statics(
    scene: Scene, model: GearModel, comm: MPI.Comm, progress: Progress
) -> list[tuple[PositionResult, ...]]:
    """The positions without inertia, at each friction coefficient. Collective."""
    pitch, frictions = uniform_pitch(model.pair.pinion.z, scene.sweep.positions), list(scene.contact.friction)
    progress.stage(POSITIONS, len(pitch.angles))
    swept = []
    for position in sweep_until_periodic(model, pitch, frictions, initial_state(frictions), comm):
        swept.append(position)
        progress.reach(min(len(swept), len(pitch.angles)))
    return [tuple(column) for column in zip(*(position.results for position in one_pitch(swept)))]


def _modes(
    scene: Scene, problem: GearProblem, model: GearModel, section: TransientSection
) -> tuple[GearModes, GearModes]:
    """Of pinion and wheel, with the density of the scene."""
    density = TONNE_PER_MM3 * (scene.dynamics or DynamicsSection()).density_kg_m3
    sampled = max(section.speeds_rpm) / 60.0 * model.pair.pinion.z * scene.sweep.positions  # Hz
    choice = ModeChoice(2.0 * np.pi * RESOLVED * sampled, section.modes_per_harmonic)
    heavy = [replace(body, material=replace(body.material, density=density)) for body in model.bodies]
    pinion, wheel = (gear_modes(body, choice, mode_mesh(problem, body.member, body.mesh)) for body in heavy)
    return pinion, wheel


def _moving_pair(
    model: GearModel, modes: tuple[GearModes, GearModes], static: Sequence[Sequence[PositionResult]],
    settings: DriveSettings, section: TransientSection,
) -> MovingPair:  # fmt: skip
    on, u, torque = model.load.on, model.pair.ratio, model.load.torque
    pinion, wheel = (inertia / model.width_factor for inertia in settings.inertias)
    torques = (torque, torque * u) if on == 0 else (torque / u, torque)  # but for friction
    drive = Drive.free(u, (pinion, wheel), torques)
    if section.drive == "constant_speed":
        drive = Drive.at_constant_speed(on, (pinion, wheel)[on], torques)
    pair = MovingPair(model, modes, drive, section.mode_damping_ratio, 0.0)
    stiffness = float(np.mean([result.stiffness for result in static[0]]))
    critical = 2.0 * np.sqrt(stiffness * drive.inertia) / pair.lever
    return replace(pair, mesh_damping=settings.damping_ratio * critical)


def _cases(
    scene: Scene, pair: MovingPair, static: Sequence[tuple[PositionResult, ...]], section: TransientSection,
    settings: DriveSettings, comm: MPI.Comm, progress: Progress,
) -> list[TransientCase]:  # fmt: skip
    """All speeds and friction coefficients, divided among the ranks; on rank 0 all of them. Collective."""
    frictions = list(scene.contact.friction)
    tasks = [(speed, index) for speed in section.speeds_rpm for index in range(len(frictions))]
    progress.stage(STEPS)
    normal_only = not any(frictions)
    room = KEPT * 1e6 * machine_megabytes() / comm.size
    kept = KeptContacts(pair, scene.sweep.positions, 1 if normal_only else pair.model.bodies[0].d, room)

    def solved() -> list[tuple[int, TransientCase]]:
        starts = quasi_static_starts(pair, kept.step_angle, frictions)
        found = []
        for number, (speed, index) in enumerate(tasks):
            if number % comm.size == comm.rank:
                omega, own = 2.0 * np.pi * speed / 60.0, _loaded(pair, static[index])
                transient = PairTransient(own, frictions[index], omega, TimeScheme(section.spectral_radius), kept)
                start = starts[index].at(transient.time_step)
                periods = until_steady(transient, start, section.mesh_periods, section.steady_change)
                _check_motion(periods, speed, own, settings.backlash)
                load = own.drive.torque / own.lever
                found.append((number, TransientCase(speed, frictions[index], periods, static[index], load)))
        return found

    gathered = comm.gather(together(comm, solved))
    if gathered is None:
        return []
    return [case for _, case in sorted((each for part in gathered for each in part), key=lambda each: each[0])]


def _loaded(pair: MovingPair, static: Sequence[PositionResult]) -> MovingPair:
    """The pair under the torque of the scene on one gear, and the mean one that statics have on the other: less or more
    by friction."""
    other = 1 - pair.model.load.on
    torques = list(pair.drive.torques)
    torques[other] = float(np.mean([result.torques[other] for result in static]))
    return replace(pair, drive=replace(pair.drive, torques=(torques[0], torques[1])))


def _check_motion(found: MeshPeriods, speed: float, pair: MovingPair, backlash: float) -> None:
    """Raises BackFlanks, Unbalanced."""
    lowest = float(found.errors.min())
    if lowest < -backlash:
        raise BackFlanks(
            f"{speed:g} r/min: wanted a motion within the backlash of {1e3 * backlash:.3g} µm, found a transmission "
            f"error of {1e3 * lowest:.3g} µm, at which the back flanks touch, which are not modelled here; `evolvent "
            "dynamics` has both sides; or give more damping, another speed"
        )
    load = pair.drive.torque / pair.lever
    if found.is_steady and abs(found.mean_force / load - 1.0) > MEAN_FORCE:
        raise Unbalanced(
            f"{speed:g} r/min: wanted a mean mesh force within {MEAN_FORCE:.0%} of the load of a motion that repeats, "
            f"found {found.mean_force / load:.4f} of it; lower transient.steady_change"
        )


def _written(scene: Scene, pair: MovingPair, cases: Sequence[TransientCase], out: Path) -> list[str]:
    """Writes everything, in place of what an earlier call has written. On rank 0 alone."""
    pressures = case_pressures(pair.model, cases)
    rows, teeth = list(transient_rows(pair.model, pressures)), list(tooth_rows(pair.model, pressures))
    facts = transient_facts(pair.model, pressures, pair.frequencies, pair.drive.inertia / pair.lever**2)

    def drawn() -> bytes:
        from evolvent.dynamics.figures.transient import transient_picture  # matplotlib takes a second to import

        return transient_picture(scene.title, rows, teeth, facts)

    folder = RunFolder(out)
    folder.remove(WRITTEN)
    write_transient(folder, rows, teeth, facts)
    failures = draw([Picture(PICTURE, drawn)] if wanted_output(scene).pictures else [], folder).failures
    unsteady = [
        f"{fact.speed_rpm:g} r/min, μ = {fact.friction:g}: not steady after {fact.mesh_periods} mesh periods; raise "
        "transient.mesh_periods, or look whether the motion repeats after several meshes (`evolvent dynamics`)"
        for fact in facts
        if not fact.steady
    ]
    return [*failures, *unsteady, *_unresolved(facts, scene.sweep.positions)]


def _unresolved(facts: Sequence[TransientFacts], positions: int) -> list[str]:
    """A sentence for each speed at which the pair's own vibration has too few time steps a period."""
    coarse = {fact.speed_rpm: fact for fact in facts if fact.steps_per_natural_period < ENOUGH_STEPS}
    return [
        f"{speed:g} r/min: the pair's own vibration of {fact.natural_frequency_Hz:.0f} Hz has "
        f"{fact.steps_per_natural_period:.2g} time steps a period; wanted {ENOUGH_STEPS:g}: what the mesh excites of "
        f"it is not resolved; sweep.positions = {math.ceil(positions * ENOUGH_STEPS / fact.steps_per_natural_period)} "
        "resolves it, transient.spectral_radius = 0 leaves statics where that is too many"
        for speed, fact in coarse.items()
    ]
