"""How fast errors fall with the element size: a curved punch on a block, refined uniformly, against a fine mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from evidence.claims import Verification, analytical
from evolvent import Contact, ContactResult, Problem, Solution, Step, sweep
from evolvent.fem.body import Body, Fixed, Traction
from evolvent.fem.lagrange import tabulate
from evolvent.fem.material import STEEL
from evolvent.results.drawing.style import PINION, WHEEL
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import rectangle

SIDE, RADIUS = 2.0, 100.0  # mm
LOADS = (0.88, 0.94, 1.0, 1.06, 1.12)
PRESSURE = 450.0  # MPa on top of the punch, at the load 1
COUNTS, REFERENCE = (4, 8, 16, 32), 128  # cells along a side of the punch
INNER = 0.6  # mm: the part of the contact whose pressure gives p0
PROBLEM = f"""
A steel block of {SIDE:g} by {SIDE:g} mm on rollers (half of it, on the line of symmetry) under a steel punch of the
same size with an underside of {RADIUS:g} mm radius, plane strain, no friction. Nothing of it is singular but the edge
of contact, about half way along. The meshes are uniform, {COUNTS[0]} to {COUNTS[-1]} cells a side on the punch, which
carries the pressure, and 5/4 of that on the block, so that they do not match. Errors are relative, against {REFERENCE}
cells of second order, and root mean squares over {len(LOADS)} loads that move the edge of contact through the cells;
the order is the slope of a line through the three finest meshes.

What to expect: the pressure rises like a square root at the edge of contact, so the displacement lies in H^(5/2−ε)
(Moussaoui & Khodja 1992), and cells of order k give min(k, 3/2) in its gradient, Nitsche's method too, and in L2 of the
pressure 1/2 less at least (Chouly & Hild 2013). By duality the displacement gains one order in L2, a heuristic for
contact. p0 is taken from the middle, where all is smooth: there a stress converges with order k.
"""
QUANTITIES = ("displacement (L2)", "displacement's gradient (L2)", "pressure (L2)", "peak pressure p0")
NITSCHE = "Chouly & Hild, SIAM J. Numer. Anal. 51 (2013)"
THEORY = ("that of the gradient + 1, by duality", NITSCHE, NITSCHE, "stress of smooth solutions")
EXPECTED = {1: (2.0, 1.0, 0.5, 1.0), 2: (2.5, 1.5, 1.0, 2.0)}
FINEST = 3  # meshes that the slope is taken from: on the coarsest, two cells make the contact
TOLERANCE = 0.15


def problem(count: int, order: int, block: int) -> Problem:
    """count, block: cells along a side of the punch and of the block."""
    punch = rectangle(SIDE, SIDE, count, count, order)
    sag = punch.points[:, 0] ** 2 / (2 * RADIUS)
    lifted = np.column_stack([punch.points[:, 0], sag + punch.points[:, 1] * (1 - sag / SIDE), 0 * sag])
    press, symmetry = Traction("top", (0.0, -PRESSURE)), Fixed("left", "x")
    bodies = (
        Body(replace(punch, points=lifted), STEEL, (symmetry,), (press,), name="punch"),
        Body(rectangle(SIDE, SIDE, block, block, order, origin=(0.0, -SIDE)), STEEL, (symmetry, Fixed("bottom", "y"))),
    )
    return Problem(bodies, (Contact((0, "bottom"), (1, "top"), reach=0.1 * SIDE),))


@dataclass(frozen=True)
class Answer:
    """The solution on one mesh at one load, at the quadrature points of the reference.

    displacement: (m, m, 2), of the block [mm].
    gradient:     (m, m, 4), of the displacement.
    pressure:     (m,), along the block's top [MPa].
    peak:         p0 [MPa].
    """

    displacement: Floats
    gradient: Floats
    pressure: Floats
    peak: float


def answers(count: int, order: int, block: int) -> list[Answer]:
    """For all loads."""
    solutions = sweep(problem(count, order, block), [Step(load=load) for load in LOADS])
    value, slope = _interpolation(block, order)
    return [_answer(solution, order, value, slope) for solution in solutions]


def _answer(solution: Solution, order: int, value: Floats, slope: Floats) -> Answer:
    points, nodal = solution.condensed[1].assembled.body.mesh.points, solution.displacement(1)
    sorted_nodes = np.lexsort((np.round(points[:, 1], 9), np.round(points[:, 0], 9)))
    n = value.shape[1]
    u = nodal[sorted_nodes].reshape(n, n, 2)

    def at(left: Floats, right: Floats) -> Floats:
        return np.asarray(np.einsum("ia,abc,jb->ijc", left, u, right, optimize=True))

    gradient = np.concatenate([at(slope, value), at(value, slope)], axis=2)
    return Answer(at(value, value), gradient, *_pressure(solution.contacts[0]))


def _pressure(contact: ContactResult) -> tuple[Floats, float]:
    """The pressure on the quadrature's line, and p0 of a quartic in x through its inner part."""
    order = np.argsort(contact.points[:, 0])
    x, p = contact.points[order, 0], contact.pressure[order]
    inner = x < INNER
    root = np.sqrt(contact.weights[order][inner])  # segments differ in length, but not in their number of points
    peak = np.polyfit(x[inner] ** 2, p[inner] ** 2, 2, w=root)[-1]
    return np.interp(_line()[0], x, p), float(np.sqrt(peak))


