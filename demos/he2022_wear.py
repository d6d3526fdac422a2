"""Wear of He et al.'s spur pair, quasi-static: depth over the profile and mesh force as it wears (their Figs 19-21).

    python demos/he2022_wear.py [--out DIR] [--level quick|standard|fine] [--meshes 1.6e6] [--positions 40]

170 N·m on the pinion, K/H = 1.3832e-10 mm²/N on both gears, no friction in the contact solution. Both gears have 50
teeth, so that both flanks are worn alike but for what deflection makes of it.
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
REPORTS = 4


@dataclass(frozen=True)
class Report:
    """After so many meshes: depths of pinion and wheel over the flank's arc [mm], and the pitch."""

    meshes: float
    depths: tuple[Floats, Floats]
    pitch: PitchState
    blocks: int
    searched: int


def study(level: str, meshes: float, positions: int, settings: BlockSettings) -> tuple[GearWear, list[Report]]:
    """Reports at equal steps; the first is of the unworn pair."""
    model = prepare_model(load_scene(SCENE, [f"mesh.level={level}"]), MPI.COMM_SELF).model
    gears = GearWear(model, uniform_pitch(model.pair.pinion.z, positions, 0), 0.0, Archard(COEFFICIENT, COEFFICIENT))
    state, blocks, searched = unworn(gears, gears.unworn, settings), 0, 0
    reports = [Report(0.0, gears.by_gear(state.depth), state.now, 0, state.now.searched)]
    for end in np.linspace(0.0, meshes, REPORTS + 1)[1:]:
        while state.cycles < end * (1.0 - 1e-12):
            block = next_block(gears, state, float(end), settings)
            state, blocks, searched = block.state, blocks + 1, searched + block.state.now.searched
            print(f"{state.cycles:12.0f} meshes, block of {block.length:9.0f}, error {block.error:.3f}, "
                  f"deepest {1e3 * state.depth.max():.3f} µm, refused {block.refused}", flush=True)  # fmt: skip
        reports.append(Report(state.cycles, gears.by_gear(state.depth), state.now, blocks, searched))
    return gears, reports


def profile(gears: GearWear, gear: int, depth: Floats) -> tuple[Floats, Floats]:
    """Radius [mm] and mean depth over the face width [µm] along a flank."""
    grid, base = gears.grids[gear], gears.model.pair.gears[gear].base_radius
    return np.sqrt(base**2 + 2.0 * base * grid.arcs), 1e3 * depth[grid.node].mean(axis=0)


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
               f"{last.meshes / 1e6:.1f} million meshes; at the very tip its edge bears")  # fmt: skip
        figure = sheet("Wear depth over the profile, He et al. 2022, 170 N·m", see)
        axes = figure.add_subplot()
        for report, colour in zip(reports[1:], colours[1:]):
            for gear, style in ((0, "-"), (1, ":")):
                name = f"{report.meshes / 1e6:.1f} million meshes" if gear == 0 else None
                axes.plot(*profile(gears, gear, report.depths[gear]), style, color=colour, label=name)
        axes.axvline(gears.model.pair.working_pitch_diameters[0] / 2.0, color="0.6", lw=0.8)
        axes.set(xlabel="radius [mm]   (pinion: lines, wheel: dotted)", ylabel="wear depth [µm]", ylim=(0.0, None))
        axes.legend()
        save(figure, out / "depth.png")
        figure = sheet("Force on a tooth over its engagement, as it wears", "Wear takes load off the roots and tips")
        axes = figure.add_subplot()
        for report, colour in zip(reports, colours):
            name = f"{report.meshes / 1e6:.1f} million meshes"
            axes.plot(*tooth_force(gears, report.pitch), color=colour, label=name)
        axes.set(xlabel="pinion rotation of the tooth [°]", ylabel="force on the tooth [N]", ylim=(0.0, None))
        axes.legend()
        save(figure, out / "force.png")


def main(
    out: Annotated[Path, typer.Option()] = Path("out/he2022_wear"), level: str = "standard", meshes: float = 1.6e6,
    positions: int = 40, tolerance: float = 0.05, implicit: bool = True,
) -> None:  # fmt: skip
    """Compute, write depth.csv and the pictures."""
    compat.silence_logs()
    settings = BlockSettings(first=meshes / 100.0, tolerance=tolerance, implicit=implicit)
    gears, reports = study(level, meshes, positions, settings)
    out.mkdir(parents=True, exist_ok=True)
    with open(out / "depth.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["radius_mm", *(f"depth_um_{report.meshes:.0f}" for report in reports[1:])])
        radius = profile(gears, 0, reports[0].depths[0])[0]
        columns = [profile(gears, 0, report.depths[0])[1] for report in reports[1:]]
        table.writerows([f"{value:.6g}" for value in row] for row in zip(radius, *columns))
    draw(gears, reports, out)


if __name__ == "__main__":
    typer.run(main)
