"""A flat punch with rounded edges, as NAFEMS' second contact benchmark has it, between half-planes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure

from demos.hertz_cylinder import Profile
from evidence.claims import Claim, Verification, analytical
from evolvent import Contact, Placement, Problem, Step, solve
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import STEEL, Material, contact_modulus
from evolvent.results.drawing.style import FAINT, WHEEL, dot_size
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import graded_rectangle
from evolvent_meshes.shapes.variants import with_part

FLAT, ROUNDING, HALF_WIDTH = 1.0, 50.0, 1.25  # mm
ALUMINIUM = Material(70e3, 0.3)
CELLS, BLOCK = 24, 400.0  # per half-width; mm
SOURCE = analytical("Ciavarella, Hills & Monno, Proc. IMechE C 212 (1998) 319-328")


@dataclass(frozen=True)
class RoundedPunch:
    """The contact of half-planes whose gap is (|x| − a)²/2R beyond the flat |x| <= a, without friction.

    flat: a [mm].
    rounding: R [mm].
    half_width: b [mm] of the contact.
    modulus: E* [MPa].
    """

    flat: float
    rounding: float
    half_width: float
    modulus: float

    @property
    def angle(self) -> float:
        """φ0 = arcsin a/b."""
        return float(np.arcsin(self.flat / self.half_width))

    @property
    def load(self) -> float:
        """P [N/mm]: PR/a²E* = ½[(π − 2φ0)/(2 sin²φ0) − cot φ0]; Hertz' for a = 0."""
        φ = self.angle
        share = 0.5 * ((np.pi - 2.0 * φ) / (2.0 * np.sin(φ) ** 2) - 1.0 / np.tan(φ))
        return float(share * self.modulus * self.flat**2 / self.rounding)

    def pressure(self, x: Floats) -> Floats:
        """p(b sin φ) [MPa], zero outside; x (n,) [mm]."""
        inside = np.abs(x) < self.half_width
        φ, φ0 = np.arcsin(np.where(inside, x, 0.0) / self.half_width), self.angle
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.log(np.abs(np.sin(φ + φ0) / np.sin(φ - φ0)))
            tangents = np.log(np.abs(np.tan(0.5 * (φ + φ0)) * np.tan(0.5 * (φ - φ0))))
            bracket = (np.pi - 2.0 * φ0) * np.cos(φ) + np.sin(φ) * ratio + np.sin(φ0) * tangents
        scale = 2.0 / (np.pi * (np.pi - 2.0 * φ0 - np.sin(2.0 * φ0))) * self.load / self.half_width
        return np.where(inside, scale * bracket, 0.0)


EXACT = RoundedPunch(FLAT, ROUNDING, HALF_WIDTH, contact_modulus(STEEL, ALUMINIUM))
PROBLEM = f"""
A steel punch, flat over 2a = {2 * FLAT:g} mm with edges rounded by R = {ROUNDING:g} mm, on an aluminium block, plane
strain, no friction: the punch of NAFEMS' second contact benchmark (R0094) in 2D, with both bodies so large
({BLOCK / HALF_WIDTH:.0f} b) that they are half-planes, for which the pressure has a closed form. It rises from the
middle, with infinite slope at the ends of the flat, to beyond them, and falls to zero at b. The load is the one for
b = {HALF_WIDTH:g} mm, {EXACT.load:.0f} N/mm. Second-order quadrilaterals of b/{CELLS} on the punch, 1.37 times finer on
the block, which do not match.
"""


def problem() -> tuple[Problem, Step]:
    """The punch is a block turned over; it carries the pressure."""
    size, fine = HALF_WIDTH / CELLS, 1.5 * HALF_WIDTH
    flat, block_mesh = (
        with_part(graded_rectangle(BLOCK, BLOCK, cell, fine, fine_depth=fine), "top", "near", fine)
        for cell in (size, size / 1.37)
    )
    punch = Body(_rounded(flat), rigid=Rigid("bottom", (Freedom("y", load=EXACT.load),)), name="punch")
    block = Body(block_mesh, ALUMINIUM, (Fixed("bottom"),))
    contact = Contact((0, "near"), (1, "near"), reach=0.5 * HALF_WIDTH**2 / ROUNDING)
    return Problem((punch, block), (contact,)), Step(
        placements=(Placement(-np.eye(2), np.zeros(2)), Placement.at_rest(2))
    )


def _rounded(mesh: MeshData) -> MeshData:
    """The top lowered by (|x| − a)²/2R within 2 b and by that of 2 b beyond, less with depth."""
    x, y = mesh.points[:, 0], mesh.points[:, 1]
    beyond = np.clip(np.abs(x) - FLAT, 0.0, 2.0 * HALF_WIDTH)
    points = mesh.points.copy()
    points[:, 1] -= beyond**2 / (2.0 * ROUNDING) * (1.0 + y / BLOCK)
    return replace(mesh, points=points)


def verify() -> Verification:
    """Solves it once."""
    contact = solve(*problem()).contacts[0]
    profile = Profile.of(contact, HALF_WIDTH)
    return Verification(
        "rounded_punch",
        "Flat punch with rounded edges",
        PROBLEM,
        claims(profile, float(contact.weights[contact.pressure > 0.0].sum()) / 2.0),
        lambda figure: draw(figure, profile),
        "The pressure is lowest in the middle and highest just beyond the ends of the flat",
    )


def claims(profile: Profile, half_width: float) -> tuple[Claim, ...]:
    """half_width: of the points that press [mm]."""
    x = np.linspace(-1.5, 1.5, 6001) * HALF_WIDTH
    exact = Profile(x, EXACT.pressure(x), 0.0 * x, HALF_WIDTH)
    middle, lowest = float(np.interp(0.0, profile.x, profile.pressure)), float(EXACT.pressure(np.zeros(1))[0])
    highest = float(np.nanmax(exact.pressure))
    half_cell = analytical(f"{SOURCE.name}; ± half a cell")
    return (
        half_cell.relative("half-width b [mm]", half_width, HALF_WIDTH, 0.5 / CELLS),
        SOURCE.relative("pressure in the middle [MPa]", middle, lowest, 0.005),
        SOURCE.relative("largest pressure [MPa]", float(profile.pressure.max()), highest, 0.01),
        SOURCE.bound("pressure, relative error in L2", profile.error(exact), 0.02),
    )


def draw(figure: Figure, profile: Profile) -> None:
    """The pressure over the width."""
    axes = figure.subplots()
    x = np.linspace(-1.3, 1.3, 2001) * HALF_WIDTH
    axes.fill_between(x, EXACT.pressure(x), color="#e3e6ea")
    axes.plot(x, EXACT.pressure(x), color=FAINT, lw=1.0, label="closed form")
    shown = np.abs(profile.x) < 1.3 * HALF_WIDTH
    axes.plot(profile.x[shown], profile.pressure[shown], ".", color=WHEEL, ms=dot_size(shown.sum()), label="found")
    for end in (-FLAT, FLAT):
        axes.axvline(end, color=FAINT, lw=0.8, ls=":")
    axes.set(xlabel="x [mm]", ylabel="contact pressure [MPa]", ylim=(0.0, None))
    axes.legend(loc="lower center")
