"""Error bars of the engineering figures, from a run and its coarse companion.

Each figure Q is computed from a curve over the engagement or over the pitch. Figures on two meshes may agree by chance
where their curves do not. The difference D of a figure is therefore the larger of |Q_h − Q_2h| and of Q times the
relative root mean square difference of the curves.

- Transmission error, mesh stiffness and loss: D/(2^p − 1), Richardson's estimate, with the lowest convergence rate p of
  the benchmark pairs. First-order cells are too stiff in bending; their rate is below 1.
- Pressures converge erratically while the contact is a few elements wide. The error of a fitted peak for its line load
  is known without a finer mesh, by comparison with Hertz. The bar is D between fitted peaks and Hertz' peaks on the
  run's mesh, plus the error of the loads: D between the meshes of Hertz' peaks on the nominal contact lines, over
  2^p − 1. It is too wide where a flank departs from Hertz' assumptions, at the start of a relief or the end of a face.
  Both meshes are evaluated between the tip-edge zones of the run's mesh, as the figure is: on the companion's larger
  cells these zones are wider, but the loads within them are known.

- Face load factor: D/(2^p − 1) as of the loads; the curves are those over the face, averaged over the layers of the
  companion. Where the load rises towards an end of the face the largest one is that of an end layer, and D is by how
  much it falls if the layer is twice as long: as much as the limit at the end of the face exceeds it.

Both meshes are solved at the same positions. The error of sampling the pitch at these positions is estimated by
`position_spacing` and added. Errors of the model, such as effects that the scene leaves out, are in neither.
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
    requested_error_bars,
    summed_errors,
    write_error_bars,
)
from evolvent.results.engagement import engagement, with_hertz, with_line_loads
from evolvent.results.error_bars.position_spacing import spacing_errors
from evolvent.results.face_load import FaceLoad, face_load
from evolvent.results.position_figures import loss_percent, mesh_stiffness, secant_stiffness, transmission_error_um
from evolvent.results.run_data import RunData
from evolvent_meshes.arrays import Floats

Reduction = Callable[[Floats], float]
"""Function from the values (n,) of a curve to a figure."""

STIFFNESS_FACTOR = {1: 2.0, 2: 0.5}
"""Order of the cells -> 1/(2^p − 1) for transmission error and mesh stiffness; p = 0.6 and 1.6."""
LOSS_FACTOR = {1: 2.0, 2: 1.0}
"""The same for the loss, which depends on the distribution of pressure and of tooth forces; p = 0.6 and 1."""
LOAD_FACTOR = {1: 2.0, 2: 1.0}
"""The same for the loads of slices and over the face; with 1 at order 1, 3 of 24 bars of pressures were too small, by
2 %."""


@dataclass(frozen=True)
class Curve:
    """A curve from which a figure is computed."""

    angle: Floats
    """(n,) pinion rotation [rad]."""
    values: Floats
    """(n,) values in the figure's unit; NaN where unknown."""


@dataclass(frozen=True)
class Companion:
    """The coarse companion of a run: the same scene and positions on meshes of twice the element size."""

    run: RunData | None
    """Its results, on rank 0; None on other ranks and where its solution failed."""
    failure: str
    """Why its solution failed, as a sentence; empty where it did not."""
    seconds: float
    """Wall time of its solution [s]."""


def with_errors(run: RunData, archive: Archive, companion: Companion | None) -> RunData:
    """The run with its error bars: those in the archive, or those estimated from the companion, which are then
    archived; none where its scene does not ask for them. Raises WriteError, FolderError."""
    errors = requested_error_bars(archive)
    if errors is None and companion is not None:
        errors = estimated_errors(run, companion)
        write_error_bars(archive, errors)
    return replace(run, errors=errors or run.errors)


def estimated_errors(run: RunData, companion: Companion) -> EstimatedErrors:
    """The error bars at all friction coefficients, or the reason why there are none."""
    if companion.run is None:
        return EstimatedErrors(missing=companion.failure)
    try:
        mesh = errors_between(run, companion.run)
        parts = [(errors, spacing_errors(run, k)) for k, errors in enumerate(mesh)]
        return EstimatedErrors(tuple(summed_errors(*each) for each in parts), METHOD, "")
    except (ValueError, IndexError) as error:  # a companion without these figures, as without any contact
        return EstimatedErrors(missing=f"The coarse companion's figures cannot be compared: {error}")


def errors_between(run: RunData, coarse: RunData) -> tuple[FigureErrors, ...]:
    """The part of the error bars that comes from the mesh, at each friction coefficient. coarse: the same scene on
    elements of twice the size."""
    return tuple(_errors(run, coarse, index) for index in range(len(run.frictions)))


def _errors(run: RunData, coarse: RunData, index: int) -> FigureErrors:
    """Errors of the mesh at the friction coefficient with this index."""
    runs = run, with_hertz(run), with_line_loads(run), with_line_loads(coarse)
    curves = [engagement(each, index, run.inner_path) for each in runs]
    error, tangent, secant, loss = (
        [Curve(each.angles, np.array([value(each, at[index]) for at in each.positions])) for each in (run, coarse)]
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
        face_load_factor=LOAD_FACTOR[order] * _face_difference(face_load(run, index), face_load(coarse, index)),
    )


def _pressure_error(figure: Reduction, factor: float, fitted: Curve, hertz: Curve, fine: Curve, coarse: Curve) -> float:
    """Error of the fitted peaks for the computed loads, plus the error of the loads. fine, coarse: peaks that
    depend on the line loads alone, on both meshes, tip edges included."""
    return difference(figure, fitted, hertz) + factor * difference(figure, fine, coarse)


def _face_difference(fine: FaceLoad, coarse: FaceLoad) -> float:
    """Difference D of the face load factor, with the root mean square of the loads averaged over the coarse layers."""
    curves = Curve(coarse.z, fine.on_layers(coarse.ends)), Curve(coarse.z, coarse.relative())
    value = fine.factor()
    return max(abs(value - coarse.factor()), value * relative_difference(*curves))


def difference(figure: Reduction, first: Curve, second: Curve) -> float:
    """Difference D of a figure between two curves: the larger of |Q_1 − Q_2| and of |Q_1| times the relative root mean
    square difference of the curves where both are known; NaN where no rotation is common to both."""
    value = float(figure(first.values))
    return max(abs(value - float(figure(second.values))), abs(value) * relative_difference(first, second))


def relative_difference(first: Curve, second: Curve) -> float:
    """Root mean square difference of two curves over that of the first, at their common rotations; NaN without any."""
    _, i, j = np.intersect1d(np.round(first.angle, 9), np.round(second.angle, 9), return_indices=True)
    one, other = first.values[i], second.values[j]
    known = np.isfinite(one) & np.isfinite(other)
    if not known.any():
        return float("nan")
    size = np.linalg.norm(one[known])
    return float(np.linalg.norm(one[known] - other[known]) / size) if size > 0.0 else 0.0
