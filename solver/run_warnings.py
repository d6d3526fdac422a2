"""What a reader has to know before trusting a number of a run: sentences that stand where numbers are printed."""

from __future__ import annotations

from collections.abc import Iterator

from solver.engagement import largest_peak
from solver.mesh_facts import MeshFacts
from solver.plain_text import signed
from solver.run_data import RunData
from solver.scene_warnings import FEWEST_CELLS, few_cells

WORST_CELL = 0.05
"""Least scaled Jacobian that needs no word: hexahedra of a sector have 0.3 and more, what is cut from them may not."""


def warnings_of(run: RunData, mesh: MeshFacts) -> tuple[str, ...]:
    """Of a finished run."""
    return tuple([*_about_the_mesh(run, mesh), *_about_tip_edges(run), *_about_error_bars(run)])


def _about_the_mesh(run: RunData, mesh: MeshFacts) -> Iterator[str]:
    cells = mesh.cells_across_contact_width
    if not cells >= FEWEST_CELLS:
        yield f"The contact is {cells:.1f} elements wide (median); {few_cells()}"
    if not mesh.min_scaled_jacobian >= WORST_CELL:
        yield bad_cells(mesh.min_scaled_jacobian)


def bad_cells(quality: float) -> str:
    """What a scaled Jacobian below `WORST_CELL` means."""
    return (
        f"The least scaled Jacobian of a cell is {quality:.1g}, below {WORST_CELL:g}: long thin cells, of which none "
        'is inverted, but which bend too little, above all of order 1; mesh.shape = "hexahedron" has better ones.'
    )


def _about_tip_edges(run: RunData) -> Iterator[str]:
    bears = [any(tooth.edge_pressure > 0.0 for solved in each for tooth in solved.teeth) for each in run.positions]
    if not any(bears):
        return
    yield (
        f"A tip edge bears at {sum(bears)} of {len(bears)} positions: the pressure there is singular, grows with every "
        "finer mesh, and is reported apart (edge_pressure_MPa); relieve the tips (tip_relief_um)."
    )
    peaks = [largest_peak(run, index) for index in range(len(run.frictions))]
    if any(peak.at_zone_end for peak in peaks):
        ξ = next(peak.ξ for peak in peaks if peak.at_zone_end)
        yield (
            f"The largest pressure stands where the zone of a tip edge begins (ξ = {signed(ξ, 2)} mm) and would be "
            "larger further in: its value depends on where that is, and so on the mesh; relieve the tips."
        )


def _about_error_bars(run: RunData) -> Iterator[str]:
    if run.scene.output.error_bars and not run.errors.figures:
        yield f"There are no error bars. {run.errors.missing}"
