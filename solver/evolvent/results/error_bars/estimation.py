"""Error bars of the engineering figures, from a run and its coarse companion.

Each figure is computed from a curve over the engagement or over the pitch, and compared with that of the companion:
D and the rates p are those of `compared`.

- Transmission error, mesh stiffness and loss: D/(2^p − 1), Richardson's estimate, with the lowest convergence rate p of
  the benchmark pairs. First-order cells are too stiff in bending; their rate is below 1.
- Pressures converge erratically while the contact is a few elements wide. The error of a fitted peak for its line load
  is known without a finer mesh, by comparison with Hertz. The bar is D between fitted peaks and Hertz' peaks on the
  run's mesh, plus the error of the loads: D between the meshes of Hertz' peaks on the nominal contact lines, over
  2^p − 1. It is too wide where a flank departs from Hertz' assumptions, at the start of a relief or the end of a face.
  Both meshes are evaluated between the tip-edge zones of the run's mesh, as the figure is: on the companion's larger
  cells these zones are wider, but the loads within them are known. Where the largest pressure lies at the limit of such
  a zone it has no bar: how it changes with that limit is in neither estimate.
- Loss: plus the energy that the pitch does not balance, over the input. The work of friction is less than that of both
  torques by it, as normals are those before deflection (`certificates.pitch_imbalance`).
- Face load factor: D/(2^p − 1) as of the loads; the curves are those over the face, averaged over the layers of the
  companion. Where the load rises towards an end of the face the largest one is that of an end layer, and D is by how
  much it falls if the layer is twice as long: as much as the limit at the end of the face exceeds it.

The companion is solved at the run's positions or at every second one (`companion_pitch`), and meshes are compared at
the positions of both. With friction its steps are then twice as long, and what that changes is in D, too. The error of
sampling the pitch at the run's positions is estimated by `position_spacing` and added, and in line contact what it is
off by beside the resolved contact (`line_parts`). Errors of the model, such as effects that the scene leaves out, are
in none of them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan

import numpy as np

from evolvent.gears.solution.certificates import pitch_imbalance
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.error_bar_data import (
    LINE_METHOD,
    METHOD,
    EstimatedErrors,
    FigureErrors,
    requested_error_bars,
    summed_errors,
    write_error_bars,
)
from evolvent.results.engagement import engagement, largest_peak, with_hertz, with_line_loads
from evolvent.results.error_bars.compared import SHARING, STIFFNESS, Compared, Curve, Reduction, keys
from evolvent.results.error_bars.line_parts import line_parts
from evolvent.results.error_bars.position_spacing import PositionFigure, spacing_errors
from evolvent.results.face_load import FaceLoad, face_load
from evolvent.results.position_figures import loss_percent, mesh_stiffness, secant_stiffness, transmission_error_um
from evolvent.results.run_data import RunData


@dataclass(frozen=True)
class Companion:
    """The coarse companion of a run: the same scene on meshes of twice the element size, at the positions of the run or
    at every second one."""

    run: RunData | None
    """Results of the companion, on rank 0; None on other ranks and where its solution failed."""
    failure: str
    """Why the solution of the companion failed, as a sentence; empty where it did not."""
    seconds: float
    """Wall time of the solution [s]."""


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
        sums = [_of_figures(run, k, summed_errors(errors, spacing_errors(run, k))) for k, errors in enumerate(mesh)]
        if run.is_line:
            more = tuple(summed_errors(errors, line_parts(run, k)) for k, errors in enumerate(sums))
            return EstimatedErrors(more, LINE_METHOD, "")
        return EstimatedErrors(tuple(sums), METHOD, "")
    except (ValueError, IndexError) as error:  # a companion without these figures, as without any contact
        return EstimatedErrors(missing=f"The coarse companion's figures cannot be compared: {error}")


def _of_figures(run: RunData, index: int, errors: FigureErrors) -> FigureErrors:
    """Errors at the friction coefficient with this index, with what neither mesh nor spacing says: see above."""
    results = [each[index].result for each in run.positions[: run.scene.sweep.positions]]
    unbalanced = 100.0 * pitch_imbalance(results) if run.frictions[index] > 0.0 else 0.0
    known = nan if largest_peak(run, index).at_zone_end else errors.max_pressure_MPa
    return replace(errors, max_pressure_MPa=known, loss_percent=errors.loss_percent + unbalanced)


def errors_between(run: RunData, coarse: RunData) -> tuple[FigureErrors, ...]:
    """The part of the error bars that comes from the mesh, at each friction coefficient. coarse: the same scene on
    elements of twice the size, at some of its positions. Raises ValueError where none is common to both."""
    common = at_common_positions(run, coarse)
    return tuple(_errors(run, common, coarse, index) for index in range(len(run.frictions)))


def at_common_positions(run: RunData, coarse: RunData) -> RunData:
    """The run at the positions of its companion. Raises ValueError where it has none of them."""
    known = set(keys(coarse.angles))
    positions = tuple(each for each, key in zip(run.positions, keys(run.angles)) if key in known)
    if not positions:
        raise ValueError("no position is common to both")
    return replace(run, positions=positions)


def _errors(run: RunData, common: RunData, coarse: RunData, index: int) -> FigureErrors:
    """Errors of the mesh at the friction coefficient with this index. common: the run at the companion's positions."""
    hertz = run if run.is_line else with_hertz(run)  # there pressures are Hertz', with the curvatures of exact flanks
    runs = run, hertz, with_line_loads(common), with_line_loads(coarse)
    curves = [engagement(each, index, run.inner_path) for each in runs]
    stiffness, factor = STIFFNESS[run.scene.mesh.order], SHARING[run.scene.mesh.order]

    def over_pitch(value: PositionFigure, factor: float) -> Compared:
        own, other = (
            Curve(each.angles, np.array([value(each, at[index]) for at in each.positions])) for each in (common, coarse)
        )
        return Compared(own, other, factor)

    peaks = [Curve(*each.pressure_curve) for each in curves]
    means = [Curve(each.angle, each.mean_pressure) for each in curves]
    return FigureErrors(
        max_pressure_MPa=_pressure_error(np.nanmax, factor, *peaks),
        mean_pressure_MPa=_pressure_error(np.nanmean, factor, *means),
        transmission_error_peak_to_peak_um=over_pitch(transmission_error_um, stiffness).of_figure(np.ptp),
        mesh_stiffness_N_per_mm_um=over_pitch(mesh_stiffness, stiffness).of_figure(np.mean),
        secant_stiffness_N_per_mm_um=over_pitch(secant_stiffness, stiffness).of_figure(np.mean),
        loss_percent=over_pitch(loss_percent, factor).of_figure(np.mean),
        face_load_factor=_face_error(face_load(common, index), face_load(coarse, index), factor),
    )


def _pressure_error(figure: Reduction, factor: float, fitted: Curve, hertz: Curve, fine: Curve, coarse: Curve) -> float:
    """Error of the fitted peaks for the computed loads, plus the error of the loads. fine, coarse: peaks that
    depend on the line loads alone, on both meshes, tip edges included."""
    return Compared(fitted, hertz).of_figure(figure) + Compared(fine, coarse, factor).of_figure(figure)


def _face_error(fine: FaceLoad, coarse: FaceLoad, factor: float) -> float:
    """Error of the face load factor, with the root mean square of the loads averaged over the coarse layers."""
    layers = Compared(Curve(coarse.z, fine.on_layers(coarse.ends)), Curve(coarse.z, coarse.relative()), factor)
    return layers.of_value(fine.factor(), coarse.factor())
