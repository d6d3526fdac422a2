"""The pitch in line contact under the scene's torque, for `evolvent check --contact`: in seconds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from mpi4py import MPI

from evolvent.check.text_table import Row, table
from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh
from evolvent.dynamics.results.curves import LOADED, TANGENT, CoarseExcitation, pitch_curves
from evolvent.dynamics.results.line_facts import line_facts
from evolvent.gears.gear_model import Mesher, prepare_model
from evolvent.gears.line.line_gears import MOST_ON_EDGES
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.plain_text import fixed
from evolvent.scene.scene import Scene
from evolvent.scene.skips import line_scene

POSITIONS = 60
"""Least number of positions of the pitch: with 20, peak-to-peak values of Yang's pair ripple by 2 %."""
EDGES = (
    "  Edges of tips bear, which is no line contact: relieve the tips (tip_relief_um), or resolve the contact by\n"
    "  `evolvent run`."
)


def contact_table(scene: Scene) -> str:
    """Figures of the pitch in line contact without friction, under the scene's torque, with their estimated errors;
    without figures where edges of tips bear.

    Raises MeshError, NotConverged, TooWide, NotPositiveDefinite, OutOfMemory, NoForceSurface.
    """
    problem, count = gear_problem(line_scene(scene)), max(POSITIONS, scene.sweep.positions)
    angles = np.array(uniform_pitch(scene.pinion.teeth, count).angles)
    unloaded = unloaded_error(RigidFlanks(problem.pair, problem.flanks), angles, problem.torque_on)

    def solved(mesh: Mesher) -> MeshExcitation:
        model = prepare_model(problem, MPI.COMM_SELF, mesh).model
        return MeshExcitation(unloaded, loaded_mesh(model, [problem.torque], angles, MPI.COMM_SELF))

    excitation = solved(run_mesh)
    assert excitation.loaded.line is not None
    on_edges = 100.0 * float(excitation.loaded.line.on_edges.max())
    rows = [
        Row("positions of the pitch", "", "", (str(count),)),
        Row("load on edges of tips, at most", "", "%", (fixed(on_edges, 2),)),
    ]
    title = "Contact (line contact on the elastic gears, no friction)"
    if on_edges > 100.0 * MOST_ON_EDGES:
        return f"{table(title, rows)}\n{EDGES}"
    return table(title, [*rows, *_figures(excitation, solved(companion_mesh))], ("", "± error"))


def _figures(excitation: MeshExcitation, coarse: MeshExcitation) -> Iterator[Row]:
    """Figures under the only torque, with their errors. coarse: on the companion's meshes."""
    companion = CoarseExcitation(coarse)
    curves, facts = next(iter(pitch_curves(excitation, companion))), line_facts(excitation, companion)
    error, stiffness, factor = curves[LOADED], curves[TANGENT], facts.face_load_factor[0]
    pressure = facts.largest_pressure_MPa[0], facts.largest_pressure_MPa_error[0]
    for name, symbol, unit, digits, value, bar in (
        ("transmission error, mean", "", "µm", 2, np.mean(error.values), error.mean_error),
        ("transmission error, peak to peak", "", "µm", 2, np.ptp(error.values), error.peak_to_peak_error),
        ("tangent mesh stiffness, mean", "c", "N/µm", 1, np.mean(stiffness.values), stiffness.mean_error),
        ("face load factor", "K_Hβ", "", 2, factor, facts.face_load_factor_error[0]),
        ("Hertzian pressure away from edges, kinks", "p_0", "MPa", 0, *pressure),
    ):
        if not np.isnan(value):  # gears in the plane have no face load factor
            yield Row(name, symbol, unit, (fixed(float(value), digits), fixed(float(bar), digits)))
