"""`python -m evidence.pages.papers.he_transient --out DIR`: He's pair by transient contact beside the torsional model.

For docs/he2022.md: at speeds from a superharmonic to beyond the resonance, with the natural modes of both bodies
beside the torsional model on elastic ones, and without modes beside that on rigid ones; how the motion depends on the
number of modes; and the natural speed over the bore. Runs that an earlier call has ended are read again. `python -m
evidence.pages` then writes the page.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from evidence.checkout import DEMOS, DOCS
from evidence.pages.papers.he_runs import Vibration
from evidence.pages.papers.kept_runs import kept
from evidence.pages.papers.kept_runs.kept import Named
from evidence.pages.papers.kept_runs.runs import Runs, keep_figures
from evidence.processes import module_run
from evidence.tables import markdown

KEPT = "he2022/transient.csv"
COMMAND = "python -m evidence.pages.papers.he_transient --out DIR"
SPEEDS = 1500, 2000, 2200, 3000, 4000, 5000
"""r/min; the superharmonic of half the natural speed lies near 2200, the resonance near 4300."""
COUNTS = 0, 1, 3, 5, 20
"""Modes of each harmonic of the ring."""
CONVERGED = 2000
"""r/min."""
SETTINGS = "mesh.level=quick", "sweep.positions=80", "output.error_bars=false", "output.animation=false"
WAYS = {"up": "running up", "down": "running down"}
BODIES = {"rigid": "no modes", "elastic": "modes of both bodies"}
"""Bodies of the torsional model, and what the transient beside it has of them."""
BORES = 36, 40, 70, 100
"""mm."""
RESOLVING, STEPS = 2200, (16, 20, 40, 80)
"""r/min near a superharmonic, and time steps a mesh period there."""
SMEARED, SPACINGS = 1600, (10, 20, 40, 80)
"""The same where few steps smear a vibration, for docs/transient_method.md."""
OWN_INERTIA = "own_inertia.toml"
"""The scene with the inertia of the gears as drawn, which changes with the bore."""


def figures(runs: Runs) -> Named:
    """(name, value) of each figure. Raises RunFailed."""
    yield from _torsional(runs)
    for name, more in (("modes", ()), ("rigid", ("transient.modes_per_harmonic=0",))):
        facts = _transient(runs, name, _at(SPEEDS), *more)
        for speed, fact in zip(SPEEDS, facts):
            yield from _motion(f"{name}_{speed}", fact)
        yield f"{name}_natural_rpm", _natural_rpm(facts[-1])
    yield from _bores(runs)
    for positions in STEPS:
        (fact,) = _transient(runs, f"steps_{positions}", _at([RESOLVING]), f"sweep.positions={positions}")
        yield from _motion(f"steps_{positions}", fact)
        yield f"steps_{positions}_a_period", fact["steps_per_natural_period"]
    for positions in SPACINGS:
        (fact,) = _transient(runs, f"smeared_{positions}", _at([SMEARED]), f"sweep.positions={positions}")
        yield from _motion(f"smeared_{positions}", fact)
    for count in COUNTS:
        (fact,) = _transient(runs, f"count_{count}", f"transient.speeds_rpm=[{CONVERGED}]",
                             f"transient.modes_per_harmonic={count}", "transient.steady_change=0.0005")
        yield from _motion(f"count_{count}", fact)
        yield f"count_{count}_modes", fact["modes"]


def _at(speeds: Sequence[float]) -> str:
    return f"transient.speeds_rpm={[round(speed, 3) for speed in speeds]}"


def _natural_rpm(fact: Mapping[str, float]) -> float:
    """Speed at which the mesh frequency is the pair's own."""
    return fact["natural_frequency_Hz"] / fact["mesh_frequency_Hz"] * fact["speed_rpm"]


