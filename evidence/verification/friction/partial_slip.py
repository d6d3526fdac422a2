"""Partial slip of a line contact: a cylinder is pressed on a block, then pushed sideways (Cattaneo 1938)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from demos.hertz_cylinder import Profile, Slip, stick_half_width
from evidence.claims import Claim, Verification, analytical
from evolvent.contact import hertz
from evolvent.results.drawing.style import FAINT, INK, PINION, TEETH

SHARES = (0.25, 0.5, 0.75)  # Q/μP
CELLS = (4, 8, 16)  # on the half-width of the contact
SOURCE = "Cattaneo; Johnson 1985, section 7.2"


@dataclass(frozen=True)
class Pushed:
    """One load on one mesh.

    slip:    the problem, with Q/μP and Cattaneo's solution.
    cells:   on the half-width of contact.
    profile: after the push.
    """

    slip: Slip
    cells: int
    profile: Profile

    @property
    def exact(self) -> Profile:
        """On a fine grid that ends outside the contact."""
        return self.slip.exact(np.linspace(-1.5, 1.5, 6001) * self.slip.half_width)

    @property
    def stick(self) -> float:
        """c/b."""
        return stick_half_width(self.profile, self.slip.friction) / self.slip.half_width

    @property
    def shear_error(self) -> float:
        """Relative L2 error of the traction."""
        return self.profile.error(self.exact, "shear")

    @property
    def overload(self) -> float:
        """The most that |τ| exceeds μλ by at any point, over μp0."""
        excess = np.abs(self.profile.shear) - self.slip.friction * self.profile.pressure
        return float(max(0.0, excess.max())) / (self.slip.friction * self.slip.peak)


def pushed(share: float, cells: int) -> Pushed:
    """Solved in two steps; the block carries the pressure, its flat normals put no slip into the pressing."""
    slip = Slip(share=share)
    return Pushed(slip, cells, slip.profiles(cells)[1])


def verify() -> Verification:
    """Three loads on the finest mesh, and one load on all meshes."""
    loads = [pushed(share, CELLS[-1]) for share in SHARES]
    meshes = [pushed(0.5, cells) for cells in CELLS[:-1]] + [loads[1]]
    return Verification(
        "partial_slip",
        "Partial slip of a line contact (Cattaneo)",
        "A steel cylinder (R = 50 mm, b = 0.5 mm, plane strain) is pressed on a steel block, then pushed sideways with "
        "Q < μP, μ = 0.3. The middle |x| < c = b√(1 − Q/μP) sticks, the rims slip, and the traction is "
        "q = μp0[√(1 − x²/b²) − (c/b)√(1 − x²/c²)]. Meshes do not match; cells of b/16 unless said otherwise.",
        (*_claims(loads), _falling(meshes)),
        lambda figure: _draw(figure, loads, meshes),
        "The middle sticks, the rims slip: the traction leaves the friction limit where Cattaneo says",
    )


def _claims(loads: list[Pushed]) -> list[Claim]:
    result = []
    for case in loads:
        share, node = case.slip.share, 0.5 / case.cells
        exact = hertz.stick_ratio_line(share)
        at = f"Q = {share:g} μP"
        result += [
            analytical(f"{SOURCE}; ± a node").absolute(f"stick zone c/b, {at}", case.stick, exact, node),
            analytical(SOURCE).bound(f"traction, relative L2 error, {at}", case.shear_error, 0.05),
        ]
    worst = max(case.profile.error(case.exact) for case in loads)
    limit = max(case.overload for case in loads)
    return [
        *result,
        analytical("Hertz").bound("pressure, relative L2 error, worst load", worst, 0.01),
        analytical("Coulomb's law").bound("excess of |τ| over μλ, share of μp0", limit, 1e-9),
    ]


def _falling(meshes: list[Pushed]) -> Claim:
    """Square roots end the stick zone and the contact, inside cells: the L2 error falls at least like √h."""
    share = meshes[-1].shear_error / meshes[0].shear_error
    what = f"traction error of b/{meshes[-1].cells} over that of b/{meshes[0].cells}"
    return analytical("order ½ or better").bound(what, share, 0.5)


def _draw(figure: Figure, loads: list[Pushed], meshes: list[Pushed]) -> None:
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1))
    _tractions(left, loads)
    _errors(right, meshes)


def _tractions(axes: Axes, loads: list[Pushed]) -> None:
    slip = loads[0].slip
    b, scale = slip.half_width, slip.friction * slip.peak
    x = np.linspace(-1.0, 1.0, 801) * b
    axes.plot(x / b, slip.exact(x).pressure / slip.peak, color=FAINT, ls="--", lw=1.2, label="limit μp (Hertz)")
    for case, colour in zip(loads, TEETH):
        exact, profile = case.slip.exact(x), case.profile
        stick = hertz.stick_ratio_line(case.slip.share)
        axes.plot(x / b, exact.shear / scale, color=INK, lw=1.0, zorder=3)
        label = f"Q = {case.slip.share:g} μP, sticks over ±{stick:.3f} b, found {case.stick:.3f}"
        axes.plot(profile.x / b, profile.shear / scale, "o", ms=3.2, color=colour, label=label)
    axes.plot([], [], color=INK, lw=1.0, label="Cattaneo")
    axes.set(xlim=(-1.15, 1.15), ylim=(0.0, 1.5), xlabel="x / b", ylabel="traction / μp0")
    axes.legend(loc="upper center", ncols=1)


def _errors(axes: Axes, meshes: list[Pushed]) -> None:
    h = np.array([1.0 / case.cells for case in meshes])
    error = 100.0 * np.array([case.shear_error for case in meshes])
    pressure = 100.0 * np.array([case.profile.error(case.exact) for case in meshes])
    axes.loglog(h, error, "o-", color=PINION, label="traction, Q = μP/2")
    axes.loglog(h, pressure, "s-", color=FAINT, label="pressure")
    axes.loglog(h, error[-1] * np.sqrt(h / h[-1]), ":", color=INK, lw=1.0, label="slope ½")
    axes.set_xticks(h, [f"b/{case.cells}" for case in meshes])
    axes.set_xticks([], minor=True)
    axes.set_yticks((0.5, 1, 2, 5), ("0.5", "1", "2", "5"))
    axes.set_yticks((), minor=True)
    axes.set(ylim=(0.3, 12), xlabel="element size", ylabel="L2 error against the exact field [%]")
    axes.legend(loc="upper left")
