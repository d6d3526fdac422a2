"""Warnings on the accuracy of a scene, before anything is computed; `evolvent check` ends with them."""

from __future__ import annotations

from collections.abc import Iterator

from evolvent.check.design_rows import design_warnings
from evolvent.check.load_rows import load_warnings
from evolvent.check.transient_rows import transient_warnings
from evolvent.gears.meshing.element_sizes import (
    STIFF_ELEMENTS,
    elements_per_contact_width,
    has_stiff_pinion,
    sector_resolutions,
)
from evolvent.gears.meshing.levelled_meshes import is_two_level
from evolvent.gears.meshing.modifications import folding_warnings, modification_warnings, tip_edge_warnings
from evolvent.gears.meshing.undercut import undercut_warnings
from evolvent.gears.pressure.contact_cells import FEWEST_CELLS, few_cells
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.scene.chart_warnings import chart_warnings
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dependence import effectless_keys
from evolvent.scene.vibration_limits import doubtful


def flank_warnings(problem: GearProblem) -> Iterator[str]:
    """Warnings on flanks and tips, one sentence each, before anything is computed."""
    yield from (*undercut_warnings(problem), *modification_warnings(problem), *tip_edge_warnings(problem))


def scene_warnings(scene: Scene) -> Iterator[str]:
    """The warnings on a scene, one sentence each."""
    yield from chart_warnings(scene)
    yield from effectless_keys(scene)
    problem = gear_problem(scene)
    if not problem.is_line:
        yield from _width_warnings(problem)
    if scene.mesh.shape == "tetrahedron":
        yield (
            "Tetrahedra are cut from hexahedra that are long over the face and in the body: their scaled Jacobian "
            "falls to 1e-3 and below, and those of order 1 are too stiff in bending; hexahedra of order 2 are the "
            "better choice."
        )
    yield from transient_warnings(scene)
    yield from load_warnings(scene)
    yield from design_warnings(scene)
    if scene.dynamics is not None:
        from evolvent.check.vibration_rows import vibration_warnings  # Numba takes a second to import

        yield from vibration_warnings(scene)
    if scene.dynamics is not None or scene.transient is not None:
        yield from (f"{each}." for each in doubtful(scene.planned_vibration()))
    yield from flank_warnings(problem)
    if not (is_two_level(problem) or problem.is_line):  # coarse sectors have no modifications
        yield from folding_warnings(problem, sector_resolutions(problem))


def _width_warnings(problem: GearProblem) -> Iterator[str]:
    """Warnings on the elements across the width of the contact."""
    count = elements_per_contact_width(problem)
    if count < FEWEST_CELLS:
        yield f"The contact will be about {count:.1f} elements wide; {few_cells()}"
    if count < STIFF_ELEMENTS and has_stiff_pinion(problem):
        yield (
            "The pinion, which carries the pressure, is much stiffer than the wheel: with fewer than "
            f"{STIFF_ELEMENTS:g} elements across the contact single pressures may be several times too large; leave "
            "mesh.elements_per_contact_width out, or make the softer gear the pinion."
        )
