"""`python -m evidence.pages.papers.he_figures --out DIR [--part PART] [--few]`: computes and keeps the figures of
docs/he2022.md.

PART points: the vibration of He's pair over the speed with several models of its mesh, bores and dampings, its contact
at 2000 r/min, and the pair worn by 1.6 million meshes with its vibration, on rigid gear bodies as in the paper; models:
the vibration on rigid and on elastic bodies, from the same contact; sensitivity: the worn pair with what it depends on.
By default all. `python -m evidence.pages` then writes the page.
--few: few positions and speeds, to see that it runs; nothing is kept.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from evidence.checkout import DEMOS, DOCS
from evidence.pages.papers.he_models import MODELS, models
from evidence.pages.papers.he_runs import (
    COMMAND,
    FEW,
    PAPER_RPM,
    RIGID,
    SURFACE,
    VIBRATION,
    WEAR,
    HeRuns,
    Vibration,
    in_series,
    natural_square,
    read_csv,
    read_json,
    series_setting,
)
from evidence.pages.papers.kept_runs import kept
from evidence.pages.papers.kept_runs.kept import Named
from evolvent.gears.problem.gear_inertia import polar_moment
from evolvent.gears.problem.iso_stiffness import mesh_stiffness, single_stiffness
from evolvent.results.engagement import engagement
from evolvent.results.run_data import read_run
from evolvent.scene.scene import Scene, load_scene

KEPT, SENSITIVITY = "he2022/figures.csv", "he2022/sensitivity.csv"
OPERATING_RPM = 2000.0
"""Speed [r/min] of the paper's Figures 14b to 22."""
BORES = 36, 40, 70, 100  # mm
FINE = "sweep.positions=80"
"""For the stiffness of worn flanks: with 20 positions its mean goes in steps of 1 %."""
REPORTS = 0, 200000, 400000, 800000, 1600000
TORQUE = 170.0  # N·m
POINT_A = 77.0
"""Radius [mm] of the paper's point A."""
COEFFICIENT = 1.3832e-10
"""Of the demo [mm²/N]."""
VARIED: Mapping[str, tuple[str, ...]] = {
    "as_demo": (),
    "half_wear": tuple(f"wear.{gear}_mm2_per_N={0.5 * COEFFICIENT:g}" for gear in ("pinion", "wheel")),
    "twice_wear": tuple(f"wear.{gear}_mm2_per_N={2.0 * COEFFICIENT:g}" for gear in ("pinion", "wheel")),
    "half_damping": ("dynamics.damping_ratio=0.015",),
    "twice_damping": ("dynamics.damping_ratio=0.06",),
    "elastic": ('dynamics.bodies="elastic"', "dynamics.series_stiffness_N_per_um=603"),
    "tangent": ('dynamics.mesh="tangent"',),
    "secant": ('dynamics.mesh="secant"',),
}
"""What the wear with vibration is computed with. Elastic bodies have the series stiffness that puts them at the paper's
resonance, as the demo's does rigid ones: `he_models`."""
PAPER_MODEL = 'dynamics.mesh="secant"', "dynamics.damping_in_separation=true"


