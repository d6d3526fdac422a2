"""The pitch in line contact under the scene's torque, for `evolvent check --contact`: in seconds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent.check.text_table import Row, table
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.line.line_gears import MOST_ON_EDGES, LineGears
from evolvent.gears.line.line_pitch import LinePitch
from evolvent.gears.problem.gear_problem import GearOptions, MeshSettings
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.plain_text import fixed
from evolvent.scene.scene import Scene

EDGES = (
    "  Edges of tips bear, which is no line contact: relieve the tips (tip_relief_um), or resolve the contact by\n"
    "  `evolvent run`."
)


def contact_table(scene: Scene) -> str:
    """Figures of the pitch in line contact without friction, under the scene's torque; without figures where edges of
    tips bear.

    Raises MeshError, NotConverged, TooWide, NotPositiveDefinite, OutOfMemory.
    """
    problem = gear_problem(scene)
    in_space = GearOptions(in_space=problem.options.in_space)
    model = prepare_model(replace(problem, mesh=MeshSettings("line"), options=in_space)).model
    gears, angles = LineGears.of(model), uniform_pitch(scene.pinion.teeth, scene.sweep.positions).angles
    force = problem.torque / model.base_radius / model.width_factor
    pitch = LinePitch.of(gears, [gears.position(angle) for angle in angles], force)
    on_edges = 100.0 * float(pitch.on_edges.max())
    rows = [
        Row("positions of the pitch", "", "", (str(len(angles)),)),
        Row("load on edges of tips, at most", "", "%", (fixed(on_edges, 2),)),
    ]
    title = "Contact (line contact on the elastic gears, no friction)"
    if on_edges > 100.0 * MOST_ON_EDGES:
        return f"{table(title, rows)}\n{EDGES}"
    error, stiffness = 1e3 * pitch.transmission_error, 1e-3 * pitch.stiffness * model.width_factor
    figures = (
        ("transmission error, mean", "", "µm", 3, float(np.mean(error))),
        ("transmission error, peak to peak", "", "µm", 3, float(np.ptp(error))),
        ("tangent mesh stiffness, mean", "c", "N/µm", 1, float(np.mean(stiffness))),
        ("face load factor", "K_Hβ", "", 3, pitch.face_load_factor),
        ("largest pressure by Hertz, without tips", "p_0", "MPa", 0, pitch.peak_pressure),
    )
    rows += [Row(name, symbol, unit, (fixed(value, digits),)) for name, symbol, unit, digits, value in figures]
    return table(title, rows)
