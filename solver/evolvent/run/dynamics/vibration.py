"""The vibration of a scene's gears over the speed, from start to finish. `evolvent dynamics` calls only this."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.gear_inertia import polar_moment
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep, speeds_to_periods, sweep_speeds
from evolvent.dynamics.oscillator.torsional_model import BEYOND_MEASURE
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive, geometric_backlash
from evolvent.dynamics.results.response import (
    BRANCH,
    DYNAMICS,
    RESPONSE,
    DriveSummary,
    branch_rows,
    largest_force,
    response_rows,
    responses,
    speed_of,
    summary,
    write_response,
)
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import Picture, draw
from evolvent.run.dynamics.excitation import WRITTEN, check_results, computed_excitation, write_excitation
from evolvent.run.progress import OUTPUT, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent_meshes.gears.pair import GearPair

PICTURE = "vibration.png"
SPEEDS = "speeds"
FROM, TO = 1.0 / 6.0, 1.6
"""Speeds that are swept by default, over the natural one."""
KG_M2 = 1e3
"""t·mm² per kg·m²."""


def run_dynamics(
    scenes: Sequence[Scene], section: DynamicsSection, out: Path, overwrite: bool = False, quiet: bool = False
) -> list[str]:
    """Computes excitation and vibration and writes their tables and pictures to `out`. Returns sentences on what a
    reader has to know, pictures that could not be drawn among them. Collective.

    scenes: the scene under each torque of the force surface, see `load_scenes`; that of the section's 100 % among them.
    section: [dynamics].
    overwrite: replace what an earlier call has written.

    Raises as `run_excitation`, and NoSteadyState.
    """
    comm = MPI.COMM_WORLD
    on_first(comm, lambda: check_results(out, (*WRITTEN, RESPONSE, BRANCH, DYNAMICS, f"pictures/{PICTURE}"), overwrite))
    dolfinx_compat.silence_logs()
    problems = sorted((gear_problem(scene) for scene in scenes), key=lambda problem: problem.torque)
    with Progress(hidden=quiet or comm.rank > 0) as progress:
        excitation = computed_excitation(problems, scenes[0].sweep.positions, comm, progress)
        return on_first(comm, lambda: _written(excitation, problems, section, out, progress))


def drive_settings(pair: GearPair, section: DynamicsSection) -> DriveSettings:
    """What the section says, with what follows from the gears where it says nothing."""
    given = section.pinion_inertia_kg_m2, section.wheel_inertia_kg_m2
    pinion, wheel = (
        polar_moment(gear, section.density_kg_m3) if value is None else KG_M2 * value
        for gear, value in zip(pair.gears, given)
    )
    backlash = geometric_backlash(pair) if section.backlash_um is None else 1e-3 * section.backlash_um
    series = np.inf if section.series_stiffness_N_per_um is None else 1e3 * section.series_stiffness_N_per_um
    return DriveSettings(
        (pinion, wheel), section.damping_ratio, backlash, section.damped_apart, section.ground_damping_ratio,
        float(series), section.mesh,
    )  # fmt: skip


def _swept(pair: Drive, section: DynamicsSection) -> SpeedSweep:
    """Over the section's speeds."""
    low, high = section.speed_rpm or (FROM * pair.natural_speed, TO * pair.natural_speed)
    slowest, fastest = speeds_to_periods(pair.natural_speed * np.array([FROM, TO]), pair.teeth)
    periods = speeds_to_periods(np.linspace(low, high, section.speeds), pair.teeth)
    return sweep_speeds(pair.model, periods, (float(slowest), float(fastest)))


def _written(
    excitation: MeshExcitation, problems: Sequence[GearProblem], section: DynamicsSection, out: Path, progress: Progress
) -> list[str]:
    """Sweeps the speeds and writes everything. On rank 0 alone."""
    percents = sorted(section.torque_percents)
    settings = drive_settings(problems[0].pair, section)
    vibrating = drive(problems[0].pair, excitation, percents.index(100.0), settings)
    progress.stage(SPEEDS)
    swept = _swept(vibrating, section)
    found, branch = responses(vibrating, swept), list(branch_rows(vibrating, swept))
    progress.stage(OUTPUT)
    known = summary(vibrating, settings, swept, largest_force(found), float(excitation.loaded.forces[-1]))
    with locked(out):
        folder = RunFolder(out)
        failures = write_excitation(folder, excitation, problems)
        write_response(folder, response_rows(vibrating, swept, found), branch, known)

        def drawn() -> bytes:
            from evolvent.dynamics.results.response_figure import response_picture  # matplotlib takes a second

            return response_picture(vibrating, swept, found, branch)

        failures += draw([Picture(PICTURE, drawn)], folder).failures
    return [*failures, *_warnings(vibrating, settings, known), *_not_followed(vibrating, swept)]


def _warnings(vibrating: Drive, settings: DriveSettings, known: DriveSummary) -> list[str]:
    """What a reader of the results has to know."""
    found, deflection = [], vibrating.model.load / vibrating.mean_stiffness
    if settings.backlash < deflection:
        found.append(
            f"dynamics.backlash_um: found {known.backlash_um:.3g} µm, less than the static deflection of "
            f"{1e3 * deflection:.3g} µm: the back flanks catch the teeth at once, so that there is hardly free flight "
            "and no jump; give the backlash of the pair"
        )
    if (share := known.heaviest_torque_share) is not None and share > 1.0:
        found.append(
            f"dynamics.torque_percents: the largest mesh force is {share:.3g} times that of the heaviest torque; "
            "beyond that the force goes on straight. Add heavier ones until this is below 1"
        )
    return found


def _not_followed(vibrating: Drive, swept: SpeedSweep) -> list[str]:
    """Where the branch of steady states ends, and motions that have no end."""
    found, branch = [], swept.branch
    if branch.gaps or branch.lost:
        ends = [branch.points[i].period for gap in branch.gaps for i in (gap, gap + 1)]
        speeds = ", ".join(f"{speed_of(vibrating, period):.0f}" for period in ends)
        found.append(
            f"steady states: found {len(branch.gaps) + 1} pieces that are not connected (branch.csv), with ends at "
            f"{speeds or 'one end of the'} r/min. {' '.join(f'{each}.' for each in branch.lost)}".rstrip()
        )
    gone = {float(period) for runs in (swept.up, swept.down) for period, run in zip(swept.periods, runs) if run.escaped}
    if gone:
        slowest, fastest = (speed_of(vibrating, period) for period in (max(gone), min(gone)))
        found.append(
            f"response.csv: at {len(gone)} of {len(swept.periods)} speeds, from {slowest:.0f} to {fastest:.0f} r/min, "
            f"the motion grows beyond {BEYOND_MEASURE:g} times the static deflection, as the varying stiffness feeds "
            "in more than the dampers take out; its figures there are of the last mesh before. Give more damping"
        )
    return found