def figures(runs: HeRuns) -> Named:
    """(name, value) of each figure. Raises RunFailed."""
    scene = load_scene(DEMOS / "he2022_dynamics.toml")
    folder = runs.run("dynamics", SURFACE, VIBRATION, RIGID)
    surface, secant = Vibration.read(folder), _mean_stiffness(folder, TORQUE, "secant")
    mass, stiffness = surface.facts["equivalent_mass_kg"], surface.facts["mean_stiffness_N_per_um"]
    teeth = scene.pinion.teeth
    wanted = 1e-6 * mass * natural_square(scene)
    series, series_of_secant = (in_series(wanted, k) for k in (stiffness, secant))
    yield "equivalent_mass_kg", mass
    yield "as_printed_rpm", PAPER_RPM * math.sqrt(1000.0)
    yield "bore_of_inertia_mm", _bore_of(scene)
    yield "contact_ratio", scene.gear_pair().transverse_contact_ratio
    yield "stiffness_at_paper_speed_N_per_um", wanted
    yield "series_N_per_um", series
    yield "series_of_secant_N_per_um", series_of_secant
    yield from _iso(scene, mass, teeth)
    for bore in BORES:
        name, both = f"bore_{bore}", [f"{gear}.bore_diameter_mm={bore}" for gear in ("pinion", "wheel")]
        folder = runs.run("excitation", name, VIBRATION, *both)
        for kind in ("tangent", "secant"):
            k = _mean_stiffness(folder, scene.load.torque_Nm, kind)
            yield f"{name}_{kind}_N_per_um", k
            yield f"{name}_{kind}_rpm", _natural(k, mass, teeth)
    at_paper_speed, paper_at_paper_speed = (series_setting(k) for k in (series, series_of_secant))
    cases = {
        "paper": PAPER_MODEL,
        "matched": (at_paper_speed,),
        "paper_matched": (paper_at_paper_speed, *PAPER_MODEL),
        "damped": ("dynamics.damping_ratio=0.15",),
        "apart": ("dynamics.damping_in_separation=true",),
    }
    yield from surface.figures(SURFACE)
    for name, settings in cases.items():
        yield from runs.vibration(name, RIGID, *settings).figures(name)
    yield from _contact(runs, scene, at_paper_speed)
    yield from _worn(runs, "wear")
    yield from _worn_stiffness(runs, scene, mass, series)


def sensitivity(runs: HeRuns) -> Named:
    """(name, value) of each figure of the worn pair, under what it is computed with. Raises RunFailed."""
    for name, settings in VARIED.items():
        for figure, value in _worn(runs, name, *settings):
            yield f"{name}_{figure}", value


def _natural(stiffness: float, mass: float, teeth: int) -> float:
    """Natural speed [r/min] at a stiffness [N/µm] and a mass [kg]."""
    return math.sqrt(1e6 * stiffness / mass) / (2.0 * math.pi) * 60.0 / teeth


def _mean_stiffness(folder: Path, torque: float, kind: str) -> float:
    """Tangent or secant stiffness under a torque [N·m], mean over the pitch [N/µm]."""
    rows = read_csv(folder / "excitation.csv")
    found = [float(r[f"{kind}_stiffness_N_per_um"]) for r in rows if math.isclose(float(r["torque_Nm"]), torque)]
    return float(np.mean(found))


def _bore_of(scene: Scene) -> float:
    """Bore [mm] of a solid pinion that has the given inertia."""
    assert scene.dynamics is not None and scene.dynamics.pinion_inertia_kg_m2 is not None
    gear, given = scene.gear_pair().pinion, 1e3 * scene.dynamics.pinion_inertia_kg_m2
    density = scene.dynamics.density

    def excess(bore: float) -> float:
        return polar_moment(replace(gear, bore_diameter=bore), density) - given

    return float(brentq(excess, 0.02 * gear.root_diameter, 0.8 * gear.root_diameter))


def _iso(scene: Scene, mass: float, teeth: int) -> Named:
    """Mesh stiffness by ISO 6336-1, and the natural speed that it gives."""
    pair = scene.gear_pair()
    tangential = 1e3 * scene.load.torque_Nm / (0.5 * pair.pinion.reference_diameter)
    single = single_stiffness(pair, tangential / pair.face_width)
    both = mesh_stiffness(single, pair.transverse_contact_ratio)
    yield "iso_single_N_per_mm_um", single
    yield "iso_mesh_N_per_mm_um", both
    yield "iso_N_per_um", both * pair.face_width
    yield "iso_rpm", _natural(both * pair.face_width, mass, teeth)


