"""Hertz' point contact in the matrix: a ball on a block, one setting at a time away from nominal, cells and orders.

Nominal: steel, a/R = 0.06, friction 0.3, γ = 2 C, θ = 1, cells of a/4 in rings that end at Hertz' radius, the block's
1.2 times finer; a quarter model. The error is that of p0 against Hertz, who has no friction and two half-spaces.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evidence.benchmarks.comparison.round_contacts import ball_and_block
from evidence.fits import half_ellipse
from evidence.robustness.settings.sheets import Cell, Sheet, sheet_of
from evolvent import Contact, Nitsche, Placement, Problem, Step, solve
from evolvent.contact import hertz
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import Material

RADIUS, LOAD, E = 8.0, 2000.0, 210e3  # mm, N, MPa
KINDS = tuple((shape, order) for shape in ("hexahedron", "tetrahedron") for order in (2, 1))


@dataclass(frozen=True)
class Ball:
    """The nominal problem and everything of it that varies."""

    shape: str = "hexahedron"
    order: int = 2
    friction: float = 0.3
    load: float = 1.0
    """Over the nominal one."""
    ratio: float = 1 / 1.2
    """Element size of the block over that of the ball."""
    nu: float = 0.3
    safety: float = 2.0
    """γ over its limit."""
    theta: float = 1.0
    gap: float = 0.0
    """Between ball and block at the start [a²/2R]; negative: overlap."""

    @property
    def hertz(self) -> hertz.PointContact:
        """The answer."""
        return hertz.point_contact(self.load * LOAD, RADIUS, hertz.contact_modulus(E, self.nu, E, self.nu))

    def cell(self) -> Cell:
        """Iterations, and the error of the fitted p0."""
        raised = np.array([0.0, 0.0, self.gap * self.hertz.radius**2 / (2.0 * RADIUS)])
        solution = solve(self.problem(), Step(placements=(Placement(np.eye(3), raised), Placement.at_rest(3))))
        contact = solution.contacts[0]
        radius = np.hypot(*contact.points[:, :2].T)
        peak = half_ellipse(radius, contact.pressure, self.hertz.radius).peak
        return Cell(solution.iterations, abs(peak / self.hertz.peak_pressure - 1.0))

    def problem(self) -> Problem:
        """A quarter of ball and block; the ball's flat top moves as a rigid body under a quarter of the load."""
        material, symmetry = Material(E, self.nu), (Fixed("symmetry_x", "x"), Fixed("symmetry_y", "y"))
        down = Rigid("top", (Freedom("z", load=-self.load * LOAD / 4.0),))
        a = self.hertz.radius
        ball, block = ball_and_block(RADIUS, a, a / 4.0, self.order, self.shape, ratio=self.ratio)
        bodies = (
            Body(ball, material, symmetry, rigid=down, name="ball"),
            Body(block, material, (*symmetry, Fixed("bottom")), name="block"),
        )
        reach = max(0.1 * a, abs(self.gap) * a**2 / RADIUS)
        contact = Contact((1, "contact"), (0, "contact"), self.friction, reach)
        return Problem(bodies, (contact,), Nitsche(self.safety, self.theta))


SETTINGS: dict[str, Ball] = {
    "nominal": Ball(),
    "μ = 0": Ball(friction=0.0),
    "μ = 1": Ball(friction=1.0),
    "load 1e-3": Ball(load=1e-3),
    "load 0.1": Ball(load=0.1),
    "block's cells 1:2": Ball(ratio=0.5),
    "block's cells 2:1": Ball(ratio=2.0),
    "ν = 0.49": Ball(nu=0.49),
    "γ = 1.25 C": Ball(safety=1.25),
    "γ = 20 C": Ball(safety=20.0),
    "θ = 0": Ball(theta=0.0),
    "θ = −1": Ball(theta=-1.0),
    "gap 3": Ball(gap=3.0),
    "overlap 3": Ball(gap=-3.0),
}


def ball() -> Sheet:
    """Settings × cells and orders."""
    settings = list(SETTINGS.items())
    return sheet_of(
        ("ball", "A ball on a block (3D), one setting at a time", "error of p0 against Hertz"),
        ("setting (gaps in a²/2R)", [name for name, _ in settings]),
        ("cells, order", [f"{shape}, {order}" for shape, order in KINDS]),
        lambda i, j: replace(settings[i][1], shape=KINDS[j][0], order=KINDS[j][1]).cell(),
    )
