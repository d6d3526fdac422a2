"""Partial slip of a round contact: a ball is pressed on a block, then pushed sideways (Mindlin 1949)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evidence.claims import Claim, Verification, analytical
from evidence.fits import relative_l2
from evolvent import Contact, ContactResult, Problem, Solution, Step, sweep
from evolvent.contact import hertz
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import Material
from evolvent.results.drawing.style import FAINT, INK, PINION, TEETH, note
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.rings import ring_block, ring_sphere
from evolvent_meshes.shapes.variants import doubled, with_part

RADIUS, CONTACT, SIDE = 8.0, 0.08, 4.0  # of the ball, a, of the bodies [mm]
FRICTION, CELLS = 0.3, 4  # μ, cells on a
SHARES = (0.1, 0.25, 0.5, 0.75, 0.9)  # Q/μP
SHOWN = (0.5, 0.75, 0.9)  # whose slip rim is wider than half a cell
MATERIAL = Material(210e3, 0.0)
MODULUS = 0.5 * MATERIAL.plane_modulus  # E* of two alike bodies
LOAD = 4.0 * MODULUS * CONTACT**3 / (3.0 * RADIUS)  # P [N]
PEAK = hertz.point_contact(LOAD, RADIUS, MODULUS).peak_pressure
COMPLIANCE = 2.0 * (2.0 - MATERIAL.poissons_ratio) / (0.5 * MATERIAL.youngs_modulus / (1.0 + MATERIAL.poissons_ratio))
SOURCE = "Mindlin; Johnson 1985, section 7.2"


@dataclass(frozen=True)
class Pushed:
    """The contact under P and Q; the model is a half, y >= 0.

    share: Q/μP.
    """

    share: float
    solution: Solution

    @property
    def contact(self) -> ContactResult:
        return self.solution.contacts[0]

    @property
    def radius(self) -> Floats:
        """(q,) of the points [mm]."""
        return np.hypot(*self.contact.points[:, :2].T)

    @property
    def shear(self) -> Floats:
        """(q, 3) tangential traction on the ball [MPa], the push in +x taken as positive."""
        c = self.contact
        return np.asarray((c.pressure[:, None] * c.normals - c.traction) * np.sign(-c.force[0]))

    @property
    def stick_ratio(self) -> float:
        """c/a from the area that sticks."""
        c = self.contact
        sticks = np.linalg.norm(self.shear, axis=1) < FRICTION * c.pressure * (1.0 - 1e-9)
        return float(np.sqrt(2.0 * c.weights[sticks].sum() / np.pi) / CONTACT)

    @property
    def shift(self) -> float:
        """δ_x [mm] of the ball over the block."""
        return float(self.solution.motions[0][1])

    @property
    def shear_error(self) -> float:
        """Relative L2 distance of the traction vector from Mindlin's."""
        exact = np.zeros_like(self.shear)
        exact[:, 0] = mindlin_traction(self.radius, self.share)
        return relative_l2(self.contact.weights, self.shear, exact)

    @property
    def pressure_error(self) -> float:
        """Relative L2 distance of the pressure from Hertz'."""
        exact = hertz.line_pressure(self.radius, CONTACT, PEAK)
        return relative_l2(self.contact.weights, self.contact.pressure, exact)


def mindlin_traction(radius: Floats, share: float) -> Floats:
    """q = μp0[√(1 − r²/a²) − (c/a)√(1 − r²/c²)] [MPa] in the direction of the push."""
    return hertz.line_pressure(radius, CONTACT, FRICTION * PEAK) - _inner(radius, share)


def _inner(radius: Floats, share: float) -> Floats:
    ratio = hertz.stick_ratio_sphere(share)
    return ratio * hertz.line_pressure(radius, ratio * CONTACT, FRICTION * PEAK)


def problem() -> Problem:
    """Half a ball on half a block, cells in rings; the block carries the pressure."""
    size, fine = CONTACT / CELLS, 1.25 * CONTACT
    order, growth, fine_depth = 2, 1.7, 0.25 * CONTACT
    ball = ring_sphere(RADIUS, SIDE, SIDE, CONTACT, size, fine, order, growth, fine_depth)
    block = ring_block(SIDE, SIDE, CONTACT, size / 0.8, fine, order, growth, fine_depth)
    symmetry, freedoms = Fixed("symmetry_y", "y"), (Freedom("z", load=-0.5 * LOAD), Freedom("x", displacement=0.0))
    bodies = (
        Body(_half(ball, "arc"), MATERIAL, (symmetry,), rigid=Rigid("top", freedoms), name="ball"),
        Body(_half(block, "top"), MATERIAL, (symmetry, Fixed("bottom")), name="block"),
    )
    return Problem(bodies, (Contact((1, "contact"), (0, "contact"), FRICTION, reach=0.1 * CONTACT),))


def _half(quarter: MeshData, group: str) -> MeshData:
    """Doubled along the push, with the facets that may touch as the group "contact"."""
    return with_part(doubled(quarter, "symmetry_x"), group, "contact", 1.3 * CONTACT)


