"""Root stress of Zhang et al.'s spur pair with a high contact ratio, over the torque and the rack's tip radius
(Processes 2023, 11, 1807, Fig. 16).

    python demos/zhang2023.py [--quick] [--out DIR]

In plane strain over the narrower face. Finite elements have the load of all pairs that touch under load; the paper's
formula has half of it at point b, where nominally two pairs begin to share it. The rack's tip radius is not printed and
decides the fillet: 0.15 to 0.30 modules are tried at 500 N·m, 0.20 at the other torques. The paper loads the pair where
it stands, so that its friction (μ = 0.05) finds no sliding; here gears turn: both μ = 0 and 0.05 are computed.
"""

from __future__ import annotations

import csv
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Annotated

import matplotlib
import typer
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpi4py import MPI

from evolvent.run.call import Options
from evolvent.run.compute import compute
from evolvent.run.kinds.strength import Strength
from evolvent.scene.scene import load_scene

SCENE = Path(__file__).resolve().with_name("zhang2023.toml")
PLANE = "pinion.face_width_mm=25", "contact.friction=[0.0, 0.05]", "output.pictures=false"
MODULE, NOMINAL = 2.3, 500.0  # mm; N·m, of the paper's tables
TORQUES = 100.0, 200.0, 300.0, 400.0, NOMINAL
TIP_RADII = 0.20, 0.15, 0.25, 0.30  # of the rack, in modules
FRICTIONS = 0.0, 0.05
PAPER = {"pinion": 490.6, "wheel": 487.01}  # MPa, finite elements at 500 N·m


@dataclass(frozen=True)
class Figures:
    """A line of the table: a gear under a torque."""

    gear: str
    torque_Nm: float
    rack_tip_radius_modules: float
    friction: float
    """μ of the finite elements."""
    tension_MPa: float
    """Finite elements, largest of the loaded side over the engagement of a tooth."""
    tension_MPa_error: float
    """Its error bar."""
    tension_rotation_deg: float
    """Pinion rotation of the tooth from the pitch point."""
    tension_angle_deg: float
    """Of the profile there to the tooth's centre line."""
    compression_MPa: float
    """Smallest of the back."""
    compression_MPa_error: float
    at_b_MPa: float
    """Largest tension with the tooth loaded at b."""
    at_b_MPa_error: float
    equal_shares_b_MPa: float
    """The paper's formula."""
    pedrero_MPa: float
    """Largest over the path of contact with shares of least energy."""
    iso_2019_MPa: float
    """ISO 6336-3:2019."""
    iso_2006_MPa: float


