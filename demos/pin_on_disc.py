"""Pin on disc, He et al. 2022, Figs 3 and 13: a pin of 6 mm wears on a rotating disc of 100 mm under 500 N.

    python demos/pin_on_disc.py [--quick] [--straight] [--out DIR] [--km 10] [--disc-mm2-per-N 0]

Friction tilts the pin, so that it first presses on its leading edge. Wear redistributes the pressure until every point
loses the same depth per revolution: then p v is uniform, and a pin that does not turn has a higher pressure where the
disc is slower, near its axis. With --straight the disc slides straight on, and p itself becomes uniform. The mean
pressure is 17.684 MPa and the depth grows by 2.446 µm per km. Wear of the disc was not measured; with a K/H of its own
it wears on its whole track, with --straight on a belt of 1 km.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.tri import TriContourSet
from mpi4py import MPI

from evolvent import STEEL, Body, Contact, Fixed, Freedom, MeshData, Placement, Problem, Rigid, Step
from evolvent.fem.backend import dolfinx_compat
from evolvent.results.drawing.style import PRESSURE_MAP, save, sheet, styled
from evolvent.wear import Archard, BlockSettings, Cycle, CycleState, Travel, WearStudy
from evolvent_meshes.rotation import turn
from evolvent_meshes.shapes.rings import ring_block
from evolvent_meshes.shapes.variants import doubled, with_part

DIAMETER, LENGTH, LOAD, FRICTION = 6.0, 8.0, 500.0, 0.1  # mm, mm, N; length and μ are not printed
TRACK = 40.0  # radius of the track on the disc [mm], not printed
COEFFICIENT, RATE = 1.3832e-10, 2.446  # mm²/N; µm per km
DRAG = 0.05  # mm of sliding until friction has its direction everywhere
KILOMETRE = 1e6 / TRACK  # rad


@dataclass(frozen=True)
class Snapshot:
    """State after a block of cycles.

    distance: sliding distance [km].
    depth: mean worn depth of the pin [µm].
    cycle: the solved cycle.
    track: largest worn depth of the disc's track [µm].
    """

    distance: float
    depth: float
    cycle: CycleState
    track: float = 0.0


def whole(quarter: MeshData) -> MeshData:
    """All four quarters."""
    return doubled(doubled(quarter, "symmetry_x", 0), "symmetry_y", 1)


def problem(size: float) -> Problem:
    """The pin (body 0) stands on a slab of the disc, whose axis is at y = −TRACK; cells of `size` [mm] on its face."""
    radius = DIAMETER / 2.0
    ring = radius / 1.5
    pin = whole(ring_block(radius, LENGTH, ring, size, 0.5 * (ring + radius), growth=1.2, fine_depth=size))
    pin = replace(pin, points=pin.points * (-1.0, 1.0, -1.0))  # upside down
    slab = whole(ring_block(3.0 * radius, 2.0 * radius, radius, size, 1.3 * radius, growth=1.5, fine_depth=size))
    slab = with_part(slab, "top", "track", 1.2 * radius)
    down = Rigid("bottom", (Freedom("z", load=-LOAD),))
    return Problem(
        (Body(pin, STEEL, rigid=down, name="pin"), Body(slab, STEEL, (Fixed("bottom"),), name="disc")),
        (Contact((0, "top"), (1, "track"), FRICTION, reach=0.1),),
    )


def sliding_cycle(straight: bool) -> Cycle:
    """Press, move the disc until the whole contact slides, then let it travel by 1 km of the track."""
    if straight:
        moved = Placement(np.eye(3), np.array([-DRAG, 0.0, 0.0]))
        travel = Travel(1, translation=(-1e6, 0.0, 0.0))
    else:
        R, centre = turn(DRAG / TRACK, 3), np.array([0.0, -TRACK, 0.0])
        moved = Placement(R, centre - R @ centre)
        travel = Travel(1, rotation=(0.0, 0.0, KILOMETRE), centre=(0.0, -TRACK, 0.0))
    return Cycle((Step(), Step(placements=(Placement.at_rest(3), moved))), (travel,))


def run(size: float, distance: float, straight: bool, disc: float) -> list[Snapshot]:
    """A snapshot at the start and after every block. size: of the cells [mm]; distance: [km]; disc: its K/H [mm²/N]."""
    study = WearStudy(problem(size), (Archard(COEFFICIENT, disc),), sliding_cycle(straight))
    areas = study.geometry.prepared[0].surfaces["top"].weights()
    snapshots = [Snapshot(0.0, 0.0, study.evaluate(np.zeros(len(study.areas))))]
    for block in study.blocks(distance, BlockSettings(first=0.01, tolerance=0.1)):
        pin, *track = study.by_side(1e3 * block.state.depth).values()
        depth = float(areas @ pin) / float(areas.sum())
        deepest = max((float(values.max()) for values in track), default=0.0)
        snapshots.append(Snapshot(block.state.cycles, depth, block.state.evaluation, deepest))
    return snapshots


def draw(snapshots: list[Snapshot], out: Path) -> None:
    """Pictures: pressure on the pin's face at four distances, depth over distance, and an animation of both."""
    chosen = [snapshots[0], *(min(snapshots[1:], key=lambda s: abs(s.distance - d)) for d in (0.1, 1.0)), snapshots[-1]]
    with styled():
        see = "Friction tilts the pin onto its edge; wear makes the pressure uniform"
        figure = sheet("Pressure on the pin as it wears", see, (12.0, 4.0))
        axes = figure.subplots(1, len(chosen))
        for axis, snapshot in zip(axes, chosen):
            shown = contours(axis, snapshot)
        figure.colorbar(shown, ax=axes, label="pressure [MPa]")
        save(figure, out / "pin_on_disc.png")
        figure = sheet("Wear depth of the pin", f"{rate(snapshots):.3f} µm per km; F/A · K/H is {RATE}")
        curve(figure.add_subplot(), snapshots)
        save(figure, out / "depth.png")
        animated(snapshots, out / "animation.gif")


