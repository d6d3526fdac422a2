"""Two half-spheres, pressed by a prescribed motion and by where they are placed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from evidence.claims import Claim, Reference, Rung
from meshes.rings import ring_sphere
from solver.body import Body, Fixed, Freedom, Rigid
from solver.material import STEEL, joint_modulus
from solver.plots_style import FAINT, PINION, WHEEL
from solver.problem import Contact, ContactResult, Placement, Problem, Step, solve

RADIUS, SIDE = 10.0, 6.0  # mm
SHARES = (0.05, 0.1, 0.2)  # a/R
CELLS = 4
WAYS = ("prescribed motion", "placement in overlap")
TURNED = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])  # x and y change places, z turns over
PROBLEM = f"""
Two steel half-spheres of {RADIUS:g} mm radius, quarters of them, without friction, brought nearer by 2a²/R, once by a
prescribed motion from where they touch, once by placing them in overlap. Both state one problem. Second-order
hexahedra of a/{CELLS} in rings, alike on both, cut off {SIDE:g} mm from the contact. Points are paired as the surfaces
meet, not as they overlap: paired in overlap, the two ways were 6 % apart in the peak at a/R = 0.14. Hertz' p0 and a of
the force that was found say what the size of the contact adds: at a fifth of the radius it is a third of the bodies
and no small part of a half-space any more.
"""


@dataclass(frozen=True)
class Found:
    """The force on the whole contact [N], p0 [MPa] and a [mm] of the ellipse through the inner 70 %."""

    force: float
    peak: float
    radius: float

    @staticmethod
    def of(contact: ContactResult) -> Found:
        r = np.linalg.norm(contact.points[:, :2], axis=1)
        inner = r < 0.7 * r[contact.pressure > 0.0].max()
        slope, top = np.polyfit(r[inner] ** 2, contact.pressure[inner] ** 2, 1)
        force = 4.0 * float(np.linalg.norm(contact.force * (0.0, 0.0, 1.0)))
        return Found(force, float(np.sqrt(top)), float(np.sqrt(-top / slope)))

    @property
    def hertz(self) -> tuple[float, float]:
        """p0 and a of this force."""
        modulus, radius = joint_modulus(STEEL, STEEL), RADIUS / 2.0
        a = (3.0 * self.force * radius / (4.0 * modulus)) ** (1.0 / 3.0)
        return 1.5 * self.force / (np.pi * a**2), a


def pressed(share: float, way: str) -> Found:
    """share: a/R of the approach."""
    a = share * RADIUS
    approach, placed = 2.0 * a**2 / RADIUS, way == WAYS[1]
    mesh = ring_sphere(RADIUS, SIDE, SIDE, a, a / CELLS, 1.25 * a, growth=1.7)
    symmetry = (Fixed("symmetry_x", "x"), Fixed("symmetry_y", "y"))
    down = Freedom("z", displacement=0.0 if placed else -approach)
    upper = Body(mesh, supports=symmetry, rigid=Rigid("top", (down,)), name="upper")
    lower = Body(mesh, supports=(*symmetry, Fixed("top")), name="lower")
    above = Placement(np.eye(3), np.array([0.0, 0.0, -approach if placed else 0.0]))
    problem = Problem((upper, lower), (Contact((0, "arc"), (1, "arc"), reach=2.0 * approach),))
    return Found.of(solve(problem, Step(placements=(above, Placement(TURNED, np.zeros(3))))).contacts[0])


def measure() -> Rung:
    """Solves three sizes in both ways."""
    found = {share: tuple(pressed(share, way) for way in WAYS) for share in SHARES}
    return Rung(
        "half_spheres",
        "Two half-spheres, pressed in two ways",
        PROBLEM,
        tuple(claim for share in SHARES for claim in _claims(share, *found[share])),
        lambda figure: draw(figure, found),
        "Both ways of loading give one contact; it leaves Hertz' as it becomes a part of the sphere",
    )


def _claims(share: float, moved: Found, placed: Found) -> list[Claim]:
    both = (("force [N]", moved.force, placed.force), ("p0 [MPa]", moved.peak, placed.peak),
            ("a [mm]", moved.radius, placed.radius))  # fmt: skip
    result = [
        Claim.relative(f"{name} by placement, a/R = {share:g}", theirs, own, 0.005, Reference.ANALYTICAL,
                       "the same by a prescribed motion")
        for name, own, theirs in both
    ]  # fmt: skip
    if share == SHARES[0]:
        for name, value, exact in zip(("p0 [MPa]", "a [mm]"), (moved.peak, moved.radius), moved.hertz):
            quantity, source = f"{name}, a/R = {share:g}", "Hertz of the force found"
            result.append(Claim.relative(quantity, value, exact, 0.01, Reference.ANALYTICAL, source))
    return result


def draw(figure: Figure, found: dict[float, tuple[Found, ...]]) -> None:
    """p0 and a over Hertz' against a/R."""
    for axes, name, index in zip(figure.subplots(1, 2), ("$p_0$", "a"), (0, 1)):
        axes.axhline(1.0, color=FAINT, lw=1.0)
        for way, marker, colour, number in zip(WAYS, ("s", "o"), (WHEEL, PINION), (0, 1)):
            values = [(f[number].peak, f[number].radius)[index] / f[number].hertz[index] for f in found.values()]
            axes.plot(list(found), values, marker, color=colour, ms=9 - 3 * number, mfc="none", mew=1.5, label=way)
        axes.set(xlabel="a/R", ylabel=f"{name} over Hertz' of the force", ylim=(0.85, 1.15), xlim=(0.0, 0.25))
        axes.legend(loc="lower left")
