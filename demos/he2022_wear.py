"""Wear of He et al.'s spur pair, quasi-static: depth over the profile and mesh force as it wears (their Figs 19-21).

    python demos/he2022_wear.py [--quick] [--out DIR]

170 N·m on the pinion, K/H = 1.3832e-10 mm²/N on both gears, no friction in the contact solution, 1.6 million meshes.
Both gears have 50 teeth, so that both flanks wear alike. At the pitch point there is no sliding, but the contact is
0.26 mm wide, so that the flank there is pressed while it slides a little: 3 % of the depth at the root. Without tip
relief the very tip bears before and after the path of contact; an edge's pressure is singular and so is its wear.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from mpi4py import MPI

from meshes.data import Floats
from solver import compat
from solver.gear_model import prepare_model
from solver.gear_sweep import uniform_pitch
from solver.plots_style import friction_colours, save, sheet, styled
from solver.scene import load_scene
from wear.blocks import BlockSettings, next_block, unworn
from wear.gears import GearWear, PitchState
from wear.law import Archard

SCENE = Path(__file__).with_suffix("").parent / "he2022.toml"
COEFFICIENT = 1.3832e-10  # mm²/N: 2.446 µm per km at 17.684 MPa
MESHES, REPORTS = 1.6e6, 4
TIP = 0.1  # mm of radius that the curves leave out


@dataclass(frozen=True)
class Report:
    """After so many meshes: depths of pinion and wheel over the flank's arc [mm], and the pitch."""

    meshes: float
    depths: tuple[Floats, Floats]
    pitch: PitchState


def study(level: str, positions: int) -> tuple[GearWear, list[Report]]:
    """Reports at equal steps; the first is of the unworn pair."""
    settings = BlockSettings(first=MESHES / 100.0)
    model = prepare_model(load_scene(SCENE, [f"mesh.level={level}"]), MPI.COMM_SELF).model
    gears = GearWear(model, uniform_pitch(model.pair.pinion.z, positions, 0), 0.0, Archard(COEFFICIENT, COEFFICIENT))
    state = unworn(gears, gears.begin, settings)
    reports = [Report(0.0, gears.by_gear(state.depth), state.now)]
    for end in np.linspace(0.0, MESHES, REPORTS + 1)[1:]:
        while state.cycles < end * (1.0 - 1e-12):
            state = next_block(gears, state, float(end), settings).state
        reports.append(Report(state.cycles, gears.by_gear(state.depth), state.now))
    return gears, reports


def profile(gears: GearWear, gear: int, depth: Floats) -> tuple[Floats, Floats]:
    """Radius [mm] and mean depth over the face width [µm] along a flank, without its tip edge."""
    grid, base = gears.grids[gear], gears.model.pair.gears[gear].base_radius
    radius = np.sqrt(base**2 + 2.0 * base * grid.arcs)
    inner = radius < radius.max() - TIP
    return radius[inner], 1e3 * depth[grid.node].mean(axis=0)[inner]


def tooth_force(gears: GearWear, pitch: PitchState) -> tuple[Floats, Floats]:
    """Rotation of the pinion from where a tooth's contact is at the pitch point [°], and the force it carries [N]."""
    pair, found = gears.model.pair, {}
    width = pair.face_width if gears.model.bodies[0].d == 2 else 1.0
    for position in pitch.positions:
        c = position.contact
        for tooth in np.unique(c.tooth):
            own = c.tooth == tooth
            angle = np.degrees(position.stand.angle) + 360.0 / pair.pinion.z * tooth
            found[round(float(angle), 9)] = width * float(c.weights[own] @ c.pressure[own])
    angles = np.array(sorted(found))
    return angles, np.array([found[a] for a in angles])


