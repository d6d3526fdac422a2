"""Error bars of the excitation against true errors: of every position, and of the pitch's mean, peak-to-peak value and
mesh harmonics, under several torques. Meshes and references are those of `error_bars`.

The references have several times the positions, those of the cases among them: figures of the pitch are held against
the pitch, not against the same samples of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from mpi4py import MPI

from evidence.benchmarks.accuracy.error_bars import BarProblem, BarRow, reference_mesh
from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.results.curves import CoarseExcitation, PitchCurve, pitch_curves
from evolvent.gears.gear_model import Mesher
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.run.dynamics.excitation import loaded_pitch
from evolvent.run.dynamics.scene_torques import scene_torques
from evolvent.run.progress import Progress
from evolvent.scene.scene import Scene, scene_from_text

PERCENTS = 25.0, 100.0, 200.0
"""Torques, in percent of the scene's."""
FINER = 4
"""Positions of the reference over those of the cases."""


def measure_bars(problem: BarProblem, percents: Sequence[float] = PERCENTS) -> Iterator[BarRow]:
    """One row a case, torque and figure. problem: of a pair without flank modifications, so that there is no unloaded
    transmission error."""
    at = _with_positions(problem.with_mesh(problem.reference))
    best, second = (_excitation(at, percents, reference_mesh(problem, problem.halvings - last)) for last in (0, 1))
    for case in problem.cases:
        scene = problem.with_mesh(case)
        coarse = CoarseExcitation(_excitation(scene, percents, companion_mesh), scene.mesh.order)
        tried = pitch_curves(_excitation(scene, percents, run_mesh), coarse)
        exact, nearly = (pitch_curves(each, CoarseExcitation(None)) for each in (best, second))
        for percent, *curves in zip(sorted(percents), tried, exact, nearly):
            yield from _rows(", ".join((problem.name, *case, f"{percent:g} % of the torque")), *curves)


def _rows(
    case: str, tried: Mapping[str, PitchCurve], exact: Mapping[str, PitchCurve], nearly: Mapping[str, PitchCurve]
) -> Iterator[BarRow]:
    """All figures of all quantities under one torque."""
    for quantity, curve in tried.items():
        best, second = exact[quantity], nearly[quantity]
        places = zip(curve.values, curve.bars, best.values[::FINER], second.values[::FINER])
        mean, size = (
            [float(figure(each.values)) for each in (curve, best, second)] for figure in (np.mean, np.ptp)
        )
        figures: list[tuple[str, float, float, float, float]] = [
            *((quantity, *place) for place in places),
            (f"{quantity}, mean", mean[0], curve.mean_error, mean[1], mean[2]),
            (f"{quantity}, peak to peak", size[0], curve.peak_to_peak_error, size[1], size[2]),
        ]
        amplitudes = zip(curve.harmonics[0], curve.amplitude_errors, best.harmonics[0], second.harmonics[0])
        figures += [(f"{quantity}, harmonics", *each) for each in amplitudes]
        for figure, value, bar, reference, other in figures:
            errors = abs(value - reference), abs(reference - other)
            yield BarRow(case, figure, 0.0, float(value), float(bar), *map(float, errors))


def _with_positions(scene: Scene) -> Scene:
    """The scene at `FINER` times its positions."""
    return scene_from_text(scene.resolved_toml(), [f"sweep.positions={FINER * scene.sweep.positions}"])


def _excitation(scene: Scene, percents: Sequence[float], mesh: Mesher) -> MeshExcitation:
    """On this rank alone."""
    loads = scene_torques(scene, percents)
    angles = np.array(uniform_pitch(loads.problem.pair.pinion.z, scene.sweep.positions).angles)
    with Progress(hidden=True) as progress:
        loaded = loaded_pitch(loads, angles, mesh, MPI.COMM_SELF, progress)
    return MeshExcitation(np.zeros(len(angles)), loaded)
