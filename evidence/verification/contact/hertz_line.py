"""Hertz' line contact: a long steel roller on a steel block so large that both are half-spaces for the contact."""

from __future__ import annotations

import numpy as np

from demos.hertz_cylinder import Profile
from evidence.claims import Claim, Verification, analytical
from evidence.fits import half_ellipse
from evidence.verification.references.hertz_figure import HertzFigure
from evidence.verification.references.subsurface import (
    AxisStress,
    SubsurfaceHertz,
    axis_compression,
    axis_stress,
    subsurface_claims,
)
from evolvent import Contact, Problem, Solution, solve
from evolvent.contact import hertz
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import STEEL
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import cylinder_2d, graded_rectangle
from evolvent_meshes.shapes.variants import with_part

HALF_WIDTH, RADIUS, BLOCK = 0.5, 500.0, 4000.0  # mm
CELLS = 8  # per half-width, on the roller
DEPTH = 20 * HALF_WIDTH
MODULUS = STEEL.plane_modulus / 2
LOAD = np.pi * MODULUS * HALF_WIDTH**2 / (4 * RADIUS)  # N/mm
PEAK = hertz.line_peak_pressure(LOAD, RADIUS, MODULUS)
PROBLEM = f"""
A steel roller of {RADIUS:g} mm radius on a steel block, plane strain, pressed so that Hertz' half-width b is
{HALF_WIDTH} mm: b/R = {HALF_WIDTH / RADIUS:g}. The block is {BLOCK / HALF_WIDTH:.0f} b wide and deep, because what a
finite body adds falls only like b over its size. Second-order quadrilaterals of b/{CELLS} on the roller, b/11 on the
block, which do not match. p0 and b are those of the ellipse that fits the pressure over the middle 70 %. Two cylinders
have no approach of their own: it grows with the depth of the point that is held, so what is compared is how much nearer
to the surface a point {DEPTH / HALF_WIDTH:.0f} b below it comes.
"""


def problem() -> Problem:
    """Roller and block; the block carries the pressure, on its facets within 3 b."""
    size, fine = HALF_WIDTH / CELLS, 1.5 * HALF_WIDTH
    roller = Body(
        cylinder_2d(RADIUS, size, fine), STEEL, rigid=Rigid("top", (Freedom("y", load=-LOAD),)), name="roller"
    )
    block = Body(
        with_part(graded_rectangle(BLOCK, BLOCK, size / 1.37, fine, fine_depth=fine), "top", "near", 3 * HALF_WIDTH),
        STEEL,
        (Fixed("bottom"),),
        name="block",
    )
    return Problem((roller, block), (Contact((1, "near"), (0, "arc"), reach=0.25 * HALF_WIDTH),))


def verify() -> Verification:
    """Solves it once."""
    solution = solve(problem())
    profile = Profile.of(solution.contacts[0], HALF_WIDTH)
    meshes = [body.assembled.body.mesh for body in solution.condensed]
    bodies = tuple(axis_stress(mesh, STEEL, solution.displacement(i)) for i, mesh in enumerate(meshes))
    depth = np.linspace(0.0, 2.5, 400)
    exact = AxisStress(depth * HALF_WIDTH, PEAK * _exact_stress(depth))
    figure = HertzFigure(
        profile.x / HALF_WIDTH, profile.pressure / PEAK, bodies, exact, HALF_WIDTH, PEAK, "distance from the middle / b"
    )
    return Verification(
        "hertz_line",
        "Hertz, line contact",
        PROBLEM,
        (*_surface_claims(profile), *_approach_claims(solution), *_below_claims(bodies)),
        figure.draw,
        "Half an ellipse of pressure; the stress is largest below the surface, in both bodies alike",
    )


def _exact_stress(depth: Floats) -> Floats:
    """σ_xx, σ_yy (vertical), σ_zz (n, 3) over p0 at depth/b."""
    stress = hertz.line_axis_stress(depth, STEEL.poissons_ratio)
    return np.stack([stress.width, stress.depth, stress.line], axis=1)


def _surface_claims(profile: Profile) -> tuple[Claim, ...]:
    fit = half_ellipse(profile.x, profile.pressure, profile.half_width)
    x = np.linspace(-1.5, 1.5, 6001) * HALF_WIDTH
    exact = Profile(x, hertz.line_pressure(x, HALF_WIDTH, PEAK), 0.0 * x, HALF_WIDTH)
    source = analytical("Johnson 1985, Eqs 4.43-4.45")
    return (
        source.relative("peak pressure p0 [MPa]", fit.peak, PEAK, 0.005),
        source.relative("half-width b [mm]", fit.half_width, HALF_WIDTH, 0.005),
        source.bound("pressure, relative error in L2", profile.error(exact), 0.025),
    )


def _approach_claims(solution: Solution) -> tuple[Claim, ...]:
    claims = []
    for index, name in enumerate(("roller", "block")):
        mesh = solution.condensed[index].assembled.body.mesh
        depth, compression = axis_compression(mesh, solution.displacement(index), DEPTH)
        wanted = hertz.line_approach(LOAD, HALF_WIDTH, depth, STEEL.youngs_modulus, STEEL.poissons_ratio)
        quantity = f"approach of the point {depth / HALF_WIDTH:.1f} b below the surface of the {name} [mm]"
        claims.append(analytical("Johnson 1985, Eq. 5.58").relative(quantity, compression, wanted, 0.005))
    return tuple(claims)


def _below_claims(bodies: tuple[AxisStress, ...]) -> tuple[Claim, ...]:
    largest = hertz.line_largest_shear(), hertz.line_largest_mises(STEEL.poissons_ratio)
    known = SubsurfaceHertz(HALF_WIDTH, PEAK, *largest, analytical("Johnson 1985, Eq. 4.46"))
    return tuple(c for name, body in zip(("roller", "block"), bodies) for c in subsurface_claims(body, known, name))