def _contact(runs: HeRuns, scene: Scene, series: str) -> Named:
    """One tooth's engagement under the constant torque and at the operating speed, which is the same part of the
    resonance as in the paper. series: setting of the compliance that makes it so."""
    pair = scene.gear_pair()
    gear, pitch_point = pair.pinion, pair.pitch_point_roll_lengths[0]
    at_A = (math.sqrt(POINT_A**2 - gear.base_radius**2) - pitch_point) / gear.base_radius
    at_speed = RIGID, series, f"dynamics.operating_rpm={OPERATING_RPM:g}"
    for name, settings in (("static", ()), ("dynamic", at_speed)):
        folder = runs.run("run", f"contact_{name}", VIBRATION, "mesh.level=standard", *settings)
        curve = engagement(read_run(folder), 0)
        known = np.isfinite(curve.max_pressure)
        yield f"{name}_largest_MPa", float(np.max(curve.max_pressure[known]))
        yield f"{name}_at_A_MPa", float(np.interp(at_A, curve.angle[known], curve.max_pressure[known]))
        yield f"{name}_force_at_A_N", float(np.interp(at_A, curve.angle, curve.force))
        yield f"{name}_engagement_deg", float(np.degrees(np.subtract(*curve.ends[::-1])))
    for figure, value in read_json(folder / "operation.json").items():
        yield f"dynamic_{figure}", math.nan if value is None else float(value)


def _worn(runs: HeRuns, name: str, *settings: str) -> Named:
    """The pair at the paper's cycles, and its vibration over the speed there. settings: of the demo."""
    folder = runs.run("run", name, WEAR, *settings)
    rows = {float(row["cycles"]): row for row in read_csv(folder / "vibration.csv")}
    depths = {report["cycles"]: report["pinion"] for report in read_json(folder / "wear.json")["reports"]}
    forces = {cycles: float(row["largest_force_N"]) - float(row["smallest_force_N"]) for cycles, row in rows.items()}
    yield "worn_least_force_at_million", 1e-6 * min(forces, key=lambda cycles: forces[cycles])
    for cycles in REPORTS:
        worn = f"worn_{cycles}"
        for figure, text in rows[min(rows, key=lambda known: abs(known - cycles))].items():
            yield f"{worn}_{figure}", float(text or "nan")
        yield f"{worn}_peak_to_peak_N", forces[min(forces, key=lambda known: abs(known - cycles))]
        report = depths[min(depths, key=lambda known: abs(known - cycles))]
        yield f"{worn}_deepest_um", report["deepest_um"]
        yield f"{worn}_at_diameter_mm", report["at_diameter_mm"]
        scene, of_scene = (folder / worn / "scene.toml", ()) if cycles else (WEAR, settings)
        swept = Vibration.read(runs.run("dynamics", f"{name}_{worn}", scene, *of_scene))
        yield f"{worn}_separated_percent", 100.0 * swept.largest("separated_share")
        yield f"{worn}_amplitude_um", swept.largest("equivalent_amplitude_um")


PARTS: Mapping[str, tuple[Callable[[HeRuns], Named], str]] = {
    "points": (figures, KEPT),
    "models": (models, MODELS),
    "sensitivity": (sensitivity, SENSITIVITY),
}
"""What computes a part's figures, and where they are kept."""


def _worn_stiffness(runs: HeRuns, scene: Scene, mass: float, series: float) -> Named:
    """Of the mesh as worn, and the natural speed with the series compliance [N/µm], at positions that are near enough
    for a mean."""
    for cycles in REPORTS:
        worn = f"worn_{cycles}"
        worn_scene = runs.out / "wear" / worn / "scene.toml" if cycles else WEAR
        folder = runs.run("excitation", f"stiffness_{worn}", worn_scene, FINE)
        tangent, secant = (_mean_stiffness(folder, TORQUE, kind) for kind in ("tangent", "secant"))
        yield f"{worn}_tangent_N_per_um", tangent
        yield f"{worn}_secant_N_per_um", secant
        yield f"{worn}_fine_natural_rpm", _natural(1.0 / (1.0 / tangent + 1.0 / series), mass, scene.pinion.teeth)


def main() -> None:
    """Computes, and keeps unless there are few positions."""
    parser = argparse.ArgumentParser(description=COMMAND)
    parser.add_argument("--out", type=Path, required=True, help="folder of the runs")
    parser.add_argument("--part", choices=list(PARTS), action="append", help="by default all")
    parser.add_argument("--few", action="store_true", help="few positions and speeds; nothing is kept")
    given = parser.parse_args()
    runs = HeRuns(given.out, FEW if given.few else ())
    for part in given.part or PARTS:
        figures_of, path = PARTS[part]
        print(dict(figures_of(runs)) if given.few else kept.keep(DOCS / path, figures_of(runs)))


if __name__ == "__main__":
    main()
