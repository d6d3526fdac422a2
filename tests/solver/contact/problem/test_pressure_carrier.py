"""Bodies of very different stiffness, named in either order: beyond a ratio of 10 the softer carries the pressure."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent import Body, Contact, Fixed, Freedom, Material, MeshData, Problem, Rigid, Solution, Step, solve, sweep
from evolvent.contact.problem.pressure_carrier import STIFFNESS_RATIO
from evolvent_meshes.shapes.blocks import box, cylinder_2d, graded_rectangle, rectangle

RATIOS = (1e-8, 1e-4, 1e-2, 1.0, 1e2, 2e4, 5e4, 1e8)  # from 5e4 on Newton's method stalled with the stiff body first
SOFT, POISSON = 1e3, 0.3
SHORTENED = 1e-3  # mm


def oedometric(modulus: float) -> float:
    """Stress over strain [MPa] of a body that cannot expand sideways."""
    return modulus * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))


def column(d: int) -> tuple[MeshData, MeshData, tuple[Fixed, ...], str]:
    """Two blocks, 2 mm wide and 1 mm high each, one on the other, whose meshes do not match; held to the sides."""
    if d == 2:
        plane = (Fixed("left", "x"), Fixed("right", "x"))
        return rectangle(2.0, 1.0, 4, 2), rectangle(2.0, 1.0, 5, 2, origin=(0.0, -1.0)), plane, "y"
    sides = (Fixed("left", "x"), Fixed("right", "x"), Fixed("front", "y"), Fixed("back", "y"))
    sizes = (2.0, 2.0, 1.0)
    return box(sizes, (2, 2, 1), 1), box(sizes, (3, 3, 1), 1, origin=(0.0, 0.0, -1.0)), sides, "z"


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("order", [0, 1])
@pytest.mark.parametrize("by_load", [False, True])
def test_column_of_any_stiffness_ratio_is_exact(d: int, friction: float, order: int, by_load: bool) -> None:
    """A column of two blocks that cannot get wider, its top lowered by δ, either by prescribing δ or by the force that
    takes: the stress is δ/Σ(h/M), exactly, on any mesh. Force and sinking within 1e-6, for moduli of the upper block
    1e-8 to 1e8 times that of the lower one, in 2D and 3D, with and without friction, each block named first."""
    upper, lower, sides, down = column(d)
    for ratio in RATIOS:
        moduli = (SOFT * max(ratio, 1.0), SOFT * max(1.0 / ratio, 1.0))
        force = SHORTENED / sum(1.0 / oedometric(modulus) for modulus in moduli) * 2.0 ** (d - 1)
        pressing = Freedom(down, load=-force) if by_load else Freedom(down, displacement=-SHORTENED)
        bodies = (
            Body(upper, Material(moduli[0], POISSON), sides, rigid=Rigid("top", (pressing,))),
            Body(lower, Material(moduli[1], POISSON), (*sides, Fixed("bottom"))),
        )
        named = ((0, "bottom"), (1, "top"))
        found = solve(Problem(bodies, (Contact(named[order], named[1 - order], friction, reach=0.1),)))
        assert abs(found.contacts[0].force[-1]) == pytest.approx(force, rel=1e-6), ratio
        assert found.motions[0][0] == pytest.approx(-SHORTENED, rel=1e-6), ratio


def roller(stiffer: float, order: int) -> Solution:
    """A roller `stiffer` times as stiff as the block it is pressed on and then pushed to the right along, μ = 0.2."""
    freedoms = (Freedom("y", load=-50.0), Freedom("x", displacement=0.0))
    up = Body(cylinder_2d(50.0, 0.8, 3.0, growth=1.6), Material(stiffer * 700.0, 0.3), rigid=Rigid("top", freedoms))
    low = Body(graded_rectangle(60.0, 40.0, 0.63, 3.0, growth=1.6), Material(700.0, 0.3), (Fixed("bottom"),))
    named = ((0, "arc"), (1, "top"))
    problem = Problem((up, low), (Contact(named[order], named[1 - order], 0.2, reach=0.5),))
    push = Step(freedoms=((0, Freedom("x", displacement=0.5)),))
    *_, pushed = sweep(problem, [Step(), push])
    return pushed


def test_signs_follow_the_named_order_whichever_surface_carries() -> None:
    """Whichever surface carries the pressure, force is on the second body, normals point out of the first, slip is of
    the first over the second. A roller 1e6 times as stiff as its block, named first and second: the same fields, with
    opposite signs; pushed to the right, it slides and drags the block along with μλ."""
    first, second = (roller(1e6, order).contacts[0] for order in (0, 1))
    assert first.carrier == second.carrier == (1, "top")
    assert first.force == pytest.approx([10.0, -50.0], rel=0.02)  # along normals that the block's shear has turned
    assert np.array_equal(first.normals, -second.normals)
    assert np.array_equal(first.traction, -second.traction)
    assert np.array_equal(first.slip, -second.slip)
    assert first.normals[:, 1].max() < 0.0
    assert first.slip[first.pressure > 0.0, 0].min() > 0.0
    shear = first.traction - first.pressure[:, None] * first.normals
    assert np.allclose(np.linalg.norm(shear, axis=1), 0.2 * first.pressure, rtol=1e-6)


@pytest.mark.parametrize(("ratio", "carrier"), [(0.99, (0, "arc")), (1.01, (1, "top"))])
def test_softer_surface_carries_the_pressure_beyond_the_stiffness_ratio(ratio: float, carrier: tuple[int, str]) -> None:
    """A roller on a block, `ratio` times STIFFNESS_RATIO as stiff and named first: it carries the pressure below the
    ratio, the block above. With either the roller sinks in by the same within 1 %."""
    stiffer = ratio * STIFFNESS_RATIO
    solution = roller(stiffer, 0)
    assert solution.contacts[0].carrier == carrier
    assert solution.motions[0][0] == pytest.approx(roller(stiffer, 1).motions[0][0], rel=0.01)
