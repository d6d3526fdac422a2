"""He's pair over the speed on rigid and on elastic gear bodies, from the same contact, for docs/he2022.md.

A part of `evidence.pages.papers.he_figures`.
"""

from __future__ import annotations

from itertools import product
from math import isnan
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from evidence.checkout import DEMOS
from evidence.pages.papers.he_runs import (
    COMMAND,
    RIGID,
    SURFACE,
    VIBRATION,
    HeRuns,
    Vibration,
    in_series,
    natural_square,
    series_setting,
)
from evidence.pages.papers.kept_runs import kept
from evidence.pages.papers.kept_runs.kept import Named
from evidence.tables import markdown
from evolvent.dynamics.modes.static_shapes import with_elastic_bodies
from evolvent.dynamics.of_scene import drive_settings
from evolvent.dynamics.small_system import SmallSystem, pair_system
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene

MODELS = "he2022/models.csv"
BODIES = "rigid", "elastic"
CASES = *BODIES, *(f"{bodies}_in_series" for bodies in BODIES)
PEAKS = 1500, 2000, 3000, 4000, 5000
"""Speeds [r/min] at which the peak-to-peak transmission error is told."""
WAYS = "up", "down"


def models(runs: HeRuns) -> Named:
    """(name, value) of each figure of the vibration on both kinds of bodies, without and with the compliance in series
    that puts either at the paper's resonance. Raises RunFailed."""
    scene = load_scene(DEMOS / VIBRATION.removeprefix("demos/"))
    facts = Vibration.read(runs.run("dynamics", SURFACE, VIBRATION, RIGID)).facts
    stiffness = facts["mean_stiffness_N_per_um"]
    wanted = 1e-6 * facts["equivalent_mass_kg"] * natural_square(scene)
    series = dict(zip(BODIES, (in_series(wanted, stiffness), _series_on_bodies(_bodies(scene), scene, stiffness))))
    histories = f"dynamics.histories_rpm={list(PEAKS)}"
    for bodies, compliance in series.items():
        yield f"{bodies}_series_N_per_um", compliance
        for name, more in ((bodies, ()), (f"{bodies}_in_series", (series_setting(compliance),))):
            case = runs.vibration(f"model_{name}", f'dynamics.bodies="{bodies}"', histories, *more)
            yield from case.figures(name)
            for speed, way in product(PEAKS, WAYS):
                yield f"{name}_{way}_{speed}_um", float(np.ptp(case.motion(speed, way)["transmission_error_um"]))


def _bodies(scene: Scene) -> SmallSystem:
    """Both gears with the scene's inertia."""
    section, problem = scene.dynamics, gear_problem(scene)
    assert section is not None
    settings = with_elastic_bodies(drive_settings(problem.pair, section), problem, section.density)
    assert settings.bodies is not None
    return pair_system(*(gear.with_inertia(own) for gear, own in zip(settings.bodies, settings.inertias)))


def _series_on_bodies(system: SmallSystem, scene: Scene, stiffness: float) -> float:
    """Stiffness in series [N/µm] with which the natural speed on elastic bodies is the paper's.

    stiffness: of the mesh, mean [N/µm]. What it gives way beyond the bodies between held bores, together with the
    series compliance, has to have the stiffness on which the small system has that natural frequency.
    """
    between, square = system.closing - system.reading, natural_square(scene)
    held = system.compliance(between, between)
    stiffest = 1.0 / (1e-3 / stiffness - held)
    local = brentq(lambda k: system.natural(k)[0] ** 2 / square - 1.0, 1e-2 * stiffest, stiffest)
    return 1e-3 / (1.0 / float(local) + held - 1e-3 / stiffness)


def models_table(docs: Path) -> str:
    """Both kinds of bodies side by side, without and with their series compliance."""
    f = kept.kept(docs / MODELS, COMMAND)

    def line(what: str, figure: str, form: str) -> tuple[str, ...]:
        values = [f[f"{case}_{figure}"] for case in CASES]
        return what, *("none" if isnan(value) else format(value, form) for value in values)

    rows = [
        line("natural speed [r/min]", "natural_rpm", ".0f"),
        line("fastest jump running up [r/min]", "jump_up_rpm", ".0f"),
        line("fastest jump running down [r/min]", "jump_down_rpm", ".0f"),
        line("largest mesh force over the static one", "force_ratio", ".2f"),
        line("out of contact, at most [% of the time]", "separated_percent", ".0f"),
        line("largest equivalent amplitude [µm]", "amplitude_um", ".1f"),
        *(
            line(f"transmission error at {speed} r/min, peak to peak, running {way} [µm]", f"{way}_{speed}_um", ".2f")
            for speed, way in product(PEAKS, WAYS)
        ),
    ]
    heads = [f"{bodies} bodies" for bodies in BODIES]
    heads += [f"{bodies} bodies, {f[f'{bodies}_series_N_per_um']:.0f} N/µm in series" for bodies in BODIES]
    return markdown(("", *heads), rows, range(1, len(heads) + 1))
