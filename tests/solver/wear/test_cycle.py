"""A cycle on worn surfaces, solved on step systems that do not depend on wear."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest

from evolvent import Material, solve
from evolvent.contact.problem import step_pairing
from evolvent.contact.problem.condensed_body import prepare
from evolvent.contact.step.step_system import Position
from evolvent.wear import Archard, Cycle, Travel, WearStudy
from evolvent.wear.cycle import WornCycle, solve_cycle, step_systems
from tests.support.wear_cases import LINE_LOAD, K, cylinder, to_and_fro

TRAVEL = Cycle(travel=(Travel(1, translation=(1.0, 0.0, 0.0)),))
SIDE = (0, "arc")


def test_no_class_derives_from_the_step_system() -> None:
    """Wear is composed with a step system: no subclass can be half initialised while the system's constructor runs."""
    assert Position.__subclasses__() == []


@pytest.mark.parametrize(("cycle", "searches"), [(TRAVEL, 1), (to_and_fro(5e-4), 5)])
def test_each_step_is_searched_once_for_all_depths(
    cycle: Cycle, searches: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Problem: two cycles at different depths on the same meshes. Exact: pairs do not depend on the worn depth, so each
    step is searched once in all, also where a cycle of slip is solved twice."""
    counted = Mock(wraps=step_pairing.pair_surfaces)
    monkeypatch.setattr(step_pairing, "pair_surfaces", counted)
    study = WearStudy(cylinder(3.0), (Archard(K),), cycle)
    for depth in (0.0, 1e-4):
        study.evaluate(np.full(len(study.areas), depth))
    assert counted.call_count == searches


def test_step_system_is_unchanged_by_worn_cycles() -> None:
    """Problem: one step system, solved without wear, at two depths, and again without wear. Exact: each solution is
    that of a system of its own, to the last bit."""
    problem = cylinder(3.0)
    prepared = prepare(problem)
    systems = step_systems(problem, prepared, TRAVEL)
    nodes = len(prepared[0].surfaces["arc"].points)

    def worn(depth: float) -> WornCycle:
        return WornCycle(problem, (Archard(K),), TRAVEL, {SIDE: np.full(nodes, depth)}, {})

    before, _ = systems[0].solve(None)
    shared = [solve_cycle(worn(depth), systems)[0][0].result for depth in (2e-3, 1e-3)]
    alone = [
        solve_cycle(worn(depth), step_systems(problem, prepared, TRAVEL))[0][0].result for depth in (2e-3, 1e-3)
    ]
    after, _ = systems[0].solve(None)
    for one, other in zip(shared, alone):
        assert (one.pressure == other.pressure).all()
    assert (before.contacts[0].pressure == after.contacts[0].pressure).all()
    assert not (shared[0].pressure == before.contacts[0].pressure).all()


def test_unworn_cycle_is_the_plain_contact_solution() -> None:
    """Problem: a cycle at no depth. Exact: the contact solution of the problem itself, and w λ s adds up to the load
    times the sliding distance."""
    problem = cylinder(8.0, material=Material(2.1e4, 0.3))
    worn = WornCycle(problem, (Archard(K),), TRAVEL, {}, {})
    ((state,),) = solve_cycle(worn, step_systems(problem, prepare(problem), TRAVEL))
    np.testing.assert_allclose(state.result.pressure, solve(problem).contacts[0].pressure, rtol=1e-9)
    assert state.work.sum() == pytest.approx(LINE_LOAD * 1.0, rel=1e-3)


def test_implicit_block_of_a_slip_cycle_is_refused() -> None:
    """The contact law cannot wear within a block where sliding is the slip of steps: InputError."""
    cycle = to_and_fro(5e-4)
    problem = cylinder(3.0)
    worn = replace(WornCycle(problem, (Archard(K),), cycle, {}, {}), block=10.0)
    with pytest.raises(ValueError, match="wanted travel for an implicit block"):
        solve_cycle(worn, step_systems(problem, prepare(problem), cycle))
