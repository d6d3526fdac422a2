"""A steel ball of 8 mm radius on a steel block under 2000 N, with and without friction; a quarter model.

    python demos/hertz_sphere.py [--quick] [--out DIR]

Two planes of symmetry are supports, the far side of the ball moves as a rigid body under a quarter of the load. The
contact is small against the bodies (a/R = 0.06), so Hertz' answer is good to about a per cent; the element size is
judged against a finer mesh of the same problem. Between equal materials friction changes next to nothing.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib
import numpy as np
import typer
from matplotlib.axes import Axes
from mpi4py import MPI

from meshes.blocks import graded_box, sphere_quarter
from meshes.data import Floats, MeshData
from solver import compat, hertz
from solver.body import Body, Fixed, Freedom, Rigid
from solver.material import STEEL
from solver.problem import Contact, ContactResult, Problem, Solution, solve
from solver.stress import cell_stress, von_mises

RADIUS, LOAD, SIDE = 8.0, 2000.0, 4.0  # mm, N, mm
MODULUS = hertz.contact_modulus(210e3, 0.3, 210e3, 0.3)
HERTZ = hertz.point_contact(LOAD, RADIUS, MODULUS)


@dataclass(frozen=True)
class Profile:
    """λ over the radius: radius (n,), pressure (n,), weights (n,) areas of the points."""

    radius: Floats
    pressure: Floats
    weights: Floats

    @staticmethod
    def of(contact: ContactResult) -> Profile:
        """Of a solution."""
        return Profile(np.hypot(*contact.points[:, :2].T), contact.pressure, contact.weights)

    @property
    def peak(self) -> float:
        """p0 [MPa] of the ellipse that fits the middle 70 % of the radius: single nodes scatter more."""
        middle = self.radius < 0.7 * HERTZ.radius
        return float(np.sqrt(np.polyfit(self.radius[middle] ** 2, self.pressure[middle] ** 2, 1)[-1]))

    def error(self, scale: float = 1.0) -> float:
        """Relative L2 distance from Hertz' profile with `scale` times his peak, within 0.9 a.

        The rim is left out: there the slope is infinite, and the nodes only say within which cell it lies.
        """
        inside = self.radius < 0.9 * HERTZ.radius
        r, p, w = self.radius[inside], self.pressure[inside], self.weights[inside]
        exact = scale * hertz.line_pressure(r, HERTZ.radius, HERTZ.peak_pressure)
        return float(np.sqrt(w @ (p - exact) ** 2 / (w @ exact**2)))


def ball_on_block(
    cells: float,
    order: int = 2,
    ratio: float = 1.2,
    first: str = "block",
    friction: float = 0.0,
    shape: str = "hexahedron",
) -> Problem:
    """A quarter of ball and block with cells of a/`cells` on the ball and `ratio` times finer ones on the block."""
    size, fine, depth = HERTZ.radius / cells, 1.25 * HERTZ.radius, 0.5 * HERTZ.radius
    ball = sphere_quarter(RADIUS, SIDE, SIDE, size, fine, order, shape, 1.7, depth)
    block = graded_box(SIDE, SIDE, size / ratio, fine, order, shape, 1.7, depth)
    symmetry = (Fixed("symmetry_x", "x"), Fixed("symmetry_y", "y"))
    bodies = (
        Body(
            near_contact(ball, "arc"), STEEL, symmetry, rigid=Rigid("top", (Freedom("z", load=-LOAD / 4),)), name="ball"
        ),
        Body(near_contact(block, "top"), STEEL, (*symmetry, Fixed("bottom")), name="block"),
    )
    sides = ((1, "contact"), (0, "contact")) if first == "block" else ((0, "contact"), (1, "contact"))
    return Problem(bodies, (Contact(*sides, friction, reach=0.1 * HERTZ.radius),))


def near_contact(mesh: MeshData, group: str) -> MeshData:
    """The mesh with a facet group "contact": the facets of `group` within 1.5 a. What cannot touch costs nothing."""
    facets = mesh.facets[group]
    near = np.hypot(*mesh.points[facets, :2].mean(axis=1).T) < 1.5 * HERTZ.radius
    return replace(mesh, facets={**mesh.facets, "contact": facets[near]})


def main(out: Path = Path("out/hertz_sphere"), quick: bool = False) -> None:
    """Solve, compare, write table.csv and hertz_sphere.png. Raises AssertionError where a bound is missed."""
    compat.silence_logs()
    cells = (2, 3) if quick else (2, 3, 4, 6)
    solutions = {n: solve(ball_on_block(n)) for n in cells}
    profiles = {n: Profile.of(s.contacts[0]) for n, s in solutions.items()}
    rough = Profile.of(solve(ball_on_block(2, friction=0.2)).contacts[0])
    finest = profiles[cells[-1]]
    table = [("mesh", "p0 [MPa]", "against finest [%]", "against Hertz [%]", "approach [mm]")]
    for n, p in profiles.items():
        to_finest, to_hertz = (f"{100 * (p.peak / r - 1):.2f}" for r in (finest.peak, HERTZ.peak_pressure))
        table.append((f"a/{n}", f"{p.peak:.1f}", to_finest, to_hertz, f"{-solutions[n].motions[0][0]:.5f}"))
    table.append(
        ("a/2, friction 0.2", f"{rough.peak:.1f}", "", f"{100 * (rough.peak / HERTZ.peak_pressure - 1):.2f}", "")
    )
    table.append(("Hertz", f"{HERTZ.peak_pressure:.1f}", "", "", f"{HERTZ.approach:.5f}"))
    if MPI.COMM_WORLD.rank == 0:
        out.mkdir(parents=True, exist_ok=True)
        with open(out / "table.csv", "w", newline="") as file:
            csv.writer(file).writerows(table)
        print("\n".join(f"{a:<20}{b:>10}{c:>20}{d:>20}{e:>16}" for a, b, c, d, e in table))
        draw(out / "hertz_sphere.png", solutions[cells[-1]], finest, cells[-1])
    for n, p in profiles.items():
        force = 4.0 * abs(float(solutions[n].contacts[0].force[2]))
        assert abs(force / LOAD - 1) < 1e-8, f"a/{n}: wanted the load {LOAD} N back, found {force} N"
        assert abs(p.peak / finest.peak - 1) < 0.02, f"a/{n}: wanted p0 within 2 % of the finest mesh, found {p.peak}"
    assert abs(finest.peak / HERTZ.peak_pressure - 1) < 0.02, "wanted p0 within 2 % of Hertz"


def draw(path: Path, solution: Solution, profile: Profile, cells: int) -> None:
    """Pressure on the block, pressure over the radius, stress in the plane of symmetry."""
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 3, figsize=(16, 5), layout="constrained")
    figure.suptitle(
        f"Ball on block, {LOAD:g} N: peak pressure {profile.peak:.0f} MPa (Hertz {HERTZ.peak_pressure:.0f})"
    )
    _map(axes[0], solution.contacts[0], 0.5 * HERTZ.radius / cells)
    _radius(axes[1], profile, cells)
    _section(axes[2], solution)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def _map(axis: Axes, contact: ContactResult, size: float) -> None:
    quarter, values = _averaged(contact, size)
    signs = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)])
    points = np.concatenate([quarter * s for s in signs])
    pressure = np.tile(values, 4)
    shown = axis.tricontourf(*points.T, pressure, levels=np.linspace(0.0, 1.02 * HERTZ.peak_pressure, 22), cmap="turbo")
    turn = np.linspace(0, 2 * np.pi, 200)
    axis.plot(HERTZ.radius * np.cos(turn), HERTZ.radius * np.sin(turn), "w--", lw=1.2)
    limit = 1.25 * HERTZ.radius
    axis.set(xlim=(-limit, limit), ylim=(-limit, limit), aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    axis.set_title("Pressure on the block (mean over half cells; dashed: Hertz' radius)", fontsize=10)
    axis.figure.colorbar(shown, ax=axis, label="contact pressure [MPa]", shrink=0.85)


def _averaged(contact: ContactResult, size: float) -> tuple[Floats, Floats]:
    """Mean positions (n, 2) and pressures (n,) of the contact points in squares of this size."""
    _, which = np.unique(np.floor(contact.points[:, :2] / size), axis=0, return_inverse=True)
    which = which.reshape(-1)
    weight = np.bincount(which, contact.weights)
    x, y, p = (np.bincount(which, contact.weights * v) / weight for v in (*contact.points[:, :2].T, contact.pressure))
    return np.column_stack([x, y]), p


def _radius(axis: Axes, profile: Profile, cells: int) -> None:
    r = np.linspace(0, HERTZ.radius, 300)
    axis.fill_between(r, hertz.line_pressure(r, HERTZ.radius, HERTZ.peak_pressure), color="0.88", label="Hertz")
    axis.plot(
        profile.radius,
        profile.pressure,
        ".",
        color="tab:red",
        ms=2,
        label=f"all contact points, order 2, h = a/{cells}",
    )
    axis.set(
        xlim=(0, 1.4 * HERTZ.radius),
        ylim=(0, None),
        xlabel="distance from the centre [mm]",
        ylabel="contact pressure [MPa]",
    )
    axis.set_title("All points near one curve; the rim is known to within a cell", fontsize=10)
    axis.legend(fontsize=8)


def _section(axis: Axes, solution: Solution) -> None:
    from matplotlib.collections import PolyCollection

    corners, values = [], []
    for index, prepared in enumerate(solution.prepared):
        body = prepared.assembled.body
        u = solution.displacement(index)
        facets = body.mesh.facets["symmetry_y"]
        behind = _cells_of(body.mesh, facets)
        corners.append((body.mesh.points[:, :3] + u)[facets[:, :4]][..., [0, 2]])
        values.append(von_mises(cell_stress(body.mesh, body.material, u))[behind])
    half = np.concatenate(corners)
    both, level = np.concatenate([half, half * (-1.0, 1.0)]), np.tile(np.concatenate(values), 2)
    cells = PolyCollection(list(both), array=level, cmap="turbo", edgecolors=(0, 0, 0, 0.25), linewidths=0.3)
    cells.set_clim(0.0, 0.65 * HERTZ.peak_pressure)
    axis.add_collection(cells)
    limit = 2.2 * HERTZ.radius
    axis.set(xlim=(-limit, limit), ylim=(-limit, limit), aspect="equal", xlabel="x [mm]", ylabel="z [mm]")
    axis.set_title("Section: the material yields first below the surface", fontsize=10)
    axis.figure.colorbar(cells, ax=axis, label="von Mises stress [MPa]", shrink=0.85)


def _cells_of(mesh: MeshData, facets: np.ndarray) -> np.ndarray:
    """The cell (f,) that has the corners of each facet."""
    on_facet = np.zeros(len(mesh.points), dtype=bool)
    on_facet[facets] = True
    rows = np.flatnonzero(on_facet[mesh.cells].sum(axis=1) >= facets.shape[1])
    centre = {tuple(np.sort(f)): i for i, f in enumerate(facets)}
    found = np.empty(len(facets), dtype=np.int64)
    for row in rows:
        key = tuple(np.sort(mesh.cells[row][on_facet[mesh.cells[row]]]))
        if key in centre:
            found[centre[key]] = row
    return found


if __name__ == "__main__":
    typer.run(main)