def push() -> list[Pushed]:
    """P first, then Q in growing steps."""
    steps = [Step(freedoms=((0, Freedom("x", load=0.5 * share * FRICTION * LOAD)),)) for share in SHARES]
    _, *pushed = sweep(problem(), [Step(), *steps])
    return [Pushed(share, solution) for share, solution in zip(SHARES, pushed, strict=True)]


def exact_shift(share: float) -> float:
    """Mindlin's δ_x [mm]."""
    return hertz.mindlin_displacement(LOAD, CONTACT, FRICTION, share, COMPLIANCE)


def verify() -> Verification:
    """One history of loads on one mesh."""
    cases = push()
    return Verification(
        "mindlin",
        "Partial slip of a round contact (Mindlin)",
        "A ball (R = 8 mm, a = 0.08 mm) is pressed on a block of the same material, then pushed with Q < μP, μ = 0.3, "
        "in growing steps. The disc r < c = a(1 − Q/μP)^⅓ sticks; the traction points along the push, the difference "
        "of two hemispheres; the ball shifts by δ_x = (3μP/16a) Σ(2 − ν)/G [1 − (1 − Q/μP)^⅔]. With ν = 0 Mindlin's "
        "solution is exact: slip then has the direction of the push everywhere. A half model, hexahedra of a/4 in "
        "rings; the edge of the stick zone lies inside cells. δ_x of the model has the shear of its 4 mm bodies too, "
        "about 2 %.",
        tuple(_claims(cases)),
        lambda figure: _draw(figure, cases),
        "The disc that sticks shrinks as the push grows, and the ball gives way more than in proportion",
    )


def _claims(cases: list[Pushed]) -> list[Claim]:
    result, mindlin, eighth = [], analytical(SOURCE), analytical(f"{SOURCE}; ± an eighth of a cell")
    for case in (case for case in cases if case.share in SHOWN):
        at, exact = f"Q = {case.share:g} μP", hertz.stick_ratio_sphere(case.share)
        result += [
            eighth.absolute(f"stick zone c/a, {at}", case.stick_ratio, exact, 0.125 / CELLS),
            mindlin.bound(f"traction, relative L2 error, {at}", case.shear_error, 0.15),
        ]
    for case in cases:
        quantity = f"shift δ_x [nm], Q = {case.share:g} μP"
        result.append(mindlin.relative(quantity, 1e6 * case.shift, 1e6 * exact_shift(case.share), 0.03))
    last = cases[-1]
    computed, wanted = abs(float(last.contact.force[0])), 0.5 * last.share * FRICTION * LOAD
    return [
        *result,
        analytical("Hertz").bound("pressure, relative L2 error", last.pressure_error, 0.03),
        analytical("equilibrium").relative("Q [N], of the half model, last step", computed, wanted, 1e-8),
    ]


def _draw(figure: Figure, cases: list[Pushed]) -> None:
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1))
    _tractions(left, [case for case in cases if case.share in SHOWN])
    _shifts(right, cases)


def _tractions(axes: Axes, cases: list[Pushed]) -> None:
    r, scale = np.linspace(0.0, 1.0, 501) * CONTACT, FRICTION * PEAK
    axes.plot(r / CONTACT, hertz.line_pressure(r, CONTACT, 1.0), "--", color=FAINT, lw=1.2, label="limit μp (Hertz)")
    for case, colour in zip(cases, TEETH):
        label = f"Q = {case.share:g} μP: c/a {hertz.stick_ratio_sphere(case.share):.3f}, found {case.stick_ratio:.3f}"
        axes.plot(case.radius / CONTACT, case.shear[:, 0] / scale, ".", ms=2.5, color=colour, label=label)
        axes.plot(r / CONTACT, mindlin_traction(r, case.share) / scale, color=INK, lw=1.1, zorder=3)
    axes.plot([], [], color=INK, lw=1.1, label="Mindlin")
    axes.set(xlim=(0.0, 1.15), ylim=(0.0, 1.5), xlabel="r / a (all points of the half disc)", ylabel="traction / μp0")
    axes.legend(loc="upper right", markerscale=3)


def _shifts(axes: Axes, cases: list[Pushed]) -> None:
    share = np.linspace(0.0, 1.0, 101)
    axes.plot(share, [1e6 * exact_shift(x) for x in share], color=INK, lw=1.3, label="Mindlin")
    stuck = exact_shift(1e-6) / 1e-6
    axes.plot(share, 1e6 * stuck * share, ":", color=FAINT, label="without slip")
    axes.plot([case.share for case in cases], [1e6 * case.shift for case in cases], "o", color=PINION, label="found")
    worst = max(abs(case.shift / exact_shift(case.share) - 1.0) for case in cases)
    note(axes, f"at most {100 * worst:.1f} % off", 0.05, 0.7)
    axes.set(xlim=(0.0, 1.0), ylim=(0.0, None), xlabel="Q / μP", ylabel="shift δ_x [nm]")
    axes.legend(loc="upper left")
