"""Error bars of the excitation against true errors: of every position, and of the pitch's mean, peak-to-peak value and
mesh harmonics, under several torques. Meshes and references are those of `error_bars`.

All meshes are solved at the same positions, so that only the mesh's part of the bars is tried; `spacing` tries the
other one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from mpi4py import MPI

from evidence.benchmarks.accuracy.error_bars import BarProblem, BarRow, reference_mesh
from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.harmonics import mesh_harmonics
from evolvent.dynamics.results.curves import CoarseExcitation, PitchCurve, pitch_curves
from evolvent.gears.gear_model import Mesher
from evolvent.gears.load_list import LoadList
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.run.dynamics.excitation import loaded_pitch
from evolvent.run.load_list import load_scenes
from evolvent.run.progress import Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.arrays import Floats

PERCENTS = 25.0, 100.0, 200.0
"""Torques, in percent of the scene's."""
HARMONICS = 2
"""Mesh harmonics that are looked at; the narrow helical pair's six positions hold no more."""


def measure_excitation_bars(problem: BarProblem, percents: Sequence[float] = PERCENTS) -> Iterator[BarRow]:
    """One row a case, torque and figure. problem: of a pair without flank modifications, so that there is no unloaded
    transmission error."""
    at = problem.with_mesh(problem.reference)
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
        best, second = exact[quantity].values, nearly[quantity].values
        for columns in zip(curve.values, curve.bars, np.abs(curve.values - best), np.abs(best - second)):
            yield BarRow(case, quantity, 0.0, *map(float, columns))
        for name, figure in _figures().items():
            value, error = figure(curve.values), abs(figure(curve.values) - figure(best))
            off = abs(figure(best) - figure(second))
            yield BarRow(case, f"{quantity}, {name}", 0.0, value, curve.mesh_error(figure), error, off)


def _figures() -> dict[str, Callable[[Floats], float]]:
    """Of a pitch."""

    def amplitude(harmonic: int) -> Callable[[Floats], float]:
        return lambda values: float(mesh_harmonics(values, harmonic)[0][-1])

    known: dict[str, Callable[[Floats], float]] = {
        "mean": lambda values: float(np.mean(values)), "peak to peak": lambda values: float(np.ptp(values)),
    }  # fmt: skip
    return known | {f"harmonic {r}": amplitude(r) for r in range(1, HARMONICS + 1)}


def _excitation(scene: Scene, percents: Sequence[float], mesh: Mesher) -> MeshExcitation:
    """On this rank alone."""
    loads = load_scenes(scene, percents).values()
    problems = sorted((gear_problem(each) for each in loads), key=lambda each: each.torque)
    angles = np.array(uniform_pitch(problems[0].pair.pinion.z, scene.sweep.positions).angles)
    with Progress(hidden=True) as progress:
        loaded = loaded_pitch(LoadList(problems), problems, angles, mesh, MPI.COMM_SELF, progress)
    return MeshExcitation(np.zeros(len(angles)), loaded)
