"""A flat punch, a hundred to a hundred million times as stiff as the block that it is pressed on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from evidence.claims import Claim, Verification, analytical
from evolvent import Contact, Problem, Solution, solve
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import Material
from evolvent.results.drawing.style import FAINT, TEETH, WHEEL
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import graded_rectangle, rectangle
from evolvent_meshes.shapes.variants import with_part

HALF_WIDTH, BLOCK, SUNK = 1.0, 100.0, 1e-3  # mm
CELLS = 16  # per half-width, on the block
SOFT = Material(1e3, 0.3)
RATIOS = (1e2, 1e4, 1e6, 1e8)
ORDERS = ("punch first", "block first")
MIDDLE, BESIDE = 0.8, 3.0  # half-widths: where the pressure is compared, where the block's sinking is
SOURCE = analytical("Sadowsky 1928; Johnson 1985, section 2.8")
PROBLEM = f"""
A punch with a flat face 2a = {2 * HALF_WIDTH:g} mm wide is pressed {SUNK * 1e3:g} µm into a block ({BLOCK:g} mm), plane
strain, no friction. The stiffer the punch, the nearer is the pressure to that of a rigid one on a half-plane,
P/π√(a² − x²), infinite at the corners; the block's surface at x, beside the punch, stays behind it by
(2P/πE') arccosh x/a. The punch is 1e2 to 1e8 times as stiff as the block, and named first in one series and second in
the other: there is one equilibrium, which either must find. Beyond a ratio of 10 the softer body carries the pressure,
whichever is named first. Second-order quadrilaterals of a/{CELLS} on the block; a cell ends at the corner on both
bodies, others do not match.
"""


@dataclass(frozen=True)
class Pressed:
    """The punch pressed into the block."""

    force: float
    """P [N/mm]."""
    x: Floats
    """(q,) of the points [mm]; `pressure` (q,) [MPa]."""
    pressure: Floats
    behind: float
    """By which the surface at BESIDE a stays behind the punch [mm]."""

    @staticmethod
    def of(solution: Solution) -> Pressed:
        contact, mesh = solution.contacts[0], solution.condensed[1].assembled.body.mesh
        beside = np.argmin(np.hypot(mesh.points[:, 0] - BESIDE * HALF_WIDTH, mesh.points[:, 1]))
        order = np.argsort(contact.points[:, 0])
        behind = float(solution.displacement(1)[beside, 1]) + SUNK
        return Pressed(abs(float(contact.force[1])), contact.points[order, 0], contact.pressure[order], behind)

    @property
    def exact(self) -> Floats:
        """The rigid punch's pressure of this force."""
        return np.asarray(self.force / (np.pi * np.sqrt(HALF_WIDTH**2 - self.x**2)))

    @property
    def error(self) -> float:
        """Relative L2 distance from it in the middle."""
        middle = np.abs(self.x) < MIDDLE * HALF_WIDTH
        off = self.pressure[middle] - self.exact[middle]
        return float(np.linalg.norm(off) / np.linalg.norm(self.exact[middle]))

    @property
    def left_behind(self) -> float:
        """Exactly, of a rigid punch on a half-plane."""
        return float(2.0 * self.force / (np.pi * SOFT.plane_modulus) * np.arccosh(BESIDE))


def problem(ratio: float, order: str) -> Problem:
    """ratio: of the moduli. order: one of ORDERS."""
    size, fine = HALF_WIDTH / CELLS, 1.5 * HALF_WIDTH
    face = rectangle(2.0 * HALF_WIDTH, 2.0 * HALF_WIDTH, 2 * CELLS - 6, 8, origin=(-HALF_WIDTH, 0.0))
    stiff = Material(ratio * SOFT.youngs_modulus, SOFT.poissons_ratio)
    punch = Body(face, stiff, rigid=Rigid("top", (Freedom("y", displacement=-SUNK),)), name="punch")
    mesh = with_part(graded_rectangle(BLOCK, BLOCK, size, fine, growth=1.4), "top", "near", fine)
    block = Body(mesh, SOFT, (Fixed("bottom"),), name="block")
    sides = ((0, "bottom"), (1, "near"))
    first, second = sides if order == ORDERS[0] else sides[::-1]
    return Problem((punch, block), (Contact(first, second, reach=0.01 * HALF_WIDTH),))


def verify() -> Verification:
    """Solves all ratios in both orders."""
    solutions = {(ratio, order): Pressed.of(solve(problem(ratio, order))) for ratio in RATIOS for order in ORDERS}
    return Verification(
        "stiff_punch",
        "Flat punch, ratios of stiffness up to 1e8",
        PROBLEM,
        claims(solutions),
        lambda figure: draw(figure, solutions),
        "A punch is rigid for the pressure long before ratios of stiffness become a matter of rounding",
    )


Solutions = dict[tuple[float, str], Pressed]


def claims(solutions: Solutions) -> tuple[Claim, ...]:
    """Both orders against each other, and the stiffest punches against a rigid one."""
    result, other_order, rigid = [], analytical("the block first"), analytical(f"{SOURCE.name}, of a rigid punch")
    for ratio in RATIOS:
        first, second = (solutions[ratio, order] for order in ORDERS)
        quantity = f"P, punch first, {ratio:.0e} times as stiff [N/mm]"
        result.append(other_order.relative(quantity, first.force, second.force, 1e-6))
    for ratio in RATIOS[1:]:
        quantity = f"pressure within {MIDDLE:g} a, relative error in L2, {ratio:.0e} times as stiff"
        result.append(rigid.bound(quantity, solutions[ratio, ORDERS[0]].error, 0.01))
    stiffest = solutions[RATIOS[-1], ORDERS[0]]
    quantity = f"the surface {BESIDE:g} a beside the middle stays behind by [mm], {RATIOS[-1]:.0e} times as stiff"
    return (*result, SOURCE.relative(quantity, stiffest.behind, stiffest.left_behind, 0.01))


def draw(figure: Figure, solutions: Solutions) -> None:
    """The pressure at all ratios, the punch first."""
    axes = figure.subplots()
    x = np.linspace(-0.999, 0.999, 1001) * HALF_WIDTH
    mean = np.pi * np.sqrt(1.0 - (x / HALF_WIDTH) ** 2) / 2.0
    axes.plot(x, 1.0 / mean, color=FAINT, lw=2.0, label="rigid punch, half-plane")
    for ratio, marker, colour in zip(RATIOS, "os^v", (*TEETH, WHEEL)):
        pressed = solutions[ratio, ORDERS[0]]
        values = pressed.pressure * 2.0 * HALF_WIDTH / pressed.force
        axes.plot(pressed.x, values, marker, color=colour, ms=4, mfc="none", label=f"{ratio:.0e} times as stiff")
    axes.set(xlabel="x / a", ylabel="contact pressure over its mean", ylim=(0.0, 3.0))
    axes.legend(loc="upper center")
