"""Bodies named by themselves, in contacts, steps and initial states, instead of by their numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from evolvent import (
    Body,
    Contact,
    Fixed,
    Freedom,
    InitialState,
    InputError,
    Problem,
    Rigid,
    Step,
    Transient,
    TransientSettings,
    reactions,
    solve,
)
from evolvent_meshes.shapes.blocks import rectangle

LID = Rigid("top", (Freedom("y", load=-100.0), Freedom("x", displacement=0.0)))
PUNCH = Body(rectangle(1.0, 1.0, 3, 3, origin=(0.5, 1.0)), rigid=LID, name="punch")
BASE = Body(rectangle(2.0, 1.0, 4, 2), supports=(Fixed("bottom"),), name="base")
SIDES = BASE["top"], PUNCH["bottom"]
BY_NUMBER = Problem((BASE, PUNCH), (Contact((0, "top"), (1, "bottom"), friction=0.3),))
H = TransientSettings(1e-6, modes=2)


def problem(first: Any = SIDES[0], second: Any = SIDES[1]) -> Problem:
    return Problem((BASE, PUNCH), (Contact(first, second, friction=0.3),))


def test_sides_by_body_are_those_by_number() -> None:
    """A problem keeps numbers, whichever way it was stated, also with the bodies in another order."""
    assert problem().contacts == problem(SIDES[0], (1, "bottom")).contacts == BY_NUMBER.contacts
    assert Problem((PUNCH, BASE), (Contact(*SIDES),)).contacts[0].first == (1, "top")


def test_contacts_move_on_to_changed_bodies() -> None:
    """`replace` of a problem's bodies keeps its contacts, which have numbers."""
    other = replace(BASE, name="other")
    assert replace(problem(), bodies=(other, PUNCH)).contacts == BY_NUMBER.contacts


@pytest.mark.parametrize(
    "freedoms",
    [
        {PUNCH: Freedom("y", load=-50.0)},
        {1: [Freedom("y", load=-50.0)]},
        {PUNCH: (Freedom("y", load=-50.0), Freedom("x", displacement=0.0))},
        [(PUNCH, Freedom("y", load=-50.0))],
    ],
)
def test_freedoms_by_body(freedoms: Any) -> None:
    """50 N/mm instead of 100 at the punch: base and punch carry them exactly; results answer to bodies, too."""
    solution = solve(problem(), Step(freedoms=freedoms))
    assert solution.step.freedoms[0] == (1, Freedom("y", load=-50.0))
    assert solution.contacts[0].force[1] == pytest.approx(50.0, rel=1e-9)
    assert reactions(solution, BASE)[0].force[1] == pytest.approx(50.0, rel=1e-9)
    assert np.array_equal(solution.displacement(PUNCH), solution.displacement(1))
    assert solution.body(BASE) is solution.condensed[0]


def test_velocities_by_body() -> None:
    """The punch flies away with 1000 mm/s, stated by itself or by its number."""
    lifted = replace(PUNCH, rigid=Rigid("top", (Freedom("y", load=0.0),)))
    moving = Problem((BASE, lifted), (Contact(BASE["top"], lifted["bottom"]),))
    (by_body, by_number) = (
        Transient(moving, H, InitialState(velocities={who: (0.0, 1000.0)})) for who in (lifted, 1)
    )
    assert by_body.start.velocities == by_number.start.velocities == {1: (0.0, 1000.0)}
    assert by_body.solve().velocities[1] == pytest.approx([1000.0], rel=1e-9)


def test_an_initial_equilibrium_by_body() -> None:
    """A transient that begins with the equilibrium under 50 N/mm at the punch stays there under them."""
    step = Step(freedoms={PUNCH: Freedom("y", load=-50.0)})
    moment = Transient(replace(problem(), contacts=(Contact(*SIDES),)), H, InitialState(step)).solve(step)
    assert moment.solution.contacts[0].force[1] == pytest.approx(50.0, rel=1e-6)


COPY = replace(BASE)
NO_NAME: Any = 0
NO_SIDE: Any = BASE


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: BASE["roof"], r"base: wanted one of the facet groups bottom, left, right, top, found 'roof'"),
        (lambda: BASE[NO_NAME], r"base, side: wanted a name, found 0; name a facet group, as in body\[\"top\"\]"),
        (lambda: problem(COPY["top"], SIDES[1]),
         r"contact, first side: wanted a body that the problem has once, of 'base' \(0\), 'punch' \(1\), found another "
         r"body, 'base'; put this one into the problem; dataclasses.replace makes another one"),
        (lambda: Problem((BASE, BASE), (Contact(BASE["top"], (1, "bottom")),)),
         r"found 'base' 2 times; name its number"),
        (lambda: Contact(SIDES[0], SIDES[0]), r"wanted two different surfaces, found 'top' twice"),
        (lambda: problem(SIDES[0], (0, "top")), r"wanted two different surfaces, found 'top' twice"),
        (lambda: Contact(NO_SIDE, SIDES[1]),
         r"first side: wanted a body's index and a facet group, or a body's side, found a Body"),
        (lambda: solve(problem(), Step(freedoms={COPY: Freedom("y", load=1.0)})), r"step, freedoms: .* another body"),
        (lambda: Step(freedoms={PUNCH: NO_NAME}), r"step, freedoms: wanted a tuple of Freedom, found 0"),
        (lambda: Step(freedoms={"punch": Freedom("y", load=1.0)}), r"pairs of a body's index and a Freedom"),
        (lambda: Step(freedoms={PUNCH: [Freedom("y", load=1.0)] * 2}), r"each freedom of a body once, found .*punch"),
        (lambda: solve(problem(), Step(freedoms={PUNCH: Freedom("y", load=1.0), 1: Freedom("y", load=2.0)})),
         r"each freedom of a body once"),
        (lambda: Transient(problem(), H, InitialState(velocities={COPY: (0.0, 1.0)})), r"velocities: .* another body"),
        (lambda: Transient(problem(), H, InitialState(velocities={PUNCH: (0.0, 1.0), 1: (0.0, 1.0)})),
         r"velocities: wanted each body once, found \[1, 1\]"),
        (lambda: solve(problem()).displacement(COPY), r"solution: .* another body, 'base'"),
        (lambda: solve(problem()).function(2), r"wanted a body of the problem, or its number from 0 to 1, found 2"),
        (lambda: solve(problem()).function(cast("Body", "punch")), r"found 'punch'; names are not searched: give the"),
    ],
)
def test_bodies_and_groups_that_are_not_there_are_refused(call: Callable[[], Any], message: str) -> None:
    """With the names that there are."""
    with pytest.raises(InputError, match=message):
        call()
