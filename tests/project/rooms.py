"""The rooms of the project, each behind those that it needs, with what each may import
(tests/project/test_structure.py)."""

from __future__ import annotations

FLOORS: tuple[tuple[str, ...], ...] = (
    ("meshes",), ("fem",), ("contact",), ("gears",), ("scene",), ("results",), ("strength", "dynamics", "wear"),
    ("check",), ("run",), ("commands",), ("evolvent",),
)
"""Rooms at the top of the tree, from the lowest floor to the highest."""

ROOMS: dict[str, tuple[str, ...]] = {
    "meshes": (),
    "meshes.mesh": ("meshes",),
    "meshes.gears.form": ("meshes",),
    "meshes.gears.modifications": ("meshes",),
    "meshes.gears": ("meshes", "meshes.gears.form", "meshes.gears.modifications"),
    "meshes.sector": ("meshes", "meshes.mesh", "meshes.gears"),
    "meshes.shapes": ("meshes", "meshes.mesh"),
    "fem.parallel": ("meshes",),
    "fem.backend": ("meshes", "meshes.mesh"),
    "fem": ("meshes", "meshes.mesh", "fem.parallel", "fem.backend"),
    "fem.condensation": ("meshes", "fem.parallel", "fem.backend"),
    "fem.cache": ("meshes", "fem.backend"),
    "contact": ("meshes",),
    "contact.search": ("meshes", "fem"),
    "contact.nitsche": ("meshes", "meshes.mesh", "fem", "contact.search"),
    "contact.newton": ("meshes", "fem.backend", "contact.nitsche"),
    "contact.two_level": ("meshes", "meshes.mesh", "fem", "fem.condensation", "fem.parallel", "contact.nitsche"),
    "contact.problem": ("meshes", "fem", "fem.backend", "fem.condensation", "contact.nitsche"),
    "contact.step": (
        "meshes", "meshes.mesh", "fem", "contact.search", "contact.nitsche", "contact.newton", "contact.problem",
    ),
    "contact.solution": ("meshes", "meshes.mesh", "fem", "contact.problem", "contact.step"),
    "contact.transient.time_schemes": ("meshes",),
    "contact.transient": (
        "meshes", "fem", "contact.newton", "contact.problem", "contact.step", "contact.transient.time_schemes",
    ),
    "gears.problem": ("meshes", "meshes.gears", "fem", "contact"),
    "gears.meshing": (
        "meshes", "meshes.mesh", "meshes.gears", "meshes.gears.modifications", "meshes.sector", "gears.problem",
    ),
    "gears.ring": ("meshes", "fem.condensation", "contact.nitsche", "contact.newton"),
    "gears.two_level": (
        "meshes", "meshes.mesh", "meshes.gears", "meshes.sector", "fem", "fem.parallel", "contact.newton",
        "contact.two_level", "gears.meshing", "gears.ring",
    ),
    "gears": (
        "meshes", "meshes.mesh", "meshes.gears", "meshes.sector", "fem", "fem.parallel", "fem.condensation",
        "fem.cache", "contact.nitsche", "gears.problem", "gears.meshing", "gears.ring", "gears.two_level",
    ),
    "gears.contact": (
        "meshes", "meshes.gears", "fem", "fem.parallel", "contact.search", "contact.nitsche", "contact.newton",
        "gears.ring", "gears.two_level", "gears",
    ),
    "gears.sweep": (
        "meshes", "meshes.gears", "fem.parallel", "contact.search", "contact.newton", "gears", "gears.contact",
    ),
    "gears.pressure": ("meshes", "meshes.gears", "fem", "contact", "gears", "gears.contact", "gears.sweep"),
    "gears.line": (
        "meshes", "meshes.gears", "fem", "fem.parallel", "contact", "contact.newton", "gears.problem", "gears.ring",
        "gears.two_level", "gears", "gears.contact", "gears.sweep", "gears.pressure",
    ),
    "gears.solution": (
        "meshes", "meshes.gears", "fem.backend", "contact.problem", "gears.problem", "gears.meshing", "gears",
        "gears.sweep", "gears.line",
    ),
    "scene.schema.guesses": (),
    "scene.schema": ("meshes", "meshes.gears.modifications", "scene.schema.guesses"),
    "scene": (
        "meshes", "meshes.gears", "meshes.gears.form", "meshes.gears.modifications", "fem", "contact.problem",
        "gears.problem", "gears.meshing", "scene.schema", "scene.schema.guesses",
    ),
    "results.archive": ("meshes.*", "scene", "gears", "gears.contact", "gears.sweep"),
    "results": (
        "meshes", "meshes.gears", "fem", "gears", "gears.sweep", "gears.pressure", "scene", "results.archive",
    ),
    "results.error_bars": ("meshes", "gears.line", "gears.solution", "results.archive", "results"),
    "results.tables": (
        "meshes", "meshes.gears", "gears.pressure", "gears.solution", "scene", "results.archive", "results",
        "results.error_bars",
    ),
    "results.fields": (
        "meshes", "meshes.mesh", "meshes.gears", "fem.*", "scene", "gears.ring", "gears.two_level", "gears",
        "gears.sweep", "gears.pressure", "results.archive", "results",
    ),
    "results.drawing": ("meshes", "meshes.gears", "scene", "results.archive", "results"),
    "results.figures": (
        "meshes", "meshes.gears", "gears.sweep", "gears.pressure", "scene", "results.archive", "results",
        "results.tables", "results.fields", "results.drawing",
    ),
    "results.solution": (
        "meshes", "meshes.gears", "contact.problem", "contact.step", "gears", "gears.sweep", "gears.pressure",
        "gears.solution", "results.drawing", "results.tables",
    ),
    "strength.standard": ("meshes", "meshes.gears"),
    "strength.fatigue": ("meshes", "gears.sweep", "gears.pressure"),
    "strength": (
        "meshes", "meshes.mesh", "meshes.gears", "fem", "fem.parallel", "gears.problem", "gears.meshing", "gears.ring",
        "gears.two_level", "gears", "gears.sweep", "gears.solution", "results.error_bars", "strength.standard",
    ),
    "strength.results": (
        "meshes", "meshes.gears", "fem", "results.error_bars", "results.tables", "results.drawing",
        "strength.standard", "strength.fatigue", "strength",
    ),
    "strength.solution": (
        "meshes", "meshes.gears", "fem", "fem.backend", "gears.problem", "gears.meshing", "gears", "gears.solution",
        "gears.sweep", "scene.schema", "results.solution", "strength.standard", "strength.fatigue", "strength",
        "strength.results",
    ),
    "dynamics.oscillator": ("meshes", "fem.backend"),
    "dynamics.excitation": (
        "meshes", "meshes.gears", "fem.parallel", "gears", "gears.line", "gears.sweep", "gears.solution",
        "dynamics.oscillator",
    ),
    "dynamics": (
        "meshes.*", "fem.parallel", "gears.problem", "gears.meshing", "gears", "gears.sweep", "scene.schema", "scene",
        "dynamics.oscillator", "dynamics.excitation",
    ),
    "dynamics.modes": (
        "meshes", "meshes.mesh", "meshes.gears", "meshes.sector", "fem.parallel", "fem", "fem.condensation",
        "fem.cache", "contact.nitsche", "gears.problem", "gears.meshing", "gears.two_level", "gears", "dynamics",
    ),
    "dynamics.transient": (
        "meshes", "meshes.gears", "fem.parallel", "contact.newton", "contact.transient.time_schemes", "gears.problem",
        "gears.ring", "gears", "gears.contact", "gears.sweep", "dynamics.oscillator", "dynamics", "dynamics.modes",
    ),
    "dynamics.results": (
        "meshes", "meshes.gears", "dynamics", "dynamics.excitation", "dynamics.oscillator", "results.error_bars",
        "results.tables", "gears.problem",
    ),
    "dynamics.results.transient": (
        "meshes", "gears", "gears.pressure", "gears.sweep", "dynamics.oscillator", "dynamics", "dynamics.transient",
        "results.error_bars", "results.tables", "dynamics.results",
    ),
    "dynamics.figures": (
        "meshes", "meshes.gears", "gears.pressure", "dynamics", "dynamics.oscillator",
        "dynamics.results.*", "results.tables", "results.drawing",
    ),
    "dynamics.solution": (
        "meshes", "meshes.gears", "fem", "gears.problem", "gears", "gears.solution", "gears.sweep", "results.solution",
        "dynamics.oscillator", "dynamics.excitation", "dynamics", "dynamics.results", "dynamics.figures",
    ),
    "wear": ("meshes", "meshes.mesh", "fem", "fem.backend", "fem.condensation", "contact.*"),
    "wear.gears": (
        "meshes", "meshes.mesh", "meshes.gears", "fem", "fem.parallel", "contact.newton", "gears.problem", "gears",
        "gears.contact", "gears.sweep", "gears.solution", "dynamics", "wear",
    ),
    "wear.results": (
        "meshes", "meshes.gears", "fem", "contact", "gears.problem", "gears.sweep", "gears.pressure", "scene",
        "results.*", "dynamics", "wear", "wear.gears",
    ),
    "check": (
        "meshes.gears", "meshes.gears.modifications", "fem.parallel", "gears.problem", "gears.meshing", "gears",
        "gears.line", "gears.sweep", "gears.pressure", "dynamics.oscillator", "dynamics.excitation", "dynamics",
        "dynamics.results", "strength.fatigue", "scene", "scene.schema",
    ),
    "run": (
        "meshes.*", "fem.backend", "fem.parallel", "gears.problem", "gears.meshing", "gears", "gears.sweep",
        "gears.line", "gears.solution", "dynamics", "check", "scene", "scene.schema", "results.*", "wear.*",
    ),
    "run.strength": (
        "meshes.gears", "gears.problem", "gears.meshing", "gears.sweep", "scene.schema", "scene", "results.archive",
        "results.tables", "strength.fatigue", "strength", "strength.results", "run",
    ),
    "run.dynamics": (
        "meshes", "fem.parallel", "gears.problem", "gears.meshing", "gears", "gears.sweep",
        "gears.solution", "scene", "scene.schema", "results.archive", "results.error_bars", "results.tables",
        "dynamics.*", "run",
    ),
    "run.dynamics.transient": (
        "meshes", "meshes.gears", "fem.parallel", "contact.transient.time_schemes", "gears.problem",
        "gears.meshing", "gears.sweep", "scene.schema", "scene", "results.archive", "results.tables",
        "dynamics.oscillator", "dynamics", "dynamics.modes", "dynamics.transient", "dynamics.results.transient",
        "check", "run",
    ),
    "run.design": (
        "meshes", "meshes.gears", "meshes.gears.modifications", "fem.parallel", "contact.newton", "gears",
        "gears.line", "gears.solution", "gears.sweep", "scene", "scene.schema", "results", "results.archive",
        "results.tables", "results.drawing",
        "dynamics.excitation", "dynamics.results", "run", "run.dynamics",
    ),
    "run.kinds": (
        "meshes", "meshes.mesh", "meshes.gears", "meshes.gears.modifications", "fem.parallel", "gears",
        "gears.line", "gears.pressure", "gears.problem", "gears.solution", "gears.sweep", "scene", "scene.schema",
        "results.*", "check", "dynamics.*", "strength.*", "wear.results", "run", "run.strength", "run.dynamics",
        "run.dynamics.transient", "run.design",
    ),
    "run.study.plan": (
        "gears", "gears.meshing", "gears.problem", "scene", "scene.schema", "results.archive", "run.dynamics",
        "run.strength", "run.kinds",
    ),
    "run.study.results": (
        "meshes", "meshes.gears", "scene", "check", "scene.schema", "scene.schema.guesses", "results.archive",
        "results.tables", "dynamics.results.*", "strength.fatigue", "strength.results", "run.study.plan",
    ),
    "run.study.figures": ("meshes", "results.drawing", "run.study.results"),
    "run.study": (
        "meshes", "fem.backend", "gears", "gears.sweep", "dynamics.excitation", "scene", "check", "results.archive",
        "results.drawing", "run", "run.dynamics", "run.kinds", "run.study.plan",
        "run.study.results", "run.study.figures", "dynamics",
    ),
    "commands": (
        "meshes", "meshes.mesh", "fem.backend", "fem.parallel", "fem.cache", "gears.meshing", "scene.*",
        "results.tables", "results.drawing", "wear", "run.*", "check",
    ),
    "evolvent": ("commands",),
}
"""Room -> what it may import. "meshes" is evolvent_meshes, "evolvent" its own files, "fem" evolvent.fem."""