def draw(gears: GearWear, reports: list[Report], out: Path) -> None:
    """Depth over the radius; force over the rotation."""
    colours = friction_colours([r.meshes for r in reports])
    with styled():
        last = reports[-1]
        radius, deepest = profile(gears, 0, last.depths[0])
        root = radius < gears.model.pair.working_pitch_diameters[0] / 2.0
        see = (f"Least at the pitch point, most at the root: {deepest[root].max():.1f} µm after "
               f"{last.meshes / 1e6:.1f} million meshes; the tip's edge is left out")  # fmt: skip
        figure = sheet("Wear depth over the profile, He et al. 2022, 170 N·m", see)
        axes = figure.add_subplot()
        for report, colour in zip(reports[1:], colours[1:]):
            for gear, style in ((0, "-"), (1, ":")):
                name = f"{report.meshes / 1e6:.1f} million meshes" if gear == 0 else None
                axes.plot(*profile(gears, gear, report.depths[gear]), style, color=colour, label=name)
        axes.axvline(gears.model.pair.working_pitch_diameters[0] / 2.0, color="0.6", lw=0.8)
        axes.set(xlabel="radius [mm]   (pinion: lines, wheel: dotted)", ylabel="wear depth [µm]", ylim=(0.0, None))
        axes.legend()
        save(figure, out / "he2022_wear.png")
        figure = sheet("Force on a tooth over its engagement, as it wears", "Wear takes load off the roots and tips")
        axes = figure.add_subplot()
        for report, colour in zip(reports, colours):
            name = f"{report.meshes / 1e6:.1f} million meshes"
            axes.plot(*tooth_force(gears, report.pitch), color=colour, label=name)
        axes.set(xlabel="pinion rotation of the tooth [°]", ylabel="force on the tooth [N]", ylim=(0.0, None))
        axes.legend()
        save(figure, out / "force.png")


def check(gears: GearWear, reports: list[Report]) -> None:
    """Raises AssertionError where the wear is not what line contact asks for."""
    pair, rate = gears.model.pair, gears.by_gear(reports[0].pitch.rate)[0]
    radius, h = profile(gears, 0, 1e6 * rate)
    angles, force = tooth_force(gears, reports[0].pitch)
    ρ = np.sqrt(radius**2 - pair.pinion.base_radius**2)
    ξ = ρ - pair.pitch_point_roll_lengths[0]
    ρ_1, ρ_2 = pair.curvature_radii(ξ)
    load = np.interp(np.degrees(ξ / pair.pinion.base_radius), angles, force) / pair.face_width
    exact = 1e9 * COEFFICIENT * load * np.abs(1.0 - ρ_2 / pair.ratio / ρ_1)
    at = int(np.argmin(np.abs(radius - 77.0)))
    assert abs(h[at] / exact[at] - 1.0) < 0.05, f"r = 77 mm: wanted {exact[at]:.3f} µm a million, found {h[at]:.3f}"
    root, pitch = h[ξ < -1.0].max(), float(np.interp(0.0, ξ, h))
    assert root > h[ξ > 1.0].max(), "wanted the deepest wear at the root"
    assert pitch < 0.06 * root, f"pitch point: wanted nearly no wear, found {pitch:.3f} of {root:.3f} µm"
    deepest = np.array([profile(gears, 0, report.depths[0])[1].max() for report in reports])
    first, *later = np.diff(deepest)
    assert max(later) < 0.7 * first, f"wanted a maximum that grows slower after the first report, found {deepest} µm"
    print(f"r = 77 mm: {h[at]:.3f} µm a million meshes, line contact {exact[at]:.3f}")
    print(f"pitch point: {pitch / root:.3f} of the root; deepest {', '.join(f'{d:.2f}' for d in deepest[1:])} µm")
    print(f"engagement: {np.ptp(angles):.2f}° and at most a step more")


def main(out: Annotated[Path, typer.Option()] = Path("out/he2022_wear"), quick: bool = False) -> None:
    """Compute, check, write table.csv and the pictures."""
    compat.silence_logs()
    gears, reports = study("quick" if quick else "fine", 20 if quick else 40)
    if MPI.COMM_WORLD.rank:
        return
    check(gears, reports)
    out.mkdir(parents=True, exist_ok=True)
    with open(out / "table.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["radius_mm", *(f"depth_um_{report.meshes:.0f}" for report in reports[1:])])
        radius = profile(gears, 0, reports[0].depths[0])[0]
        columns = [profile(gears, 0, report.depths[0])[1] for report in reports[1:]]
        table.writerows([f"{value:.6g}" for value in row] for row in zip(radius, *columns))
    draw(gears, reports, out)


if __name__ == "__main__":
    typer.run(main)
