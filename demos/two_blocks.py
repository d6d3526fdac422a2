"""Patch test: two blocks with non-matching meshes transmit a uniform pressure, and a uniform shear, exactly.

    python demos/two_blocks.py [--quick] [--out DIR]

Every mesh can represent a uniform stress, so that the contact has to transmit it to solver accuracy, for every cell
shape and order and whichever body carries the pressure. With friction the upper block is held sideways by friction
alone: the interface must stick under a shear below μp.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
import typer
from matplotlib.axes import Axes
from mpi4py import MPI

from evolvent import Body, Contact, Fixed, Material, MeshData, Problem, Solution, Traction, solve
from evolvent.fem.backend import dolfinx_compat
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import box, rectangle

PRESSURE, SHEAR, FRICTION = 100.0, 20.0, 0.3
BOUND = 1e-6  # of the pressure
NAMES = {"triangle": "tri", "quadrilateral": "quad", "tetrahedron": "tet", "hexahedron": "hex"}


@dataclass(frozen=True)
class Patch:
    """One variant of the patch test.

    shape: of the cells of both blocks.
    order: of the cells, 1 or 2.
    first: the body that carries the pressure, 0 upper, 1 lower.
    friction: μ; without it no shear is applied.
    """

    shape: str
    order: int
    first: int = 0
    friction: float = 0.0

    @property
    def d(self) -> int:
        """Dimension of space."""
        return 2 if self.shape in ("triangle", "quadrilateral") else 3

    def meshes(self) -> tuple[MeshData, MeshData]:
        """Upper and lower block, 2 x 2 x 1 mm each, meeting in a plane where no facet edges match."""
        if self.d == 2:
            return (
                rectangle(2.0, 1.0, 5, 3, self.order, self.shape, origin=(0.0, 1.0)),
                rectangle(2.0, 1.0, 7, 4, self.order, self.shape),
            )
        return (
            box((2.0, 2.0, 1.0), (3, 2, 2), self.order, self.shape, origin=(0.0, 0.0, 1.0)),
            box((2.0, 2.0, 1.0), (4, 3, 2), self.order, self.shape),
        )

    def problem(self) -> Problem:
        """Pressed between a support below and a pressure on top; with friction also sheared.

        Sheared blocks have ν = 0, so that a clamped bottom does not disturb the uniform stress.
        """
        upper, lower = self.meshes()
        up, across = "xyz"[self.d - 1], "xyz"[: self.d - 1]
        sides = ((0, "bottom"), (1, "top"))
        contact = Contact(sides[self.first], sides[1 - self.first], self.friction, reach=0.1)
        if self.friction:
            material, loads = Material(210e3, 0.0), self._sheared()
            bodies = (Body(upper, material, loads=loads[0]), Body(lower, material, (Fixed("bottom"),), loads[1]))
        else:
            rolls = tuple(Fixed({"x": "left", "y": "front"}[axis], axis) for axis in across)
            press = (Traction("top", self._vector(-1, -PRESSURE)),)
            bodies = (
                Body(upper, supports=rolls, loads=press),
                Body(lower, Material(70e3, 0.3), supports=(*rolls, Fixed("bottom", up))),
            )
        return Problem(bodies, (contact,))

    def _vector(self, axis: int, value: float) -> tuple[float, ...]:
        v = np.zeros(self.d)
        v[axis] = value
        return tuple(v)

    def _sheared(self) -> tuple[tuple[Traction, ...], tuple[Traction, ...]]:
        """Boundary tractions of the uniform stress: pressure, and shear in x."""
        ends = (Traction("right", self._vector(-1, SHEAR)), Traction("left", self._vector(-1, -SHEAR)))
        top = np.add(self._vector(-1, -PRESSURE), self._vector(0, SHEAR))
        return (Traction("top", tuple(top)), *ends), ends

    def errors(self, solution: Solution, rotation: Floats | None = None) -> Floats:
        """|traction − exact| / pressure at the points of the interface, (q,); rotation: of both blocks."""
        R = np.eye(self.d) if rotation is None else rotation
        sign = -1.0 if self.first == 0 else 1.0  # the outward normal of the upper block's face points down
        exact = sign * (
            np.asarray(self._vector(-1, PRESSURE)) - np.asarray(self._vector(0, SHEAR if self.friction else 0.0))
        )
        traction = solution.contacts[0].traction
        return np.asarray(np.linalg.norm(traction - exact @ R.T, axis=1) / PRESSURE)


def variants(quick: bool) -> list[Patch]:
    """All shapes, orders, sides and friction; quick: the second order in 2D only."""
    shapes = ("triangle", "quadrilateral") if quick else ("triangle", "quadrilateral", "tetrahedron", "hexahedron")
    orders = (2,) if quick else (1, 2)
    return [Patch(s, o, first, μ) for s in shapes for o in orders for first in (0, 1) for μ in (0.0, FRICTION)]


def main(out: Path = Path("out/two_blocks"), quick: bool = False) -> None:
    """Solve all variants, write table.csv and two_blocks.png. Raises AssertionError where a bound is missed."""
    dolfinx_compat.silence_logs()
    patches = variants(quick)
    worst = {patch: float(patch.errors(solve(patch.problem())).max()) for patch in patches}
    shown = Patch("triangle", 2, friction=FRICTION)
    solution = solve(shown.problem())
    table = [("cells", "order", "pressure on", "friction", "largest error / p")]
    table += [
        (p.shape, str(p.order), ("upper", "lower")[p.first], f"{p.friction:g}", f"{e:.1e}") for p, e in worst.items()
    ]
    if MPI.COMM_WORLD.rank == 0:
        out.mkdir(parents=True, exist_ok=True)
        with open(out / "table.csv", "w", newline="") as file:
            csv.writer(file).writerows(table)
        print("\n".join(f"{a:<15}{b:<7}{c:<13}{d:<10}{e:>18}" for a, b, c, d, e in table))
        draw(out / "two_blocks.png", solution, worst)
    assert max(worst.values()) < BOUND, (
        f"patch test: wanted an error below {BOUND} of p, found {max(worst.values()):.1e}"
    )


def draw(path: Path, solution: Solution, worst: dict[Patch, float]) -> None:
    """The sheared blocks with the traction between them, and the errors of all variants."""
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(12.5, 5.2), layout="constrained")
    figure.suptitle("Patch test: non-matching meshes pass a uniform pressure and shear to solver accuracy")
    _blocks(left, solution)
    _bars(right, worst)
    figure.savefig(path, dpi=150)
    plt.close(figure)


def _blocks(axis: Axes, solution: Solution, scale: float = 300.0) -> None:
    from matplotlib.collections import PolyCollection

    for index, colour in ((0, "#9ecae1"), (1, "#fdd0a2")):
        mesh = solution.condensed[index].assembled.body.mesh
        position = mesh.points[:, :2] + scale * solution.displacement(index)
        corners = position[mesh.cells[:, : 3 if mesh.shape == "triangle" else 4]]
        axis.add_collection(PolyCollection(list(corners), facecolors=colour, edgecolors="0.35", linewidths=0.7))
        if index == 1:
            top = position[np.unique(mesh.facets["top"])]
    result = solution.contacts[0]
    x = np.linspace(0.1, 1.9, 13)
    order = np.argsort(result.points[:, 0])
    on_lower = np.stack([np.interp(x, *np.c_[result.points[:, 0], t][order].T) for t in result.traction.T], axis=1)
    arrows = 0.35 / PRESSURE * on_lower
    height = np.interp(x, *np.sort(top, axis=0).T)
    style = {"angles": "xy", "scale_units": "xy", "scale": 1, "width": 0.004, "color": "tab:red", "zorder": 3}
    axis.quiver(x, height - arrows[:, 1], *arrows.T, **style)
    axis.set(xlim=(-0.25, 2.45), ylim=(-0.1, 2.15), aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    axis.set_title(
        f"p = {PRESSURE:g} MPa and τ = {SHEAR:g} MPa all along (red; μ = {FRICTION}, deformed × {scale:g})", fontsize=10
    )


def _bars(axis: Axes, worst: dict[Patch, float]) -> None:
    groups = sorted({(p.d, p.shape, p.order) for p in worst})
    for offset, (first, friction) in enumerate([(0, 0.0), (1, 0.0), (0, FRICTION), (1, FRICTION)]):
        errors = [worst[Patch(shape, order, first, friction)] for _, shape, order in groups]
        name = f"pressure on the {('coarser', 'finer')[first]} block, " + (
            "sheared, sticks" if friction else "no friction"
        )
        axis.bar(np.arange(len(groups)) + 0.2 * (offset - 1.5), np.maximum(errors, 1e-17), 0.18, label=name)
    axis.set_yscale("log")
    axis.set_ylim(1e-16, 1e-3)
    axis.axhline(BOUND, color="k", lw=1, ls="--")
    axis.text(-0.45, 1.5 * BOUND, "what this demo accepts", fontsize=9)
    axis.set_xticks(np.arange(len(groups)), [f"{NAMES[shape]}\norder {order}" for _, shape, order in groups])
    axis.set_ylabel("largest error of the traction / p")
    axis.set_title("Every cell shape and order, either block carrying the pressure", fontsize=10)
    axis.legend(fontsize=7, loc="upper center", ncols=2)


if __name__ == "__main__":
    typer.run(main)
