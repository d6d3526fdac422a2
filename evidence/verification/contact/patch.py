"""Patch test: blocks whose meshes do not match pass a uniform pressure, and a uniform shear, to solver accuracy."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from demos.two_blocks import FRICTION, NAMES, PRESSURE, SHEAR, Patch, variants
from evidence.claims import Claim, Verification, analytical
from evolvent import solve
from evolvent.results.drawing.style import PINION, TEETH, WHEEL

BOUND = 1e-9  # of the pressure; the equilibrium's residual may be 1e-10 of the load
PROBLEM = f"""
Two blocks of 2 x 2 x 1 mm (2 x 1 mm in plane strain) whose facets match nowhere, steel on aluminium, pressed with
{PRESSURE:g} MPa; then two sheared with {SHEAR:g} MPa besides, the upper one held by nothing but friction of {FRICTION}.
A uniform stress is in every finite element space, so λ = p and τ must come back at every point of the interface, to the
solver's tolerance, for every shape and order of cells and whichever block carries the pressure.
"""
PLURAL = {s: {"tetrahedron": "tetrahedra", "hexahedron": "hexahedra"}.get(s, s + "s") for s in NAMES}
CASES = tuple((first, friction) for first in (0, 1) for friction in (0.0, FRICTION))


def verify() -> Verification:
    """Solves all variants."""
    errors = {patch: float(patch.errors(solve(patch.problem())).max()) for patch in variants(quick=False)}
    groups = list(dict.fromkeys((patch.shape, patch.order) for patch in errors))
    claims = tuple(_claim(shape, order, errors) for shape, order in groups)
    return Verification(
        "patch",
        "Patch test",
        PROBLEM,
        claims,
        lambda figure: draw(figure, groups, errors),
        "Whatever the cells and whichever block carries the pressure: off by round-off",
    )


def _claim(shape: str, order: int, errors: dict[Patch, float]) -> Claim:
    worst = max(errors[Patch(shape, order, *case)] for case in CASES)
    quantity = f"largest error of the traction / p, {PLURAL[shape]} of order {order}"
    return analytical("uniform stress").bound(quantity, worst, BOUND)


def draw(figure: Figure, groups: list[tuple[str, int]], errors: dict[Patch, float]) -> None:
    """A bar per variant, on a scale of powers of ten."""
    axes = figure.subplots()
    colours = (PINION, TEETH[0], WHEEL, TEETH[2])
    for offset, (case, colour) in enumerate(zip(CASES, colours)):
        place = np.arange(len(groups)) + 0.2 * (offset - 1.5)
        height = [max(errors[Patch(shape, order, *case)], 1e-16) for shape, order in groups]
        body, held = ("upper (coarser)", "lower (finer)")[case[0]], "sheared, sticks" if case[1] else "no friction"
        axes.bar(place, height, 0.18, color=colour, label=f"pressure on the {body} block, {held}")
    axes.axhline(BOUND, color="k", lw=1.0, ls="--")
    axes.text(-0.5, 1.6 * BOUND, "tolerance", fontsize=9)
    axes.set_xticks(range(len(groups)), [f"{NAMES[shape]}\norder {order}" for shape, order in groups])
    axes.set(yscale="log", ylim=(1e-16, 1e-6), ylabel="largest error of the traction / p")
    axes.legend(fontsize=8, ncols=2, loc="upper center")
