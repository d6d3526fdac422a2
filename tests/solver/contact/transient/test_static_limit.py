"""Statics within a transient: exact for any number of modes, and its limit for long steps."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent import (
    Body,
    Contact,
    Fixed,
    Freedom,
    InitialState,
    Problem,
    Rigid,
    Solution,
    Step,
    Traction,
    Transient,
    TransientSettings,
    sweep,
)
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import rectangle

LONG = 1e3  # s


def pressed(friction: float, coupled: bool) -> Problem:
    """A block on a wider one, pressed by a rigid lid or by a traction; it can move up and down, with friction on the
    lower one also to the side."""
    lid = Rigid("top", (Freedom("y", load=-900.0), Freedom("x", load=60.0)))
    load, held = (Traction("top", (8.0, -90.0)),), () if friction else (Fixed("left", "x"),)
    upper = rectangle(10.0, 6.0, 5, 3, origin=(1.0, 5.0))
    block = Body(upper, rigid=lid, name="block") if coupled else Body(upper, supports=held, loads=load, name="block")
    base = Body(rectangle(12.0, 5.0, 4, 2), supports=(Fixed("bottom"),), name="base")
    return Problem((block, base), (Contact((0, "bottom"), (1, "top"), friction=friction),))


def loads() -> list[Step]:
    return [Step(0.4), Step(1.0), Step(0.7)]


def figures(solution: Solution) -> Floats:
    """Pressures, forces and displacements of both bodies."""
    displacements = [1e3 * solution.displacement(body).ravel() for body in range(2)]
    return np.concatenate([solution.contacts[0].traction.ravel(), *displacements])


@pytest.mark.parametrize("modes", [0, 3, 1000])
@pytest.mark.parametrize(("friction", "coupled"), [(0.0, False), (0.3, True)])
def test_long_steps_are_a_static_sweep(friction: float, coupled: bool, modes: int) -> None:
    """Steps of 1000 s, from the static state under the first load: tractions and displacements of the static sweep to
    1e-10, step for step, with no modes, three and all of them."""
    problem = pressed(friction, coupled)
    static = list(sweep(problem, [loads()[0], *loads()]))[1:]
    transient = Transient(problem, TransientSettings(LONG, modes), InitialState(loads()[0]))
    for moment, still in zip(transient.run(loads()), static):
        wanted = figures(still)
        assert figures(moment.solution) == pytest.approx(wanted, abs=1e-10 * np.abs(wanted).max())


@pytest.mark.parametrize("modes", [0, 3, 1000])
def test_a_body_in_equilibrium_stays_there(modes: int) -> None:
    """Short steps, from the static state under the same load: nothing moves, for any number of modes."""
    problem = pressed(0.0, coupled=False)
    (static,) = sweep(problem, [Step()])
    wanted = figures(static)
    for moment in Transient(problem, TransientSettings(1e-6, modes), InitialState(Step())).run(5):
        assert figures(moment.solution) == pytest.approx(wanted, abs=1e-10 * np.abs(wanted).max())
        assert moment.energy.kinetic < 1e-18 * moment.energy.elastic