def _line() -> tuple[Floats, Floats]:
    """Gauss points and weights (m,) of the reference's cells along a side."""
    nodes, weights = np.polynomial.legendre.leggauss(3)
    h = SIDE / REFERENCE
    x = (np.arange(REFERENCE)[:, None] + 0.5 * (nodes + 1)) * h
    return x.ravel(), np.tile(0.5 * h * weights, REFERENCE)


def _interpolation(count: int, order: int) -> tuple[Floats, Floats]:
    """Values and slopes (m, order·count + 1) of a line of cells' shape functions at the points of `_line`."""
    x, h = _line()[0], SIDE / count
    cell = np.minimum((x / h).astype(int), count - 1)
    N, dN = tabulate("interval", order, (x / h - cell)[:, None])
    columns = order * cell[:, None] + np.array([0, order, 1][: order + 1])  # basix: the ends first, then the middle
    value, slope = np.zeros((2, len(x), order * count + 1))
    rows = np.arange(len(x))[:, None]
    value[rows, columns], slope[rows, columns] = N, dN[:, 0] / h
    return value, slope


def _norm(field: Floats) -> float:
    """L2 norm of a field (m, m, c) over the block or (m,) along its top."""
    w = _line()[1]
    weights = w if field.ndim == 1 else w[:, None, None] * w[:, None]
    return float(np.sqrt((weights * field**2).sum()))


def _errors(computed: Answer, exact: Answer) -> tuple[float, ...]:
    """Relative, in the order of QUANTITIES."""
    pairs = (
        (computed.displacement, exact.displacement),
        (computed.gradient, exact.gradient),
        (computed.pressure, exact.pressure),
    )
    return (*(_norm(f - e) / _norm(e) for f, e in pairs), abs(computed.peak / exact.peak - 1.0))


def all_errors() -> dict[int, Floats]:
    """Errors (mesh, quantity) of each order."""
    exact = answers(REFERENCE, 2, REFERENCE)
    result = {}
    for order in EXPECTED:
        rows = [[_errors(f, e) for f, e in zip(answers(n, order, 5 * n // 4), exact)] for n in COUNTS]
        result[order] = np.sqrt(np.mean(np.array(rows) ** 2, axis=1))
    return result


def slopes(errors: Floats) -> Floats:
    """Observed order (quantity,) of errors (mesh, quantity)."""
    return np.asarray(-np.polyfit(np.log(COUNTS[-FINEST:]), np.log(errors[-FINEST:]), 1)[0])


def verify() -> Verification:
    """Solves four meshes of each order and the reference."""
    errors = all_errors()
    claims = [
        analytical(source).at_least(
            f"order of convergence of the {name}, cells of order {order}", float(slope), least, TOLERANCE
        )
        for order in EXPECTED
        for name, slope, least, source in zip(QUANTITIES, slopes(errors[order]), EXPECTED[order], THEORY)
    ]
    return Verification(
        "orders",
        "Orders of convergence",
        PROBLEM,
        tuple(claims),
        lambda figure: draw(figure, errors),
        "Second-order cells gain half an order in the gradient: the edge of contact allows no more",
    )


def draw(figure: Figure, errors: dict[int, Floats]) -> None:
    """Errors over the element size, with the expected slopes through the finest mesh."""
    h = SIDE / np.array(COUNTS)
    panels = figure.subplots(1, 4, sharex=True)
    for axes, name, column in zip(panels, QUANTITIES, range(4)):
        for (order, values), colour, marker in zip(errors.items(), (PINION, WHEEL), "os"):
            axes.loglog(h, 100 * values[:, column], marker, color=colour, ms=5, label=f"cells of order {order}")
            expected = EXPECTED[order][column]
            line = 100 * values[-1, column] * (h / h[-1]) ** expected
            axes.loglog(h, line, "-", color=colour, lw=1.0, label=f"slope {expected:g}")
        axes.set_title(name, fontsize=10)
        axes.set_xticks(h, [f"1/{1 / x:g}" for x in h])
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set_xlabel("element size [mm]")
        axes.legend(fontsize=8)
    panels[0].set_ylabel("relative error [%]")
