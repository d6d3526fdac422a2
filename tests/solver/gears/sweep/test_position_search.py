"""The search of a position: its result does not depend on where it starts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from evolvent.contact.newton.equilibrium import Equilibrium, frictionless
from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep import position_search
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.frictional_position import solve_position
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import course_after, shared_position
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of, spur_scene, swept

ANGLE = np.radians(2.2)
STARTS = (0.0, 1e-5, -3.3e-4, 1.7e-4)  # rad of the loaded gear


def solved(model: GearModel, start: float) -> PositionResult:
    """Frictionless, the search starting from a rotation of the loaded gear."""
    beyond_nominal = (start, 0.0) if model.load.on == Member.PINION else (0.0, start)
    return solve_position(model, shared_position(model, ANGLE, beyond_nominal, [0.0], None), 0.0, None, 0.01)[0]


def apart(model: GearModel) -> float:
    """Largest relative difference of transmission error and largest pressure of all starts from the first."""
    first, *others = (solved(model, start) for start in STARTS)
    pairs = [(r.transmission_error, first.transmission_error) for r in others]
    pairs += [(r.pressure.max(), first.pressure.max()) for r in others]
    return max(abs(a / b - 1.0) for a, b in pairs)


@pytest.mark.parametrize("make", [spur_scene, helical_scene])
def test_search_from_different_rotations_gives_the_same_result(make: Callable[[str], Scene]) -> None:
    """Starts up to 70 µm of flank apart: the same result within 1e-8, as searches are made at multiples of a small
    rotation, in the end at the one nearest to the solution."""
    assert apart(model_of(make("contact.friction=0"))) < 1e-8


def test_search_without_fixed_rotations_depends_on_its_start(monkeypatch: pytest.MonkeyPatch) -> None:
    """The check above fails where searches are made wherever the last one led to."""
    monkeypatch.setattr(position_search, "_at_a_multiple", lambda model, stand: stand)
    assert apart(model_of(helical_scene("contact.friction=0"))) > 1e-7


def test_two_places_do_not_send_a_search_back_and_forth(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no first search at a place is near enough, the second one there is taken, with the same result; were it
    not, none would be found."""
    model = model_of(spur_scene("contact.friction=0"))
    wanted = solved(model, 0.0).transmission_error
    monkeypatch.setattr(position_search, "NEAREST", 0.0)
    assert solved(model, 0.0).transmission_error == pytest.approx(wanted, rel=1e-8)
    monkeypatch.setattr(position_search, "NEAREST_AGAIN", 0.0)
    with pytest.raises(NotConverged, match="after 8 searches"):
        solved(model, 0.0)


@pytest.fixture(scope="module")
def spur() -> GearModel:
    return model_of(spur_scene())


def test_contact_patch_that_has_moved_away_gives_the_same_equilibrium(spur: GearModel) -> None:
    """Problem: a contact patch in which nothing is pressed near the present contact, as after a long step. Exact: the
    equilibrium without one."""
    nothing = ContactPatch(np.zeros((1, 2)), np.zeros(1, dtype=bool))
    found, wanted = (shared_position(spur, 0.01, (0.0, 0.0), [0.0], before) for before in (nothing, None))
    assert found.smooth.motion == pytest.approx(wanted.smooth.motion, abs=1e-14)
    assert found.contact.stand.beyond_nominal == pytest.approx(wanted.contact.stand.beyond_nominal, rel=1e-10)


def test_further_search_starts_from_the_forces_of_the_one_before(
    spur: GearModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A position that is searched a second time has the same nodes: it starts from the forces of the first search, with
    a guess of the motion that is the solution's to 1 % of the turn between both. In a wider window there are other
    nodes, and it starts from the contact patch."""
    turn, found = 2.0 * position_search.RELOCATE * spur.pair.pinion.normal_module / spur.base_radius, []

    def recorded(*arguments: Any, **options: Any) -> Equilibrium:
        found.append((options.get("near"), frictionless(*arguments, **options)))
        return found[-1][1]

    monkeypatch.setattr(position_search, "frictionless", recorded)
    shared_position(spur, ANGLE, (1e-4, 0.0), [0.0], None)
    (first, _), *again = found
    assert first is None and again
    for near, solution in again:
        assert near is not None
        assert near.motion == pytest.approx(solution.motion, abs=0.01 * turn)
    found.clear()
    shared_position(replace(spur, half_width=0.5 * spur.half_width), ANGLE, (0.0, 0.0), [0.0], None)
    assert found[1][0] is None


def test_frictionless_state_is_the_same_from_the_last_position_and_from_none(spur: GearModel) -> None:
    """The frictionless state at an angle is one: from the state before, or cold (the rest is the geometry's change over
    the 0.2 µm that the free rotation may be away from where the flanks were searched)."""
    cold = swept(spur, np.array([2.0]), [0.0])[0].results[0]
    warm = swept(spur, np.array([1.0, 2.0]), [0.0])[0].results[1]
    assert warm.transmission_error == pytest.approx(cold.transmission_error, rel=2e-5)


def test_contact_line_between_two_rows_of_points_has_a_start() -> None:
    """A mesh so coarse that no point lies near the contact line has a start all the same: T_2/T_1 = z_2/z_1 exactly."""
    model = model_of(spur_scene("mesh.elements_per_contact_width=0.5"))
    for curve in swept(model, np.arange(0.1, 7.2, 0.4), [0.0]):
        assert np.abs(curve.torque_ratio - 1.0).max() < 0.05


def test_sweep_predicts_where_the_next_equilibrium_is(spur: GearModel) -> None:
    """At 3.0°, 3.1° and 3.2° the transmission error of this pair goes on smoothly: from the first two positions the
    third rotation is predicted three times closer than the second one is to it."""
    *angles, coming = np.radians([3.0, 3.1, 3.2])
    swept_to = list(sweep_pitch(spur, Pitch(tuple(angles)), [0.0], initial_state([0.0])))[-1].state
    there = shared_position(spur, coming, (0.0, 0.0), [0.0], None)
    wanted = np.array(course_after(spur, there, None).beyond_nominal)
    assert swept_to.course is not None
    moved = np.abs(wanted - swept_to.course.beyond_nominal).max()
    assert 3.0 * np.abs(wanted - swept_to.predicted(coming)).max() < moved


def test_result_with_friction_does_not_depend_on_its_start(spur: GearModel) -> None:
    """μ = 0.1 alone, which starts from a frictionless state solved to 1e-5 of the load, and beside μ = 0, whose result
    that state is: the same equilibrium within 1e-8, the stiffness within 1e-5."""
    alone, beside = (
        swept(spur, np.array([2.0, 2.2]), frictions)[-1].results[-1] for frictions in ([0.1], [0.0, 0.1])
    )
    assert alone.transmission_error == pytest.approx(beside.transmission_error, rel=1e-8)
    assert alone.pressure.max() == pytest.approx(beside.pressure.max(), rel=1e-8)
    assert alone.stiffness == pytest.approx(beside.stiffness, rel=1e-5)