def main(
    out: Annotated[Path, typer.Option(help="folder of tables and picture")] = Path("out/zhang2023"),
    quick: Annotated[bool, typer.Option(help="coarse meshes, few positions and cases")] = False,
) -> None:
    """Solves, prints the table, and writes it with the picture."""
    table: list[Figures] = []
    for torque, radius in cases(quick):
        settings = [f"load.torque_Nm={torque}", *(f"{gear}.rack_tip_radius_mm={MODULE * radius}" for gear in PAPER)]
        small = ["mesh.level=quick", "sweep.positions=6"] if quick else []
        folder = out / f"{torque:g}_Nm_{radius:.2f}"
        compute(Strength.of(load_scene(SCENE, [*PLANE, *settings, *small])), folder, Options(overwrite=True))
        if MPI.COMM_WORLD.rank == 0:
            table += [figures(folder / "strength.csv", gear, torque, radius, μ) for gear in PAPER for μ in FRICTIONS]
    if MPI.COMM_WORLD.rank > 0:
        return
    with open(out / "table.csv", "w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, [field.name for field in fields(Figures)])
        writer.writeheader()
        writer.writerows(asdict(row) for row in table)
    print((out / "table.csv").read_text(encoding="utf-8"))
    drawn(table).savefig(out / "zhang2023.png", dpi=150)


def cases(quick: bool) -> list[tuple[float, float]]:
    """Torques and rack tip radii."""
    if quick:
        return [(200.0, TIP_RADII[0]), (NOMINAL, TIP_RADII[0])]
    return [*((torque, TIP_RADII[0]) for torque in TORQUES), *((NOMINAL, radius) for radius in TIP_RADII[1:])]


def figures(path: Path, gear: str, torque: float, radius: float, friction: float) -> Figures:
    """The line of a gear from its strength.csv."""
    with open(path, encoding="utf-8") as stream:
        rows = [row for row in csv.DictReader(stream) if row["gear"] == gear]
    own = {row["method"]: row for row in rows if row["friction"] == "nan" or float(row["friction"]) == friction}
    tension, compression = own["finite elements, tension"], own["finite elements, compression"]
    at_b = own["finite elements, tension, outer point of double contact (b)"]
    formulas = (
        "equal shares, outer point of double contact (b)", "Pedrero's shares, largest over the path",
        "ISO 6336-3:2019", "ISO 6336-3:2006",
    )
    bars = [float(row[name]) for row in (tension, compression, at_b) for name in ("stress_MPa", "stress_MPa_error")]
    place = [float(tension[name]) for name in ("tooth_rotation_deg", "tangent_angle_deg")]
    nominal = (float(own[name]["stress_MPa"]) for name in formulas)
    return Figures(gear, torque, radius, friction, *bars[:2], *place, *bars[2:], *nominal)


def drawn(table: list[Figures]) -> Figure:
    """Stress over the torque, a column a gear: finite elements with error bars, formulas, and the paper's value."""
    with matplotlib.rc_context({"font.size": 10.0, "axes.grid": True, "grid.alpha": 0.3}):
        figure = Figure((10.0, 4.8), layout="constrained")
        for axes, gear in zip(figure.subplots(1, 2, sharey=True), PAPER):
            _column(axes, [row for row in table if row.gear == gear])
            axes.plot(NOMINAL, PAPER[gear], "*", color="#c0392b", ms=11, label="finite elements of the paper")
            axes.set(title=gear, xlabel="torque on the pinion [N·m]", ylim=(0.0, None))
        figure.axes[0].set_ylabel("root stress [MPa]")
        figure.axes[0].legend(loc="upper left", fontsize=8.5)
        figure.suptitle("Root stress of a spur pair with a contact ratio of 2.14; open: other rack tip radii [modules]")
        return figure


def _column(axes: Axes, rows: list[Figures]) -> None:
    line = [row for row in rows if row.rack_tip_radius_modules == TIP_RADII[0] and row.friction == FRICTIONS[0]]
    torque = [row.torque_Nm for row in line]
    for label, values, style in (
        ("formula at b, half the load each", [row.equal_shares_b_MPa for row in line], "k--"),
        ("largest with Pedrero's shares", [row.pedrero_MPa for row in line], "k:"),
        ("ISO 6336-3:2019", [row.iso_2019_MPa for row in line], "k-."),
    ):
        axes.plot(torque, values, style, lw=1.2, label=label)
    for μ, colour in zip(FRICTIONS, ("#1f4e9c", "#5aa469")):
        own = [row for row in rows if row.friction == μ]
        first = [row for row in own if row.rack_tip_radius_modules == TIP_RADII[0]]
        tension, errors = zip(*((row.tension_MPa, row.tension_MPa_error) for row in first))
        axes.errorbar(torque, tension, errors, color=colour, marker="o", ms=4.5, capsize=3,
                      label=f"finite elements, μ = {μ:g}")
        for row in own:
            if row not in first:
                axes.plot(row.torque_Nm, row.tension_MPa, "o", mfc="none", color=colour, ms=5.5)
                if μ == 0.0:
                    axes.annotate(f"{row.rack_tip_radius_modules:.2f}", (row.torque_Nm, row.tension_MPa),
                                  (-28, -3), textcoords="offset points", fontsize=8, color=colour)


if __name__ == "__main__":
    typer.run(main)
