"""Warnings of a finished run: what limits the accuracy of its figures, as sentences for the user."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from evolvent.gears.pressure.contact_cells import FEWEST_CELLS, FINER, SCATTER, few_cells
from evolvent.results.engagement import largest_peak
from evolvent.results.mesh_facts import MeshFacts
from evolvent.results.relief_kinks import largest_kink
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.summary_rows import FrictionRow
from evolvent.scene.chart_warnings import chart_warnings
from evolvent.scene.plain_text import brief, signed

WORST_CELL = 0.05
"""Smallest scaled Jacobian without a warning: hexahedra of a sector have 0.3 and more, tetrahedra cut from them
less."""
FEWEST_NARROW = 1.0
"""Fewest cells across the narrowest tenth of the contact without a warning: with fewer, peaks may be twice too
large."""
LARGE_BAR = 0.5
"""Ratio of error bar and figure above which the figure counts as unknown."""
SPACING_SAID = 0.03
"""Largest ratio of spacing error and figure without a warning."""
NAMES = {
    "max_pressure_MPa": ("largest pressure", " MPa"),
    "mean_pressure_MPa": ("mean pressure", " MPa"),
    "transmission_error_peak_to_peak_um": ("peak-to-peak transmission error", " µm"),
    "mesh_stiffness_N_per_mm_um": ("mesh stiffness", " N/(mm·µm)"),
    "loss_percent": ("loss", " % of the input"),
    "face_load_factor": ("face load factor", ""),
}
"""Key of a figure with an error bar -> its name and unit in messages; the secant stiffness follows the tangent."""

RELIEVE = "relieve the tips (tip_relief_um), or relieve them more"
"""Remedy against contact on tip edges."""


def warnings_of(run: RunData, mesh: MeshFacts) -> tuple[str, ...]:
    """Warnings of a finished run, a sentence each. mesh: quality of its meshes."""
    rows = friction_rows(run)
    about = (
        chart_warnings(run.scene),
        _about_the_load(run), _about_the_mesh(run, mesh), _about_tip_edges(run), _about_relief(run),
        _about_large_bars(rows), _about_error_bars(run), about_spacing(run, rows),
    )
    return tuple(sentence for each in about for sentence in each)


def _about_the_load(run: RunData) -> Iterator[str]:
    """Note that the load is the mesh force of a vibration, where it is one."""
    given = run.scene.dynamics
    if given is not None and given.operating_rpm is not None:
        yield (
            f"The load is the mesh force of the vibration at {given.operating_rpm:g} r/min, running {given.direction} "
            "to it: pressures, line loads and the transmission error, which is that at rest, are under the force of "
            "each position; Hertz's formula and the mean line load beside them are under the torque. Error bars are "
            "without that of the force."
        )


def _about_the_mesh(run: RunData, mesh: MeshFacts) -> Iterator[str]:
    """Warnings of few cells across the contact and of distorted cells."""
    cells, narrow = mesh.cells_across_contact_width, mesh.cells_across_narrow_contact
    if not run.is_line and not (cells >= FEWEST_CELLS and narrow >= FEWEST_NARROW):
        wide = f"{cells:.1f} elements wide (median; {narrow:.1f} in its narrowest tenth)"
        yield f"The contact is {wide}; {_few_cells(run)}"
    if not mesh.min_scaled_jacobian >= WORST_CELL:
        yield bad_cells(mesh.min_scaled_jacobian)


def bad_cells(quality: float) -> str:
    """The warning of a smallest scaled Jacobian below `WORST_CELL`."""
    return (
        f"The smallest scaled Jacobian of a cell is {quality:.1g}, below {WORST_CELL:g}: long thin cells, none of them "
        "inverted, but too stiff in bending, above all those of order 1; better cells are those of "
        'mesh.shape = "hexahedron".'
    )


def _few_cells(run: RunData) -> str:
    """The consequence of fewer cells than `FEWEST_CELLS` across the contact, with the error bar where there is one."""
    largest = np.array([largest_peak(run, index).pressure for index in range(len(run.frictions))])
    bars = np.array([run.errors.bar("max_pressure_MPa", index) for index in range(len(run.frictions))])
    if not np.isfinite(bar := float((100.0 * bars / largest).max())):
        return few_cells()
    return (
        f"below {FEWEST_CELLS:g}, pressures of single positions {SCATTER}; the largest one is known within its error "
        f"bar, {brief(bar)} %, but not where it occurs; for better ones {FINER}."
    )


def _about_tip_edges(run: RunData) -> Iterator[str]:
    """Warnings of contact on tip edges, and of a largest pressure at the limit of a tip-edge zone."""
    found = tip_edge_contact(run)
    if not found:
        return
    apart = "grows with mesh refinement, and is reported separately (edge_pressure_MPa)"
    yield f"{found}: the pressure there is singular, {'and not known' if run.is_line else apart}; {RELIEVE}."
    peaks = [largest_peak(run, index) for index in range(len(run.frictions))]
    if any(peak.at_zone_end for peak in peaks):
        ξ = next(peak.roll_distance for peak in peaks if peak.at_zone_end)
        yield (
            f"The largest pressure occurs where a tip-edge zone begins (ξ = {signed(ξ, 2)} mm) and rises further "
            "inside it: its value depends on the limit of the zone, and so on the mesh, and has no error bar; relieve "
            "the tips."
        )


def tip_edge_contact(run: RunData) -> str:
    """How often tip edges bear, and how much, as the beginning of a sentence; empty where none bears."""
    bears = [any(tooth.edge_pressure > 0.0 for solved in each for tooth in solved.teeth) for each in run.positions]
    if not any(bears):
        return ""
    share = max(_edge_share(solved) for each in run.positions for solved in each)
    return (
        f"Tip-edge contact at {sum(bears)} of {len(bears)} positions, on teeth with up to {brief(100.0 * share)} % of "
        "the load"
    )


def _edge_share(solved: SolvedPosition) -> float:
    """Largest share of the normal force on one tooth pair that bears on a tip edge; 0 where none does."""
    edges = [tooth.force for tooth in solved.teeth if tooth.edge_pressure > 0.0]
    return max(edges, default=0.0) / sum(tooth.force for tooth in solved.teeth)


def _about_relief(run: RunData) -> Iterator[str]:
    """Warning of a pressure over the start of a linear tip or root relief that exceeds the largest one away from it."""
    kinks = [
        kink for index in range(len(run.frictions))
        if (kink := largest_kink(run, index)) is not None and not kink.pressure <= largest_peak(run, index).pressure
    ]
    if not kinks:
        return
    kink = max(kinks, key=lambda kink: kink.pressure)
    yield (
        f"Where a linear {kink.relief} begins (ξ = {signed(kink.roll_distance, 2)} mm) the flank has a kink: over it "
        f"Hertz' pressure rises from {brief(kink.hertz)} to about {brief(kink.pressure)} MPa (kink_pressure_MPa), more "
        "than the largest pressure. That and the mean, with their error bars, are those away from relief starts, which "
        f"the contact of a tooth covers at {brief(100.0 * _covered(run))} % of its positions. The rise depends on how "
        f'sharp the kink is manufactured; take {kink.relief.replace(" ", "_")}_form = "parabolic".'
    )


def _covered(run: RunData) -> float:
    """Share of the positions of an engagement at which the contact covers the start of a linear relief, the largest of
    all friction coefficients."""
    return max(
        float(np.mean([tooth.kink_pressure > 0.0 for each in run.positions for tooth in each[index].teeth]))
        for index in range(len(run.frictions))
    )


def _about_large_bars(rows: Sequence[FrictionRow]) -> Iterator[str]:
    """Warning of figures with an error bar above `LARGE_BAR` of their value."""
    unknown = [text for row in rows for name in NAMES if (text := _unknown(row, name))]
    if unknown:
        yield (
            f"Not known, since the error bar exceeds half of the value: {', '.join(unknown)}; nor is where a largest "
            "pressure occurs. Take a finer mesh (mesh.level), or more positions (sweep.positions) where spacing_error "
            "is large."
        )


def _unknown(row: FrictionRow, name: str) -> str:
    """The figure with its error bar if that is too large, else an empty text."""
    value, bars = getattr(row, name), row.estimated_error
    if bars is None or not getattr(bars, name) > LARGE_BAR * abs(value) > 0.0:
        return ""
    label, unit = NAMES[name]
    return f"{label} {brief(value)} ± {brief(getattr(bars, name))}{unit} (μ = {row.friction:g})"


def _about_error_bars(run: RunData) -> Iterator[str]:
    """Warning of error bars that were asked for and could not be estimated."""
    if run.scene.output.error_bars and not run.errors.figures:
        yield f"There are no error bars. {run.errors.missing}"


def about_spacing(run: RunData, rows: Sequence[FrictionRow], names: Sequence[str] = tuple(NAMES)) -> Iterator[str]:
    """Warning of figures whose error is mostly due to the spacing of positions. names: keys of these figures."""
    figures = [text for name in names if (text := _spaced(max(rows, key=lambda row: _share(row, name)), name))]
    if figures:
        step = math.degrees(run.pitch) / len(run.positions)
        yield (
            f"Positions are {brief(step)}° apart, and this spacing causes "
            f"{'most of the error bars' if run.errors.figures else 'errors'}: {', '.join(figures)}; more positions "
            "(sweep.positions) reduce them."
        )


def _spaced(row: FrictionRow, name: str) -> str:
    """The spacing error of a figure if it is large and most of the error bar, else an empty text."""
    part, bars = getattr(row.spacing_error, name), row.estimated_error
    if not _share(row, name) > SPACING_SAID or (bars is not None and part < 0.5 * getattr(bars, name)):
        return ""
    label, unit = NAMES[name]
    return f"± {brief(part)}{unit} of the {label} ({brief(100.0 * _share(row, name))} %, μ = {row.friction:g})"


def _share(row: FrictionRow, name: str) -> float:
    """Ratio of spacing error and figure; 0 where either is unknown or the figure is zero."""
    part, value = getattr(row.spacing_error, name), getattr(row, name)
    return part / abs(value) if value and math.isfinite(part) else 0.0


def few_positions(row: FrictionRow) -> str:
    """Footnote for a picture of pressures with too few positions; empty where they are enough."""
    share = _share(row, "max_pressure_MPa")
    if not share > SPACING_SAID:
        return ""
    more = f"{brief(100.0 * share)} % larger"
    return f"For orientation only, positions are too few: between them pressures may be {more}."
