"""`python -m evidence.pages.papers.he_transient --out DIR`: He's pair by transient contact beside the torsional model.

For docs/he2022.md: at speeds from a superharmonic to beyond the resonance, with the natural modes of both bodies and
with none, also at the same parts of the natural speed that the pair has with them; how the motion depends on the number
of modes; and the natural speed over the bore. Runs that an earlier call has ended are read again. `python -m
evidence.pages` then writes the page.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from evidence.checkout import DEMOS, DOCS
from evidence.pages.papers.kept_runs import kept
from evidence.pages.papers.kept_runs.kept import Named
from evidence.pages.papers.kept_runs.runs import Row, Runs, keep_figures, read
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
    own = {}
    for name, more in (("modes", ()), ("rigid", ("transient.modes_per_harmonic=0",))):
        for speed, fact in zip(SPEEDS, _transient(runs, name, _at(SPEEDS), *more)):
            yield from _motion(f"{name}_{speed}", fact)
            own[name] = _natural_rpm(fact)
        yield f"{name}_natural_rpm", own[name]
    scaled = [speed * own["modes"] / own["rigid"] for speed in SPEEDS]
    for speed, fact in zip(SPEEDS, _transient(runs, "scaled", _at(scaled))):
        yield from _motion(f"scaled_{speed}", fact)
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
    """Of both ways at each speed."""
    set_to = [f"--set={each}" for each in (*SETTINGS, f"dynamics.histories_rpm={list(SPEEDS)}", "dynamics.speeds=200")]
    words = module_run("evolvent", "dynamics", DEMOS / "he2022_dynamics.toml", "--quiet", "--overwrite", *set_to)
    folder, _ = runs.ended("torsional", "dynamics.json", *words)
    facts = json.loads((folder / "dynamics.json").read_text(encoding="utf-8"))
    yield "natural_rpm", facts["natural_speed_rpm"]
    histories = read(folder / "histories.csv")
    for speed in SPEEDS:
        for way in WAYS:
            own = [row for row in histories if (float(row["speed_rpm"]), row["way"]) == (speed, way)]
            name = f"{way}_{speed}"
            yield f"{name}_um", float(np.ptp(_column(own, "transmission_error_um")))
            yield f"{name}_factor", float(_column(own, "force_N").max()) / facts["static_force_N"]
            yield f"{name}_apart_percent", 100.0 * float(np.mean(_column(own, "contact") == 0.0))


def _column(rows: list[Row], name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.array([float(row[name]) for row in rows])


def speeds_table(docs: Path) -> str:
    """Peak-to-peak transmission error and largest mesh force at each speed."""
    f = kept.kept(docs / KEPT, COMMAND)
    rows = [
        (f"{speed}", *(_cell(f, f"{name}_{speed}") for name in (*WAYS, "rigid", "modes", "scaled")), _steady(f, speed))
        for speed in SPEEDS
    ]
    head = (
        "speed [r/min]", *(f"torsional model, {words}" for words in WAYS.values()), "transient, no modes",
        "transient, modes of both bodies", f"the same at {_ratio(f):.3f} times the speed", "mesh periods from statics",
    )
    return markdown(head, rows)


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
        for name in ("rigid", "modes", "scaled")
    )


def holds(docs: Path) -> str:
    """How far the motions differ: from the torsional model without modes, and with modes at the same part of the
    natural speed."""
    f = kept.kept(docs / KEPT, COMMAND)

    def apart(one: str, other: str) -> str:
        most = {
            name: max(abs(f[f"{one}_{speed}_{name}"] / f[f"{other}_{speed}_{name}"] - 1.0) for speed in SPEEDS)
            for name in ("um", "factor")
        }
        return (
            f"within {100.0 * most['um']:.0f} % in the transmission error and {100.0 * most['factor']:.0f} % in the "
            "largest mesh force"
        )

    return (
        f"Without modes contact and the torsional model, running up, agree {apart('rigid', 'up')}. "
        f"With modes the natural speed is {f['modes_natural_rpm']:.0f} r/min instead of {f['rigid_natural_rpm']:.0f}. "
        f"At the same part of it the motions of all speeds agree with those without modes "
        f"{apart('scaled', 'rigid')}.\n"
    )


def _ratio(f: Mapping[str, float]) -> float:
    """Natural speed with modes over that without."""
    return f["modes_natural_rpm"] / f["rigid_natural_rpm"]


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
