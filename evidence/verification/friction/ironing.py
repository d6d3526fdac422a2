"""Ironing: a die is pressed into a softer block and dragged over many of its elements; the reaction stays smooth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from evidence.claims import Claim, Verification, analytical
from evolvent import Contact, Placement, Problem, Solution, Step, sweep
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import STEEL, Material
from evolvent.fem.stress import cell_stress, von_mises
from evolvent.results.drawing.style import INK, PINION, TEETH, WHEEL, note
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.shapes.blocks import cylinder_2d, graded_rectangle
from evolvent_meshes.shapes.variants import with_part

ALUMINIUM = Material(70e3, 0.3)
RADIUS, DEPTH = 10.0, 0.02  # of the die, prescribed approach [mm]
ELEMENT = 0.2  # length of the block's elements under the way [mm]
DRAGGED = 8  # elements
WAY = DRAGGED * ELEMENT
STEPS = 8  # an element
FRICTIONS = (0.0, 0.3)
RIPPLE = 2e-3  # of the mean reaction; docs/evidence.md accepts 5e-3 for what an engineer reads
SETTLING = 1.0  # elements after which friction slides everywhere


@dataclass(frozen=True)
class Ironed:
    """The die dragged along the block.

    x:         (k,), places of the die [mm].
    solutions: at each place.
    """

    friction: float
    x: Floats
    solutions: list[Solution]

    @cached_property
    def reaction(self) -> Floats:
        """(k, 2) of the block on the die [N/mm]: tangential (against the way), normal."""
        force = np.array([solution.contacts[0].force for solution in self.solutions])
        return force * np.sign(force[-1, 1]) * np.array([-1.0, 1.0])

    @property
    def settled(self) -> Bools:
        """(k,) bool: past the distance over which friction builds up."""
        return np.asarray(self.x >= self.x[0] + SETTLING * ELEMENT - 1e-12)

    def smooth(self, component: int) -> Floats:
        """(k,) the parabola through the settled reaction: the finite block's compliance along the way."""
        here = self.settled
        return np.polyval(np.polyfit(self.x[here], self.reaction[here, component], 2), self.x)

    def ripple(self, component: int) -> float:
        """Largest distance from the parabola over the mean."""
        off = (self.reaction[:, component] - self.smooth(component))[self.settled]
        return float(np.abs(off).max() / np.abs(self.reaction[self.settled, component]).mean())

    @cached_property
    def imbalance(self) -> float:
        """Largest residual of the equilibrium over the force, and of what the block's functionals carry."""
        return max(solution.imbalance for solution in self.solutions)

    @cached_property
    def unequal(self) -> float:
        """Largest difference of the forces on die and block over the force."""
        worst = 0.0
        for solution in self.solutions:
            on = [solution.nodal_forces[body].reshape(-1, 2).sum(axis=0) for body in (0, 1)]
            worst = max(worst, float(np.linalg.norm(on[0] + on[1]) / np.linalg.norm(on[0])))
        return worst


def problem(friction: float, element: float = ELEMENT) -> Problem:
    """The block, whose elements the die passes, carries the pressure: it is the coarser one."""
    near = 6.0 * ELEMENT
    fine = 0.5 * WAY + near
    freedoms = (Freedom("x", displacement=0.0), Freedom("y", displacement=-DEPTH))
    disc = cylinder_2d(RADIUS, element / 1.37, near, contact=near)
    die = Body(disc, STEEL, rigid=Rigid("top", freedoms), name="die")
    mesh = graded_rectangle(40.0, 15.0, element, fine, fine_depth=0.6)
    block = Body(with_part(mesh, "top", "way", fine), ALUMINIUM, (Fixed("bottom"),), name="block")
    return Problem((die, block), (Contact((1, "way"), (0, "arc"), friction, reach=0.1),))


def iron(friction: float, element: float = ELEMENT) -> Ironed:
    """Pressed at the start of the way, then dragged to the right."""
    count = round(STEPS * WAY / element)
    x, at_rest = np.linspace(-0.5, 0.5, count + 1) * WAY, Placement.at_rest(2)
    steps = [Step(placements=(Placement(np.eye(2), np.array([place, 0.0])), at_rest)) for place in x]
    return Ironed(friction, x, list(sweep(problem(friction, element), steps)))


def verify() -> Verification:
    """Without and with friction."""
    cases = [iron(friction) for friction in FRICTIONS]
    halved = iron(0.0, 0.5 * ELEMENT)
    return Verification(
        "ironing",
        "Ironing: large sliding over a coarse mesh",
        "A steel die (R = 10 mm) is pushed 20 µm into an aluminium block (plane strain, small strain) and dragged 1.6 "
        "mm: eight of the block's second-order elements, three of which lie in the contact. Exact: the block is long, "
        "so the reaction hardly changes, and with friction its tangential part is μ times the normal one. The mesh "
        "shows as a ripple with the period of the elements. It comes from the edges of contact, which cross "
        "elements, and falls nearly like h²: segments follow the die, and nothing is decided at nodes, which would "
        "make the reaction jump at each.",
        tuple(_claims(cases[0], cases[1], halved)),
        lambda figure: _draw(figure, cases, halved),
        "The reaction changes by less than 0.2 % while the die passes elements of a third of the contact",
    )


