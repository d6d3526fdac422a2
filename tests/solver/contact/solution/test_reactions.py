"""Reactions of supports and couplings: balance of each body, and agreement with statics."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent import (
    Body,
    BodyForce,
    Contact,
    Fixed,
    Freedom,
    Material,
    Nitsche,
    Placement,
    Problem,
    Rigid,
    Solution,
    Step,
    Traction,
    reactions,
    solve,
)
from evolvent_meshes.shapes.blocks import box, rectangle

WEIGHT = 3.0  # N/mm³
TURN = np.array([[0.8, -0.6], [0.6, 0.8]])


def stack(nitsche: Nitsche) -> Problem:
    """A block pressed down and to the side by its rigid lid, on one with a weight that rolls on its bottom and is
    moved to the side at its right edge; friction between."""
    freedoms = Freedom("y", load=-300.0), Freedom("rz", load=20.0), Freedom("x", displacement=2e-4)
    lid = Rigid("top", freedoms, (1.0, 2.0))
    upper = Body(rectangle(2.0, 1.0, 5, 3, origin=(0.0, 1.0)), Material(70e3, 0.3), loads=(
        Traction("right", (0.0, -7.0)), Traction("top", (3.0, -4.0))), rigid=lid, name="upper")
    lower = Body(rectangle(2.0, 1.0, 7, 4), supports=(Fixed("bottom", "y"), Fixed("right", "x", 1e-4)), loads=(
        BodyForce((0.0, -WEIGHT)),), name="lower")
    return Problem((upper, lower), (Contact((0, "bottom"), (1, "top"), 0.3, reach=0.1),), nitsche)


@pytest.fixture(scope="module", params=[1.0, -1.0, 0.0])
def solution(request: pytest.FixtureRequest) -> Solution:
    """Of the stack under three quarters of its loads, both blocks turned, for each variant of Nitsche's method."""
    place = Placement(TURN, np.array([4.0, 5.0]))
    return solve(stack(Nitsche(theta=request.param)), Step(0.75, (place, place)))


def test_reactions_balance_each_body(solution: Solution) -> None:
    """Reactions, loads and contact forces of a body add up to zero, to 1e-10 of the load; forces in its frame."""
    contact = solution.contacts[0].force @ TURN  # on the lower block, as it sees it
    given = (np.array([2.0 * 3.0, -2.0 * 4.0 - 1.0 * 7.0]), np.array([0.0, -2.0 * WEIGHT]))
    for body, sign in ((0, -1.0), (1, 1.0)):
        held = sum(reaction.force for reaction in reactions(solution, body))
        assert np.abs(held + 0.75 * given[body] + sign * contact).max() < 1e-10 * 300.0


def test_reaction_of_a_rigid_coupling_includes_its_load(solution: Solution) -> None:
    """In the direction of a loaded freedom a coupling presses with its load; about its centre, with its moment."""
    (lid,) = reactions(solution, 0, about=(1.0, 2.0))
    assert (lid.group, lid.directions) == ("top", "rigid")
    assert lid.force[1] == pytest.approx(-0.75 * 300.0, rel=1e-9)
    assert lid.moment[0] == pytest.approx(0.75 * 20.0, rel=1e-7)


def test_node_held_twice_counts_for_the_first_support(solution: Solution) -> None:
    """Each support has the forces along its own directions: an edge held along x carries no vertical force."""
    bottom, right = reactions(solution, 1)
    assert (bottom.group, right.group) == ("bottom", "right")
    assert right.force[1] == 0.0
    assert right.force[0] != 0.0


def test_reaction_moment_of_a_beam_in_3d() -> None:
    """A plate on the floor, loaded on its left half only by a second one, held at the left and right below: the
    supports share the load as levers say, whatever the elasticity: two unknowns, two equations of statics."""
    plate = box((4.0, 1.0, 1.0), (4, 1, 1), 1)
    left, right = np.isclose(plate.points[:, 0], 0.0), np.isclose(plate.points[:, 0], 4.0)
    assert left.sum() == right.sum() == 4
    block = box((2.0, 1.0, 1.0), (2, 1, 1), 1, origin=(0.0, 0.0, 1.0))
    guide = (Fixed("left", "x"), Fixed("front", "y"))
    press = Body(block, Material(), guide, (Traction("top", (0.0, 0.0, -30.0)),), name="press")
    ends = (Fixed("left", "z"), Fixed("right", "z"), Fixed("front", "y"), Fixed("left", "x"))
    problem = Problem((press, Body(plate, Material(), ends)), (Contact((0, "bottom"), (1, "top"), reach=0.1),))
    found = solve(problem)
    first, second, *_ = reactions(found, 1)
    assert first.force[2] + second.force[2] == pytest.approx(60.0, rel=1e-9)
    assert 60.0 > first.force[2] > 2.0 * second.force[2] > 0.0
    carried = sum(reaction.force for reaction in reactions(found, 0)) - found.contacts[0].force
    assert np.abs(carried - [0.0, 0.0, 60.0]).max() < 1e-8
