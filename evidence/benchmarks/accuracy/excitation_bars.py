"""Errors of the excitation, and how often its error bars hold them: of every position, and of the pitch's mean,
peak-to-peak value and mesh harmonics, under several torques. Meshes and references are those of `error_bars`.

The references have several times the positions, those of the cases among them: figures of the pitch are held against
the pitch, not against the same samples of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from evidence.benchmarks.accuracy.error_bars import BarProblem, reference_mesh
from evidence.calls import temporary_call
from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.results.curves import CoarseExcitation, PitchCurve, pitch_curves
from evolvent.gears.gear_model import Mesher
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.run.dynamics.excitation import loaded_pitch
from evolvent.run.dynamics.scene_torques import SceneTorques, scene_torques
from evolvent.run.kept_pitch import Meshes
from evolvent.scene.scene import Scene, scene_from_text
from evolvent_meshes.arrays import Floats

PERCENTS = 5.0, 25.0, 100.0, 200.0
"""Torques, in percent of the scene's, whose mesh all of them have."""
FINER = 4
"""Positions of the reference over those of the cases."""


@dataclass(frozen=True)
class ExcitationRow:
    """A kind of figure of a quantity on one mesh under one torque."""

    pair: str
    mesh: str
    """Order, shape and elements across the contact width."""
    percent: float
    """The torque, in percent of the scene's."""
    quantity: str
    """As in excitation.csv."""
    figure: str
    """"positions", "mean", "peak to peak" or "harmonics"."""
    count: int
    """How many figures there are."""
    inside: int
    """Of them, those whose bar holds the true error."""
    decided: int
    """Those of which the reference is good enough to tell."""
    decided_inside: int
    error: float
    """Median true error, over the mean of the quantity, of peak-to-peak values and harmonics over the former."""
    bar: float
    """Median bar, likewise."""
    reference_error: float
    """By how much the reference itself may be off, likewise."""


def measure_bars(problem: BarProblem, percents: Sequence[float] = PERCENTS) -> Iterator[ExcitationRow]:
    """Four rows a case, torque and quantity. problem: of a pair without flank modifications, so that there is no
    unloaded transmission error."""
    at = scene_torques(_with_positions(problem.with_mesh(problem.reference)), percents)
    best, second = (_excitation(at, reference_mesh(problem, problem.halvings - last)) for last in (0, 1))
    exact, nearly = (list(pitch_curves(each, CoarseExcitation(None))) for each in (best, second))
    for case in problem.cases:
        loads = scene_torques(problem.with_mesh(case), percents)
        coarse = CoarseExcitation(_excitation(loads, companion_mesh), loads.scene.mesh.order, loads.elements)
        tried = pitch_curves(_excitation(loads, run_mesh), coarse)
        mesh = ", ".join(setting.split("=")[1] for setting in case)
        for percent, *curves in zip(sorted(percents), tried, exact, nearly):
            yield from _rows(problem.name, mesh, percent, *curves)


@dataclass(frozen=True, eq=False)
class Errors:
    """Figures of one kind, (k,) each."""

    value: Floats
    bar: Floats
    exact: Floats
    nearly: Floats
    """As the reference has them before its cells are halved for the last time."""

    def row(self, head: tuple[str, str, float, str], figure: str, over: float) -> ExcitationRow:
        """head: pair, mesh, torque and quantity. over: what errors are divided by."""
        error, doubt = np.abs(self.value - self.exact), np.abs(self.exact - self.nearly)
        inside, decided = error <= self.bar, np.abs(error - self.bar) > doubt
        counts = len(error), int(inside.sum()), int(decided.sum()), int((inside & decided).sum())
        medians = (float(np.median(each)) / over for each in (error, self.bar, doubt))
        return ExcitationRow(*head, figure, *counts, *medians)


def _rows(
    pair: str, mesh: str, percent: float, tried: Mapping[str, PitchCurve], exact: Mapping[str, PitchCurve],
    nearly: Mapping[str, PitchCurve],
) -> Iterator[ExcitationRow]:
    """All kinds of figures of all quantities under one torque."""
    for quantity, curve in tried.items():
        best, second = exact[quantity], nearly[quantity]
        head = pair, mesh, percent, quantity
        mean, size = (
            [np.array([figure(each.values)]) for each in (curve, best, second)] for figure in (np.mean, np.ptp)
        )
        positions = Errors(curve.values, curve.bars, best.values[::FINER], second.values[::FINER])
        yield positions.row(head, "positions", float(mean[1][0]))
        yield Errors(mean[0], np.array([curve.mean_error]), *mean[1:]).row(head, "mean", float(mean[1][0]))
        ranges = Errors(size[0], np.array([curve.peak_to_peak_error]), *size[1:])
        yield ranges.row(head, "peak to peak", float(size[1][0]))
        count = len(curve.harmonics[0])
        amplitudes = (each.harmonics[0][:count] for each in (best, second))
        harmonics = Errors(curve.harmonics[0], curve.amplitude_errors, *amplitudes)
        yield harmonics.row(head, "harmonics", float(size[1][0]))


def _with_positions(scene: Scene) -> Scene:
    """The scene at `FINER` times its positions."""
    return scene_from_text(scene.resolved_toml(), [f"sweep.positions={FINER * scene.sweep.positions}"])


def _excitation(loads: SceneTorques, mesh: Mesher) -> MeshExcitation:
    """On this rank alone."""
    angles = np.array(uniform_pitch(loads.problem.pair.pinion.z, loads.scene.sweep.positions).angles)
    with temporary_call() as call:
        loaded = loaded_pitch(call, loads, angles, Meshes(mesh))
    return MeshExcitation(np.zeros(len(angles)), loaded)