def _claims(smooth: Ironed, rough: Ironed, halved: Ironed) -> list[Claim]:
    here = rough.settled
    ratio = rough.reaction[here, 0] / rough.reaction[here, 1]
    drift = float(np.ptp(smooth.smooth(1)[smooth.settled]) / smooth.reaction[:, 1].mean())
    improved = halved.ripple(1) / smooth.ripple(1)
    coulomb = analytical("Coulomb's law, flat normals, everything slides")
    same = analytical("the same")
    return [
        analytical("a smooth force").bound("ripple of the normal reaction, μ = 0", smooth.ripple(1), RIPPLE),
        same.bound("ripple of the normal reaction, μ = 0.3", rough.ripple(1), RIPPLE),
        same.bound("ripple of the tangential reaction, μ = 0.3", rough.ripple(0), RIPPLE),
        analytical("order 1½ or better").bound(
            "ripple with elements of half the size over this, μ = 0", improved, 0.35
        ),
        analytical("a long block").bound("change of the smoothed reaction over the way, μ = 0", drift, 0.01),
        coulomb.bound("tangential over normal reaction, off μ = 0.3 by", float(np.abs(ratio - 0.3).max()), 1e-8),
        analytical("actio = reactio").bound(
            "forces on die and block, sum over size", max(smooth.unequal, rough.unequal), 1e-8
        ),
        analytical("equilibrium").bound("residual over force", max(smooth.imbalance, rough.imbalance), 1e-8),
    ]


def _draw(figure: Figure, cases: list[Ironed], halved: Ironed) -> None:
    grid = figure.add_gridspec(2, 2, width_ratios=(1.3, 1))
    _reactions(figure.add_subplot(grid[0, 0]), cases)
    _ripples(figure.add_subplot(grid[1, 0]), cases, halved)
    _stress(figure.add_subplot(grid[:, 1]), cases[1])


def _reactions(axes: Axes, cases: list[Ironed]) -> None:
    for case, colour in zip(cases, (PINION, WHEEL), strict=True):
        at = (case.x - case.x[0]) / ELEMENT
        axes.plot(at, case.reaction[:, 1], color=colour, label=f"normal, μ = {case.friction:g}")
    axes.plot(at, cases[1].reaction[:, 0], "--", color=WHEEL, label="tangential, μ = 0.3")
    axes.set(xlim=(0, DRAGGED), ylim=(0, None), ylabel="reaction [N/mm]")
    axes.legend(loc="center right")


def _ripples(axes: Axes, cases: list[Ironed], halved: Ironed) -> None:
    axes.axhspan(-1e2 * RIPPLE, 1e2 * RIPPLE, color="#eef0f2", label="accepted")
    shown = (
        (cases[0], PINION, "μ = 0"),
        (cases[1], WHEEL, "μ = 0.3"),
        (halved, TEETH[0], "μ = 0, elements of half the size"),
    )
    for case, colour, label in shown:
        here, smooth = case.settled, case.smooth(1)
        off = 100.0 * (case.reaction[:, 1] / smooth - 1.0)
        axes.plot(((case.x - case.x[0]) / ELEMENT)[here], off[here], ".-", ms=3, lw=0.9, color=colour, label=label)
    axes.set(xlim=(0, DRAGGED), ylim=(-0.25, 0.42), xlabel="dragged, in elements of the block",
             ylabel="off its parabola [%]")
    axes.legend(loc="upper left", ncols=2, fontsize=8)


def _stress(axes: Axes, case: Ironed) -> None:
    """Both bodies at the end of the way."""
    last, place = case.solutions[-1], np.array([case.x[-1], 0.0])
    corners, values = [], []
    for index, shift in ((0, place), (1, 0.0 * place)):
        body = last.condensed[index].assembled.body
        u = last.displacement(index)
        corners.append((body.mesh.points[:, :2] + u + shift)[body.mesh.cells[:, :4]])
        values.append(von_mises(cell_stress(body.mesh, body.material, u)))
    shown = PolyCollection(list(np.concatenate(corners)), array=np.concatenate(values), cmap="turbo",
                           edgecolors=(0, 0, 0, 0.3), linewidths=0.3)
    axes.add_collection(shown)
    axes.grid(visible=False)
    axes.annotate("", (2.1, 1.0), (1.3, 1.0), arrowprops={"arrowstyle": "->", "color": "white", "lw": 1.5})
    axes.set(xlim=(-1.6, 2.4), ylim=(-2.2, 1.3), aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    axes.figure.colorbar(shown, ax=axes, label="von Mises stress [MPa], μ = 0.3", shrink=0.7)
    note(axes, "end of the way", 0.03, 0.97)
    axes.tick_params(labelcolor=INK)
