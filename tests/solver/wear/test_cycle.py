"""A cycle on worn surfaces, solved on step systems that do not depend on wear."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent import ContactResult, Material, solve
from evolvent.wear import Archard, Cycle, Travel, WearStudy
from evolvent.wear.cycle import WornCycle, solve_cycle
from evolvent.wear.worn_geometry import WornGeometry
from tests.support.running.patches import calling_first
from tests.support.wear_cases import LINE_LOAD, K, cylinder, to_and_fro

TRAVEL = Cycle(travel=(Travel(1, translation=(1.0, 0.0, 0.0)),))
SIDE = (0, "arc")


def geometry(cycle: Cycle = TRAVEL) -> WornGeometry:
    """A cylinder of few cells that wears on a slab."""
    return WornGeometry.unworn(cylinder(3.0), (Archard(K),), cycle)


def test_no_class_derives_from_the_step_system() -> None:
    """Wear is composed with a step system: no subclass can be half initialised while the system's constructor runs."""
    (system,) = geometry().systems
    assert [kind for kind in type(system).__subclasses__() if kind.__module__.startswith("evolvent")] == []


@pytest.mark.parametrize(("cycle", "searches"), [(TRAVEL, 1), (to_and_fro(5e-4), 5)])
def test_each_step_is_searched_once_for_all_depths(
    cycle: Cycle, searches: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Problem: two cycles at different depths on the same meshes. Exact: pairs do not depend on the worn depth, so each
    step's system is made once in all, also where a cycle of slip is solved twice."""
    kind, made = type(geometry().systems[0]), list[object]()
    monkeypatch.setattr(kind, "__init__", calling_first(kind.__init__, lambda system, *_, **__: made.append(system)))
    study = WearStudy(cylinder(3.0), (Archard(K),), cycle)
    for depth in (0.0, 1e-4):
        study.evaluate(np.full(len(study.areas), depth))
    assert len(made) == searches


def test_step_system_is_unchanged_by_worn_cycles() -> None:
    """Problem: one step system, solved without wear, at two depths, and again without wear. Exact: each solution is
    that of a system of its own, to the last bit."""
    bodies = geometry()

    def solved(on: WornGeometry, depth: float) -> ContactResult:
        worn = WornCycle(on.problem, (Archard(K),), TRAVEL, {SIDE: np.full(len(on.areas), depth)}, {})
        return solve_cycle(worn, on.systems)[0][0].result

    before, _ = bodies.systems[0].solve(None)
    shared = [solved(bodies, depth) for depth in (2e-3, 1e-3)]
    alone = [solved(replace(bodies), depth) for depth in (2e-3, 1e-3)]
    after, _ = bodies.systems[0].solve(None)
    for one, other in zip(shared, alone):
        assert (one.pressure == other.pressure).all()
    assert (before.contacts[0].pressure == after.contacts[0].pressure).all()
    assert not (shared[0].pressure == before.contacts[0].pressure).all()


def test_unworn_cycle_is_the_plain_contact_solution() -> None:
    """Problem: a cycle at no depth. Exact: the contact solution of the problem itself, and w λ s adds up to the load
    times the sliding distance."""
    problem = cylinder(8.0, material=Material(2.1e4, 0.3))
    bodies = WornGeometry.unworn(problem, (Archard(K),), TRAVEL)
    ((state,),) = solve_cycle(WornCycle(problem, (Archard(K),), TRAVEL, {}, {}), bodies.systems)
    np.testing.assert_allclose(state.result.pressure, solve(problem).contacts[0].pressure, rtol=1e-9)
    assert state.work.sum() == pytest.approx(LINE_LOAD * 1.0, rel=1e-3)


def test_implicit_block_of_a_slip_cycle_is_refused() -> None:
    """The contact law cannot wear within a block where sliding is the slip of steps: InputError."""
    bodies = geometry(to_and_fro(5e-4))
    worn = WornCycle(bodies.problem, (Archard(K),), bodies.cycle, {}, {}, block=10.0)
    with pytest.raises(ValueError, match="wanted travel for an implicit block"):
        solve_cycle(worn, bodies.systems)
