"""The pitch in line contact under the scene's torque, for `evolvent check --contact`: in seconds."""

from __future__ import annotations

import numpy as np
from mpi4py import MPI

from evolvent.check.text_table import Row, table
from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.line.line_gears import MOST_ON_EDGES
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
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
    """Figures of the pitch in line contact without friction, under the scene's torque; without figures where edges of
    tips bear.

    Raises MeshError, NotConverged, TooWide, NotPositiveDefinite, OutOfMemory.
    """
    problem, count = gear_problem(line_scene(scene)), max(POSITIONS, scene.sweep.positions)
    model = prepare_model(problem, MPI.COMM_SELF).model
    angles = np.array(uniform_pitch(scene.pinion.teeth, count).angles)
    mesh = loaded_mesh(model, [problem.torque], angles, MPI.COMM_SELF)
    assert mesh.line is not None
    on_edges = 100.0 * float(mesh.line.on_edges.max())
    rows = [
        Row("positions of the pitch", "", "", (str(count),)),
        Row("load on edges of tips, at most", "", "%", (fixed(on_edges, 2),)),
    ]
    title = "Contact (line contact on the elastic gears, no friction)"
    if on_edges > 100.0 * MOST_ON_EDGES:
        return f"{table(title, rows)}\n{EDGES}"
    error, line = 1e3 * mesh.errors, mesh.line
    face = [] if line.is_plane else [("face load factor", "K_Hβ", "", 2, float(line.face_load_factor[0]))]
    figures = (
        ("transmission error, mean", "", "µm", 2, float(np.mean(error))),
        ("transmission error, peak to peak", "", "µm", 2, float(np.ptp(error))),
        ("tangent mesh stiffness, mean", "c", "N/µm", 1, 1e-3 * float(np.mean(mesh.stiffness))),
        *face,
        ("Hertzian pressure away from edges, kinks", "p_0", "MPa", 0, float(line.largest_pressure_MPa[0])),
    )
    rows += [Row(name, symbol, unit, (fixed(value, digits),)) for name, symbol, unit, digits, value in figures]
    return table(title, rows)
