"""Error bars of a run's figures, from the run and its coarse companion.

Each figure comes from a curve, over the engagement or over the pitch; two such figures may agree by chance, their
curves do not. So the difference D of a figure is the larger one of |Q_h − Q_2h| and of Q times the relative root mean
square difference of the curves.

- Transmission error, mesh stiffness and loss: D over 2^p − 1, which is Richardson's estimate, with the lowest rates p
  that the benchmark pairs have shown; first-order cells bend badly, so theirs is below 1.
- Pressures converge erratically while the contact is a few elements wide, but a fitted peak has a part that is known
  without a finer mesh: Hertz for the slice's own line load. The bar is the difference D of peaks and Hertz on the run's
  own mesh, plus D of Hertz's peaks between the meshes over 2^p − 1, which is the error of the loads. Where a flank is
  not Hertz's (a relief sets in, a face ends) it is too wide. Both meshes are compared between the tip-edge zones of the
  run's own mesh, as the figure is: the companion's larger cells see the edges from further away, but the loads beside
  them are known.

Both meshes stand at the same positions: how finely these sample the pitch is a part of its own (`spacing`), which is
added. What the scene leaves out is in none of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from evolvent.results.archive.archive import Archive
from evolvent.results.archive.error_bar_data import (
    METHOD,
    EstimatedErrors,
    FigureErrors,
    added,
    keep_errors,
    wanted_errors,
)
from evolvent.results.engagement import engagement, with_hertz
from evolvent.results.error_bars.position_spacing import spacing_errors
from evolvent.results.position_figures import loss_percent, mesh_stiffness, secant_stiffness, transmission_error_um
from evolvent.results.run_data import Companion, RunData
from evolvent_meshes.arrays import Floats

Reduction = Callable[[Floats], float]

STIFFNESS_FACTOR = {1: 2.0, 2: 0.5}
"""1/(2^p − 1) of transmission error and mesh stiffness by the order of the cells: p = 0.6 and 1.6."""
LOSS_FACTOR = {1: 2.0, 2: 1.0}
"""The same of the loss, which follows the distribution of pressure and tooth forces: p = 0.6 and 1."""
LOAD_FACTOR = {1: 2.0, 2: 1.0}
"""The same of the slices' loads, which pressures follow; with 1 at order 1 three bars of 24 were too small by 2 %."""


@dataclass(frozen=True)
class Curve:
    """What a figure is read from: values (n,) at pinion rotations [rad]; NaN where there is none."""

    at: Floats
    values: Floats


def with_errors(run: RunData, archive: Archive, companion: Companion | None) -> RunData:
    """The run with its error bars, where its scene asks for them: those in the archive, or the companion's, which are
    then kept. Raises OSError."""
    errors = wanted_errors(archive)
    if errors is None and companion is not None:
        errors = estimated_errors(run, companion)
        keep_errors(archive, errors)
    return replace(run, errors=errors or run.errors)


def estimated_errors(run: RunData, companion: Companion) -> EstimatedErrors:
    """The bars of all friction coefficients, or why there are none."""
    if companion.run is None:
        return EstimatedErrors(missing=companion.failure)
    try:
        mesh = errors_between(run, companion.run)
        return EstimatedErrors(tuple(added(own, spacing_errors(run, k)) for k, own in enumerate(mesh)), METHOD, "")
    except (ValueError, IndexError) as error:  # a companion too coarse to have the figures, as without any contact
        return EstimatedErrors(missing=f"The coarse companion's figures cannot be compared: {error}")


def errors_between(run: RunData, coarse: RunData) -> tuple[FigureErrors, ...]:
    """The mesh's part of the bars of `run`, one per friction coefficient; coarse: the same scene on elements of twice
    the size."""
    return tuple(_errors(run, coarse, index) for index in range(len(run.frictions)))


def _errors(run: RunData, coarse: RunData, index: int) -> FigureErrors:
    runs = run, with_hertz(run), *(with_hertz(each, at_edges=True) for each in (run, coarse))
    curves = [engagement(each, index, run.inner_path) for each in runs]
    error, tangent, secant, loss = (
        [Curve(each.angles, np.array([value(each, own[index]) for own in each.positions])) for each in (run, coarse)]
        for value in (transmission_error_um, mesh_stiffness, secant_stiffness, loss_percent)
    )
    peaks = [Curve(*each.pressure_curve) for each in curves]
    means = [Curve(each.angle, each.mean_pressure) for each in curves]
    order = run.scene.mesh.order
    return FigureErrors(
        max_pressure_MPa=_pressure_error(np.nanmax, LOAD_FACTOR[order], *peaks),
        mean_pressure_MPa=_pressure_error(np.nanmean, LOAD_FACTOR[order], *means),
        transmission_error_peak_to_peak_um=STIFFNESS_FACTOR[order] * difference(np.ptp, *error),
        mesh_stiffness_N_per_mm_um=STIFFNESS_FACTOR[order] * difference(np.mean, *tangent),
        secant_stiffness_N_per_mm_um=STIFFNESS_FACTOR[order] * difference(np.mean, *secant),
        loss_percent=LOSS_FACTOR[order] * difference(np.mean, *loss),
    )


def _pressure_error(figure: Reduction, factor: float, own: Curve, hertz: Curve, fine: Curve, coarse: Curve) -> float:
    """Of the profile at the loads found, plus that of the loads: Hertz's pressures for them, tip edges included."""
    return difference(figure, own, hertz) + factor * difference(figure, fine, coarse)


def difference(figure: Reduction, first: Curve, second: Curve) -> float:
    """The larger of the difference of a figure between two curves, and of the figure times the curves' relative root
    mean square difference where both have values; NaN where they have none in common."""
    value = float(figure(first.values))
    return max(abs(value - float(figure(second.values))), abs(value) * _relative(first, second))


def _relative(first: Curve, second: Curve) -> float:
    _, i, j = np.intersect1d(np.round(first.at, 9), np.round(second.at, 9), return_indices=True)
    one, other = first.values[i], second.values[j]
    known = np.isfinite(one) & np.isfinite(other)
    if not known.any():
        return float("nan")
    size = np.linalg.norm(one[known])
    return float(np.linalg.norm(one[known] - other[known]) / size) if size > 0.0 else 0.0