def _bores(runs: Runs) -> Named:
    """The natural speed with modes and without, by the gears' own inertia."""
    text = (DEMOS / "he2022_dynamics.toml").read_text(encoding="utf-8").splitlines()
    scene = runs.out / OWN_INERTIA
    scene.write_text("\n".join(line for line in text if "_inertia_kg_m2" not in line) + "\n", encoding="utf-8")
    for bore in BORES:
        gears = f"pinion.bore_diameter_mm={bore}", f"wheel.bore_diameter_mm={bore}", "transient.mesh_periods=2"
        for name, more in (("modes", ()), ("rigid", ("transient.modes_per_harmonic=0",))):
            (fact,) = _transient(runs, f"bore_{bore}_{name}", _at([SPEEDS[-1]]), *gears, *more, scene=scene)
            yield f"bore_{bore}_{name}_rpm", _natural_rpm(fact)


def _transient(
    runs: Runs, name: str, *settings: str, scene: Path = DEMOS / "he2022_dynamics.toml"
) -> list[dict[str, Any]]:
    set_to = [f"--set={each}" for each in (*SETTINGS, "transient.mesh_periods=200", *settings)]
    words = module_run("evolvent", "transient", scene, "--quiet", "--overwrite", *set_to)
    folder, _ = runs.ended(name, "transient.json", *words)
    facts: list[dict[str, Any]] = json.loads((folder / "transient.json").read_text(encoding="utf-8"))
    return facts


def _motion(name: str, fact: dict[str, Any]) -> Named:
    yield f"{name}_um", fact["peak_to_peak_um"]
    yield f"{name}_factor", fact["dynamic_factor"]
    yield f"{name}_apart_percent", 100.0 * fact["separated"]
    yield f"{name}_steady", float(fact["steady"])
    yield f"{name}_periods", fact["mesh_periods"]


def _torsional(runs: Runs) -> Named:
    """Figures of both ways at each speed, on rigid and on elastic bodies; their contact is the same and solved once."""
    rigid, _ = BODIES
    for bodies in BODIES:
        set_to = [f"--set={each}" for each in (*SETTINGS, f"dynamics.histories_rpm={list(SPEEDS)}",
                                               "dynamics.speeds=200", f'dynamics.bodies="{bodies}"')]
        words = module_run("evolvent", "dynamics", DEMOS / "he2022_dynamics.toml", "--quiet", "--resume", *set_to)
        after = "" if bodies == rigid else f"torsional_{rigid}"
        folder, _ = runs.ended(f"torsional_{bodies}", "dynamics.json", *words, after=after)
        swept = Vibration.read(folder)
        yield f"torsional_{bodies}_natural_rpm", swept.facts["natural_speed_rpm"]
        for speed, way in product(SPEEDS, WAYS):
            name, motion = f"torsional_{bodies}_{way}_{speed}", swept.motion(speed, way)
            yield f"{name}_um", float(np.ptp(motion["transmission_error_um"]))
            yield f"{name}_factor", float(motion["force_N"].max()) / swept.facts["static_force_N"]
            yield f"{name}_apart_percent", 100.0 * float(np.mean(motion["contact"] == 0.0))


def speeds_table(docs: Path) -> str:
    """Peak-to-peak transmission error and largest mesh force at each speed, of both models of the bodies."""
    f = kept.kept(docs / KEPT, COMMAND)
    columns = [f"torsional_{bodies}_{way}" for bodies in BODIES for way in WAYS]
    columns[2:2], columns[5:] = ["rigid"], ["modes"]
    rows = [(f"{speed}", *(_cell(f, f"{name}_{speed}") for name in columns), _steady(f, speed)) for speed in SPEEDS]
    heads = [
        head for bodies, modes in BODIES.items()
        for head in (*(f"torsional model, {bodies} bodies, {words}" for words in WAYS.values()), f"transient, {modes}")
    ]
    return markdown(("speed [r/min]", *heads, "mesh periods from statics"), rows)


