"""Vibration of He et al.'s spur pair over the speed, excited by its own mesh (Machines 2022, 10, 69, Fig. 14).

    python demos/he2022_dynamics.py [--quick] [--out DIR]

The mesh force over deflection and rotation comes from a pitch solved under eight torques on gears condensed once. Two
models of the mesh are followed over the speed: that force, damped in contact, and the paper's, the secant stiffness at
170 N·m times the deflection (Eqs 8, 12), with the same stiffness on the back flanks and damping in free flight, too.
Damping: 3 % of critical at the mean stiffness. Inertia: 7.65e-3 kg·m² a gear (the paper prints 7.65 kg·mm², which are
tonnes), all of it at the bores, as in the paper: gear bodies are rigid.

The bore is not printed and decides the stiffness: with 70 mm the resonance lies above the paper's 3500 r/min. The table
says at which mean stiffness it would lie there.
"""

from __future__ import annotations

import csv
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Annotated

import matplotlib
import numpy as np
import typer
from matplotlib.figure import Figure
from mpi4py import MPI

from evolvent.dynamics import DriveSettings, GearExcitation, PairVibration, mesh_excitation, natural_speed, vibration
from evolvent.gears import condense
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import load_scene

SCENE = Path(__file__).resolve().with_name("he2022.toml")
PERCENT = (5.0, 15.0, 30.0, 50.0, 75.0, 100.0, 150.0, 200.0)
"""Of 170 N·m: the torques of the force surface."""
INERTIA = 7.65  # t·mm², which are 1e-3 kg·m²
DAMPING_RATIO, BACKLASH = 0.03, 0.05  # of critical at the mean stiffness; mm along the line of action
AMPLITUDE = "equivalent_amplitude_um"
PAPER = 3500.0  # r/min, of the measured resonance
LOWEST, HIGHEST = 500.0, 1.6  # r/min; of the natural speed


@dataclass(frozen=True)
class Figures:
    """A line of the table: a model of the mesh."""

    model: str
    """Of the mesh."""
    mean_stiffness_N_per_um: float
    """At 170 N·m, mean over the pitch: tangent, in the paper's model secant."""
    natural_speed_rpm: float
    """At which a mesh period is that of the natural frequency at this stiffness."""
    stiffness_at_3500_rpm: float
    """Mean stiffness [N/µm] with which that speed were the paper's 3500 r/min."""
    jump_up_rpm: float
    """At which a pair that runs up jumps; NaN where it does not."""
    jump_down_rpm: float
    """At which one that runs down jumps."""
    largest_amplitude_um: float
    """Equivalent amplitude of s, √ΣA_r² of three mesh harmonics, largest of both ways."""
    at_rpm: float
    """Where it is."""
    largest_force_ratio: float
    """Largest mesh force over the static one."""


def main(
    out: Annotated[Path, typer.Option(help="folder of the table and the picture")] = Path("out/he2022_dynamics"),
    quick: Annotated[bool, typer.Option(help="fewer positions and speeds")] = False,
) -> None:
    """Solves, prints the table, and writes it with the picture."""
    problem = gear_problem(load_scene(SCENE, ['mesh.level="quick"'] if quick else []))
    torques = [problem.torque * percent / 100.0 for percent in PERCENT]
    excitation = mesh_excitation(condense(problem), torques, 20 if quick else 40)
    if MPI.COMM_WORLD.rank > 0:
        return
    inertias = (INERTIA, INERTIA)
    models = {
        "F(x, φ)": DriveSettings(inertias, DAMPING_RATIO, BACKLASH),
        "k(φ) x": DriveSettings(inertias, DAMPING_RATIO, BACKLASH, damping_in_separation=True, mesh="secant"),
    }
    count = 101 if quick else 401
    swept = {name: over_speed(excitation, problem.torque, each, count) for name, each in models.items()}
    table = [figures(name, each) for name, each in swept.items()]
    out.mkdir(parents=True, exist_ok=True)
    with open(out / "table.csv", "w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, [field.name for field in fields(Figures)])
        writer.writeheader()
        writer.writerows(asdict(row) for row in table)
    print((out / "table.csv").read_text(encoding="utf-8"))
    drawn(swept).savefig(out / "he2022_dynamics.png", dpi=150)


def over_speed(excitation: GearExcitation, torque: float, settings: DriveSettings, count: int) -> PairVibration:
    """A pair with one model of its mesh, at as many speeds from 0 as are above the lowest."""
    speeds = natural_speed(excitation, torque, settings) * HIGHEST * np.linspace(0.0, 1.0, count)
    return vibration(excitation, torque, speeds[speeds >= LOWEST], settings)


def figures(name: str, swept: PairVibration) -> Figures:
    """The line of a model of the mesh."""
    mean, natural = swept.facts.mean_stiffness_N_per_um, swept.natural_speed
    size = np.array([swept.curve(AMPLITUDE, "up"), swept.curve(AMPLITUDE, "down")])
    at = int(np.argmax(size.max(axis=0)))
    up, down = (max((row.speed_rpm for row in swept.rows if row.jumped and row.way == way), default=np.nan)
                for way in ("up", "down"))
    return Figures(
        name, mean, natural, mean * (PAPER / natural) ** 2, up, down, float(size.max()), float(swept.speeds[at]),
        max(row.dynamic_factor for row in swept.rows),
    )


def drawn(swept: dict[str, PairVibration]) -> Figure:
    """Equivalent amplitude over the speed, up and down, with each model of the mesh."""
    with matplotlib.rc_context({"font.size": 10.0, "axes.grid": True, "grid.alpha": 0.3}):
        figure = Figure((9.0, 4.8), layout="constrained")
        axes = figure.add_subplot()
        for (name, each), colour in zip(swept.items(), ("#1f4e9c", "#c0392b")):
            for way, style in (("up", "-"), ("down", "--")):
                axes.plot(each.speeds, each.curve(AMPLITUDE, way), style, color=colour, lw=1.4,
                          label=f"{name}, running {way}")
        axes.axvline(PAPER, color="0.5", lw=1.0, ls=":")
        axes.text(PAPER, 1.0, " measured resonance", va="top", fontsize=8.0, transform=axes.get_xaxis_transform())
        axes.set_xlabel("speed [r/min]")
        axes.set_ylabel("equivalent amplitude of the transmission error [µm]")
        axes.set_ylim(bottom=0.0)
        axes.legend(loc="upper left")
        return figure


if __name__ == "__main__":
    typer.run(main)
