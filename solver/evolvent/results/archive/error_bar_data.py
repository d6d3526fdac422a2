"""Error bars in the archive: one an engineering figure and friction coefficient, or the reason why there are none."""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass, fields

import numpy as np

from evolvent.results.archive.archive import Archive
from evolvent.results.archive.store import ArchiveError, Arrays
from evolvent.scene.skips import wanted_output

METHOD = (
    "difference to the same scene on meshes of twice the element size; of a pressure, between the tip-edge zones: "
    "difference to Hertz for the slices' own line loads, plus the difference of these loads between the meshes; plus, "
    "of all figures, what may lie between the positions (spacing_error); plus, of the loss, the energy that the pitch "
    "does not balance; none of a largest pressure at the limit of a tip-edge zone (max_pressure_at_zone_end); the "
    "largest pressure of a spur pair is that away from the starts of linear reliefs; where "
    "flanks have levels, what the reach of their patches leaves out is not in it (docs/two_level.md)"
)
"""Method of the error bars, as summary.json names it; bars archived with another method are estimated anew."""
LINE_METHOD = f"{METHOD}; plus what line contact is off by beside the resolved contact (docs/line_contact.md)"
"""Method of the error bars in line contact."""
FILE = "results/errors.npz"
FINER = 3
"""Largest number of additional decimals with which `plus_minus` prints."""


@dataclass(frozen=True)
class FigureErrors:
    """Estimated errors (≥ 0) of the figures with the same names in `summary_rows.FrictionRow`; NaN where unknown."""

    max_pressure_MPa: float
    """Error of the largest contact pressure."""
    mean_pressure_MPa: float
    """Error of the mean pressure."""
    transmission_error_peak_to_peak_um: float
    """Error of the peak-to-peak transmission error."""
    mesh_stiffness_N_per_mm_um: float
    """Error of the mesh stiffness."""
    secant_stiffness_N_per_mm_um: float
    """Error of the secant stiffness."""
    loss_percent: float
    """Error of the loss."""
    face_load_factor: float
    """Error of the face load factor."""


def summed_errors(one: FigureErrors, other: FigureErrors) -> FigureErrors:
    """Sum of two parts of the errors, figure by figure; NaN where a part is unknown."""
    return FigureErrors(*(a + b for a, b in zip(astuple(one), astuple(other))))


@dataclass(frozen=True)
class EstimatedErrors:
    """The error bars of a run."""

    figures: tuple[FigureErrors, ...] = ()
    """Errors at each friction coefficient, in the scene's order; empty where none were estimated."""
    method: str = ""
    """Method of the error bars; empty where none were estimated."""
    missing: str = "Error bars were not asked for."
    """Reason why there are no error bars, as a sentence; empty where there are some."""

    def bar(self, figure: str, index: int) -> float:
        """The error of a figure, a field of `FigureErrors`, at the friction coefficient with this index; NaN where
        there is none."""
        return float(getattr(self.figures[index], figure)) if self.figures else math.nan


NOT_ESTIMATED = EstimatedErrors()


def write_error_bars(archive: Archive, errors: EstimatedErrors) -> None:
    """Writes OUT/results/errors.npz if errors were estimated. Raises WriteError, FolderError."""
    if errors.figures:
        values = np.array([astuple(row) for row in errors.figures])
        archive.store.write(FILE, {"method": errors.method, "values": values})


def read_error_bars(archive: Archive) -> EstimatedErrors | None:
    """The errors that `write_error_bars` wrote; None where they are missing, unreadable, or belong to another scene,
    another method or other figures."""
    try:
        return archive.store.read(FILE, _errors)
    except ArchiveError:
        return None  # results are usable without error bars


def _errors(arrays: Arrays) -> EstimatedErrors | None:
    """Archived error bars; None where they were estimated with another method, or of other figures."""
    method, values = str(arrays["method"]), arrays["values"]
    if method not in (METHOD, LINE_METHOD) or values.shape[1] != len(fields(FigureErrors)):
        return None
    return EstimatedErrors(tuple(FigureErrors(*row.tolist()) for row in values), method, "")


def requested_error_bars(archive: Archive) -> EstimatedErrors | None:
    """The archived errors if the archive's scene asks for error bars; None otherwise."""
    return read_error_bars(archive) if wanted_output(archive.scene).error_bars else None


def plus_minus(value: float, bar: float, digits: int) -> str:
    """Value and bar as text, such as "2.60 ± 0.08", with the bar rounded up; the value alone where the bar is zero or
    unknown (NaN). digits: decimals, up to FINER more where the bar needs them: "0.6 ± 0.1" does not show a bar of
    0.003.
    """
    if not (math.isfinite(bar) and bar > 0.0):
        return f"{value:.{digits}f}"
    digits = min(max(digits, -math.floor(math.log10(bar))), digits + FINER)
    return f"{value:.{digits}f} ± {math.ceil(bar * 10**digits) / 10**digits:.{digits}f}"
