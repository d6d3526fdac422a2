"""The search of a position: its result does not depend on where it starts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep import position_search
from evolvent.gears.sweep.contact_patch import ContactPatch
from evolvent.gears.sweep.frictional_position import solve_position
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import shared_position
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of, spur_scene, swept

ANGLE = np.radians(2.2)
STARTS = (0.0, 1e-5, -3.3e-4, 1.7e-4)  # rad of the loaded gear


def solved(model: GearModel, start: float) -> PositionResult:
    """Frictionless, the search starting from a rotation of the loaded gear."""
    extra = (start, 0.0) if model.load.on == Member.PINION else (0.0, start)
    return solve_position(model, shared_position(model, ANGLE, extra, [0.0], None), 0.0, None, 0.01)[0]


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


@pytest.fixture(scope="module")
def spur() -> GearModel:
    return model_of(spur_scene())


def test_contact_patch_that_has_moved_away_gives_the_same_equilibrium(spur: GearModel) -> None:
    """Problem: a contact patch in which nothing is pressed near the present contact, as after a long step. Exact: the
    equilibrium without one."""
    nothing = ContactPatch(np.zeros((1, 2)), np.zeros(1, dtype=bool))
    found, wanted = (shared_position(spur, 0.01, (0.0, 0.0), [0.0], before) for before in (nothing, None))
    assert found.smooth.motion == pytest.approx(wanted.smooth.motion, abs=1e-14)
    assert found.contact.stand.extra == pytest.approx(wanted.contact.stand.extra, rel=1e-10)


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
