"""Predictions of a position from the one before: friction over pressure at the same place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.contact_patch import FrictionPattern
from evolvent.gears.sweep.friction_history import PreviousJump
from evolvent.gears.sweep.frictional_position import _expected_direction
from evolvent.gears.sweep.pitch_sweep import SweepState, SweptPosition, initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_search import shared_position
from evolvent.gears.sweep.slip import slip_direction
from tests.support.gear_cases import helical_scene, model_of

FRICTION, POSITIONS = 0.3, 12


@pytest.fixture(scope="module")
def helical() -> GearModel:
    return model_of(helical_scene())


@pytest.fixture(scope="module")
def swept(helical: GearModel) -> list[SweptPosition]:
    """A pitch, without the positions that close it."""
    pitch = uniform_pitch(helical.pair.pinion.z, POSITIONS)
    return list(sweep_pitch(helical, pitch, [FRICTION], initial_state([FRICTION])))


@pytest.fixture(scope="module")
def geometry(helical: GearModel) -> ContactGeometry:
    return shared_position(helical, 0.01, (0.0, 0.0), [FRICTION], None).contact.geometry


def without_patterns(state: SweepState) -> SweepState:
    """The sweep state as it is read from a file."""
    (history,) = state.histories
    assert history is not None and history.pattern is not None
    return replace(state, histories=(replace(history, pattern=None),))


@pytest.mark.parametrize("k", [4, 8])
def test_friction_of_the_position_before_changes_nothing(
    k: int, helical: GearModel, swept: list[SweptPosition]
) -> None:
    """Problem: a position that follows another one, with and without its friction pattern. Exact: the same transmission
    error, 1e-8, and loss, 1e-7."""
    pitch = uniform_pitch(helical.pair.pinion.z, POSITIONS)
    (bare,) = next(sweep_pitch(helical, pitch, [FRICTION], without_patterns(swept[k - 1].state), k)).results
    (found,) = swept[k].results
    assert found.transmission_error == pytest.approx(bare.transmission_error, rel=1e-8)
    assert found.friction_loss == pytest.approx(bare.friction_loss, rel=1e-7)


def test_friction_starts_from_the_pattern_unless_that_is_against_sliding(geometry: ContactGeometry) -> None:
    """Problem: a pattern of half the bound, at each point against the known direction of sliding, or along it. Exact:
    full sliding in the known direction, or the pattern; the known direction without friction, whose bound is zero."""
    known = slip_direction(geometry, 0.01)
    assert known.any() and not known.any(axis=1).all()
    bound = FRICTION * np.ones((len(known), 1))
    for sign, wanted in ((-0.5, known), (0.5, 0.5 * known)):
        pattern = FrictionPattern.of(geometry, np.hstack([np.ones((len(known), 1)), sign * bound * known]))
        before = PreviousJump(geometry.stand, np.zeros((len(geometry.node), 3)), pattern)
        assert _expected_direction(geometry, FRICTION, before, 0.01) == pytest.approx(wanted, abs=1e-14)
        assert np.array_equal(_expected_direction(geometry, 0.0, before, 0.01), known)


def test_pattern_is_that_of_the_points_themselves(geometry: ContactGeometry) -> None:
    """Problem: a pattern of random ratios at half of the points. Exact: at these points the ratios; elsewhere, away
    from all of them in roll distance, zero."""
    rng, count = np.random.default_rng(1), len(geometry.operator.weights)
    ratio, pressed = rng.uniform(-0.1, 0.1, (count, 2)), geometry.operator.shape @ geometry.roll_distance > 0.0
    assert pressed.any() and not pressed.all()
    pressure = np.where(pressed, 300.0, 0.0)
    pattern = FrictionPattern.of(geometry, np.column_stack([pressure, pressure[:, None] * ratio]))
    found = pattern.at(geometry)
    assert found[pressed] == pytest.approx(ratio[pressed], abs=1e-15)
    far = geometry.operator.shape @ geometry.roll_distance < -geometry.stand.pair.pinion.normal_module
    assert far.any() and not found[far].any()


def test_pattern_without_contact_is_zero(geometry: ContactGeometry) -> None:
    """Exact: no friction is known where nothing touched."""
    nothing = FrictionPattern.of(geometry, np.zeros((len(geometry.operator.weights), 3)))
    assert not nothing.at(geometry).any()


def test_stiffness_is_that_of_the_start_of_friction(helical: GearModel) -> None:
    """Exact: the tangent stiffness of the frictionless state to 1e-8 of the load; of that to 1e-4 within 2e-5."""
    rough, exact = (shared_position(helical, 0.01, (0.0, 0.0), [FRICTION], None, exact=e) for e in (False, True))
    assert rough.stiffness == pytest.approx(exact.stiffness, rel=2e-5)