def modes_table(docs: Path) -> str:
    """The motion at one speed over the number of modes."""
    f = kept.kept(docs / KEPT, COMMAND)
    rows = [
        (f"{count}", f"{f[f'count_{count}_modes']:.0f}", f"{f[f'count_{count}_um']:.3f} µm",
         f"{f[f'count_{count}_factor']:.4f}")
        for count in COUNTS
    ]
    return markdown(("modes of each harmonic", "modes in all", "transmission error, peak to peak",
                     "largest mesh force over the load"), rows)


def _cell(f: dict[str, float], name: str) -> str:
    apart = f[f"{name}_apart_percent"]
    return f"{f[f'{name}_um']:.2f} µm, {f[f'{name}_factor']:.2f}" + (f", apart {apart:.0f} %" if apart else "")


def _steady(f: dict[str, float], speed: int) -> str:
    return ", ".join(
        f"{f[f'{name}_{speed}_periods']:.0f}" + ("" if f[f"{name}_{speed}_steady"] else " (not steady)")
        for name in ("rigid", "modes")
    )


def holds(docs: Path) -> str:
    """How far the motions of the torsional model, running up, differ from those of transient contact."""
    f = kept.kept(docs / KEPT, COMMAND)

    def apart(bodies: str, other: str) -> str:
        one = f"torsional_{bodies}_up"
        um, factor = (
            max(abs(f[f"{one}_{speed}_{name}"] / f[f"{other}_{speed}_{name}"] - 1.0) for speed in SPEEDS)
            for name in ("um", "factor")
        )
        return f"{100.0 * um:.0f} % in the transmission error and {100.0 * factor:.0f} % in the largest mesh force"

    rigid, elastic = (f[f"torsional_{bodies}_natural_rpm"] for bodies in BODIES)
    return (
        f"The natural speed is {f['modes_natural_rpm']:.0f} r/min with the modes of both bodies, {elastic:.0f} by the "
        f"torsional model on elastic ones; {rigid:.0f} on rigid ones, {f['rigid_natural_rpm']:.0f} without modes. "
        f"From transient contact with modes, at the same speeds, the torsional model on elastic bodies, running up, is "
        f"off by up to {apart('elastic', 'modes')}, that on rigid bodies by up to {apart('rigid', 'modes')}. "
        f"From transient contact without modes rigid bodies are off by up to {apart('rigid', 'rigid')}.\n"
    )


def steps_table(docs: Path) -> str:
    """The motion at one speed over the time steps."""
    f = kept.kept(docs / KEPT, COMMAND)
    rows = [(f"{n}", f"{f[f'steps_{n}_a_period']:.1f}", *_cell(f, f"steps_{n}").split(", ", 1)) for n in STEPS]
    head = "time steps a mesh period", "in a period of the pair's own", "peak to peak", "largest mesh force over load"
    return markdown(head, rows)


def smeared(docs: Path) -> str:
    """How the largest mesh force at 20 time steps a mesh period differs from that at 10, 40 and 80."""
    f = kept.kept(docs / KEPT, COMMAND)
    force = {n: f[f"smeared_{n}_factor"] for n in SPACINGS}
    every_other, own, *finer = SPACINGS
    differ = " and ".join(f"by {force[n] - force[own]:.2f} from that of {n}" for n in finer)
    return (
        f"At {SMEARED} r/min the largest mesh force of He's pair over the load is {force[own]:.2f} with {own} time "
        f"steps a mesh period. It differs by {abs(force[every_other] - force[own]):.2f} from that of {every_other}, "
        f"{differ} (`{COMMAND}`).\n"
    )


def bores_table(docs: Path) -> str:
    """The natural speed over the bore."""
    f = kept.kept(docs / KEPT, COMMAND)
    rows = [(f"{bore}", f"{f[f'bore_{bore}_rigid_rpm']:.0f}", f"{f[f'bore_{bore}_modes_rpm']:.0f}") for bore in BORES]
    return markdown(
        ("bore [mm]", "natural speed, all inertia at the bore [r/min]", "with the modes of both bodies"), rows
    )


if __name__ == "__main__":
    keep_figures(__doc__, DOCS / KEPT, figures)
