"""Error bars as a run keeps them: one for each engineering figure and friction coefficient, or why there is none."""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass, fields

import numpy as np

from evolvent.results.archive.archive import Archive, ArchiveError, read_arrays
from evolvent.scene.skips import wanted_output

METHOD = (
    "difference to the same scene on meshes of twice the element size; of a pressure, between the tip-edge zones: "
    "difference to Hertz for the slices' own line loads, plus the difference of these loads between the meshes; plus, "
    "of all figures, what may lie between the positions, on the start of a linear relief too (spacing_error)"
)


@dataclass(frozen=True)
class FigureErrors:
    """Estimated errors, not negative, of the figures of the same names in `results.FrictionRow`; NaN where a figure
    has none."""

    max_pressure_MPa: float
    """Of the largest contact pressure."""
    mean_pressure_MPa: float
    """Of the mean pressure."""
    transmission_error_peak_to_peak_um: float
    """Of the peak-to-peak transmission error."""
    mesh_stiffness_N_per_mm_um: float
    """Of the mesh stiffness."""
    secant_stiffness_N_per_mm_um: float
    """Of the secant stiffness."""
    loss_percent: float
    """Of the loss."""


def added(one: FigureErrors, other: FigureErrors) -> FigureErrors:
    """The sums of two parts; NaN where one is not known."""
    return FigureErrors(*(a + b for a, b in zip(astuple(one), astuple(other))))


@dataclass(frozen=True)
class EstimatedErrors:
    """figures: one per friction coefficient, in the scene's order; empty where none were estimated, and `missing` says
    why in a sentence. method: how they were estimated."""

    figures: tuple[FigureErrors, ...] = ()
    method: str = ""
    missing: str = "Error bars were not asked for."

    def bar(self, figure: str, index: int) -> float:
        """Of a figure of `FigureErrors` at friction coefficient number `index`; NaN where there is none."""
        return float(getattr(self.figures[index], figure)) if self.figures else math.nan


NOT_ESTIMATED = EstimatedErrors()


def keep_errors(archive: Archive, errors: EstimatedErrors) -> None:
    """Writes OUT/results/errors.npz, if there is something to keep. Raises OSError."""
    if errors.figures:
        values = np.array([astuple(row) for row in errors.figures])
        archive.keep("errors.npz", {"fingerprint": archive.fingerprint, "method": errors.method, "values": values})


def kept_errors(archive: Archive) -> EstimatedErrors | None:
    """What `keep_errors` kept of this scene; None where there is nothing, nothing that can be read, or bars of other
    figures or that were estimated in another way."""
    try:
        arrays = read_arrays(archive.folder / "errors.npz")
    except ArchiveError:
        return None  # a bar is no reason to refuse a run's results
    if (str(arrays["fingerprint"]), str(arrays["method"])) != (archive.fingerprint, METHOD):
        return None
    if arrays["values"].shape[1] != len(fields(FigureErrors)):
        return None
    return EstimatedErrors(tuple(FigureErrors(*row.tolist()) for row in arrays["values"]), str(arrays["method"]), "")


def wanted_errors(archive: Archive) -> EstimatedErrors | None:
    """What was kept, where the archive's scene asks for error bars; None otherwise."""
    return kept_errors(archive) if wanted_output(archive.scene).error_bars else None


FINER = 3


def plus_minus(value: float, bar: float, digits: int) -> str:
    """ "2.60 ± 0.08", the bar rounded up; the value alone where it is exact or its bar unknown (NaN). digits: decimals,
    up to FINER more where the bar needs them: in "0.6 ± 0.1" a bar of 0.003 cannot be seen."""
    if not (math.isfinite(bar) and bar > 0.0):
        return f"{value:.{digits}f}"
    digits = min(max(digits, -math.floor(math.log10(bar))), digits + FINER)
    return f"{value:.{digits}f} ± {math.ceil(bar * 10**digits) / 10**digits:.{digits}f}"