def contours(axis: Axes, snapshot: Snapshot) -> TriContourSet:
    """Pressure on the pin's face."""
    result = snapshot.cycle.contacts[0][-1].result
    axis.set(aspect="equal", title=f"{snapshot.distance:.3g} km", xlabel="x, sliding [mm]", ylabel="y [mm]")
    axis.label_outer()
    return axis.tricontourf(
        *result.points[:, :2].T, result.pressure, np.linspace(0.0, 60.0, 25), cmap=PRESSURE_MAP, extend="max"
    )


def curve(axis: Axes, snapshots: list[Snapshot]) -> None:
    """Depth over distance; a dot a block."""
    axis.plot([s.distance for s in snapshots], [s.depth for s in snapshots], "o-", ms=3)
    axis.set(xlabel="sliding distance [km]", ylabel="mean depth [µm]")


def animated(snapshots: list[Snapshot], path: Path) -> None:
    """The animation, a frame a block: the pressure becomes uniform, the depth grows."""
    figure = sheet("The pin wears", "Left: pressure on its face; right: how far it has worn", (9.6, 4.4))
    face, growth = figure.subplots(1, 2)
    figure.colorbar(contours(face, snapshots[0]), ax=face, label="pressure [MPa]")
    curve(growth, snapshots)
    (dot,) = growth.plot([], [], "o", color="#c22a20", ms=9)

    def frame(snapshot: Snapshot) -> list[Artist]:
        face.clear()
        contours(face, snapshot)
        dot.set_data([snapshot.distance], [snapshot.depth])
        return []

    FuncAnimation(figure, frame, frames=snapshots, init_func=lambda: []).save(path, PillowWriter(fps=4), dpi=90)


def rate(snapshots: list[Snapshot]) -> float:
    """Wear rate [µm per km] over all but the first tenth of the distance."""
    late = [s for s in snapshots if s.distance >= 0.1 * snapshots[-1].distance]
    return float(np.polyfit([s.distance for s in late], [s.depth for s in late], 1)[0])


def skew(snapshot: Snapshot) -> float:
    """Offset [mm] of the force's line of action towards the leading edge, which is at +x."""
    result = snapshot.cycle.contacts[0][-1].result
    force = result.weights * result.pressure
    return float(force @ result.points[:, 0] / force.sum())


def evenness(snapshot: Snapshot) -> tuple[float, float]:
    """Largest relative deviations of p and of p·v from their means within 0.8 of the radius."""
    contact = snapshot.cycle.contacts[0][-1]
    inside = np.hypot(*contact.result.points[:, :2].T) < 0.4 * DIAMETER
    w, deviations = contact.result.weights[inside], []
    for values in (contact.result.pressure[inside], (contact.result.pressure * contact.sliding)[inside]):
        deviations.append(float(np.abs(values / (w @ values / w.sum()) - 1.0).max()))
    return deviations[0], deviations[1]


def check(snapshots: list[Snapshot], straight: bool) -> None:
    """Compares the study with Archard's law for a uniform pressure. Raises AssertionError."""
    first, last = snapshots[0], snapshots[-1]
    (p_first, _), (p_last, pv_last) = evenness(first), evenness(last)
    print(f"{rate(snapshots):.4f} µm per km")
    print(f"force {skew(first):+.3f} mm off the middle, in the end {skew(last):+.4f} mm")
    print(f"pressure even to {100 * p_first:.1f} %, in the end {100 * p_last:.1f} %, p v to {100 * pv_last:.2f} %")
    if last.track:
        print(f"the disc's track is {last.track:.4g} µm deep")
    assert abs(rate(snapshots) / RATE - 1.0) < 0.005, f"wanted {RATE} µm per km, found {rate(snapshots):.4f}"
    assert skew(first) > 0.1, f"wanted the unworn pin to press ahead of its middle, found {skew(first):.3f} mm"
    assert pv_last < 0.02, f"wanted the same depth a turn everywhere, found p v uneven by {100 * pv_last:.1f} %"
    assert not straight or p_last < 0.02, f"wanted the same pressure all over, found it uneven by {100 * p_last:.1f} %"


def main(
    out: Annotated[Path, typer.Option()] = Path("out/pin_on_disc"), quick: bool = False, straight: bool = False,
    km: float = 10.0, disc: Annotated[float, typer.Option("--disc-mm2-per-N", help="K/H of the disc")] = 0.0,
) -> None:
    """Compute, check, write table.csv and the pictures."""
    dolfinx_compat.silence_logs()
    snapshots = run(0.8 if quick else 0.4, km, straight, disc)
    if MPI.COMM_WORLD.rank:
        return
    check(snapshots, straight)
    out.mkdir(parents=True, exist_ok=True)
    with open(out / "table.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["sliding_distance_km", "depth_um"])
        table.writerows([f"{s.distance:.6g}", f"{s.depth:.6g}"] for s in snapshots)
    draw(snapshots, out)


if __name__ == "__main__":
    typer.run(main)
