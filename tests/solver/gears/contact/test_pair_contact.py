"""The contact of worn flanks: its gap follows the wear, its geometry is found once."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from evolvent.gears.contact.contact_geometry import ContactGeometry
from evolvent.gears.contact.pair_contact import GearContact, gear_contact
from evolvent.gears.gear_model import GearModel
from evolvent.gears.kinematics import PairRotation
from tests.support.gear_cases import model_of, spur_scene

DEPTHS = 0.003, 0.002
"""Wear [mm] of pinion and wheel, the same everywhere on their flanks."""
FOUND_ONCE = sorted(name for name, value in vars(ContactGeometry).items() if isinstance(value, cached_property))


@pytest.fixture(scope="module")
def model() -> GearModel:
    return model_of(spur_scene("mesh.level=quick"))


@pytest.fixture(scope="module")
def contact(model: GearModel) -> GearContact:
    return searched(model)


def searched(model: GearModel) -> GearContact:
    return gear_contact(model.bodies, PairRotation(model.pair, 0.02), list(model.teeth), model.half_width)


def worn(model: GearModel) -> GearModel:
    """Both flanks worn by DEPTHS."""
    pinion, wheel = (replace(b, worn=np.full(len(b.flank.points), depth)) for b, depth in zip(model.bodies, DEPTHS))
    return replace(model, bodies=(pinion, wheel))


@pytest.mark.parametrize("name", FOUND_ONCE)
def test_wear_keeps_every_quantity_of_the_geometry(name: str, model: GearModel, contact: GearContact) -> None:
    """Problem: a position whose flanks wear on. Exact: what does not depend on wear is not computed again, also what
    is added to the class later."""
    before = getattr(contact.geometry, name)
    assert getattr(contact.with_wear(worn(model).bodies).geometry, name) is before


@pytest.mark.parametrize("name", FOUND_ONCE)
def test_geometry_does_not_depend_on_wear(name: str, model: GearModel, contact: GearContact) -> None:
    """Problem: the same position searched between new flanks and between worn ones. Exact: the same geometry."""
    new, used = (flat(getattr(each.geometry, name)) for each in (contact, searched(worn(model))))
    assert all(np.array_equal(one, other) for one, other in zip(new, used, strict=True))


def flat(value: object) -> list[NDArray[Any]]:
    """The arrays of a quantity of the geometry."""
    if isinstance(value, tuple):
        return [array for part in value for array in flat(part)]
    if isinstance(value, np.ndarray):
        return [value]
    if hasattr(value, "toarray"):
        return [value.toarray()]
    return [array for part in vars(value).values() for array in flat(part)]


def test_wear_opens_the_gap_by_both_depths(model: GearModel, contact: GearContact) -> None:
    """Problem: both flanks worn evenly. Exact: the gap opens by the sum of their depths, and closes again where the
    flanks are new; nothing else of the contact operator changes."""
    again = contact.with_wear(worn(model).bodies)
    np.testing.assert_allclose(again.operator.gap - contact.operator.gap, sum(DEPTHS), rtol=1e-10)
    assert np.array_equal(again.with_wear(model.bodies).operator.gap, contact.operator.gap)
    assert np.array_equal(again.operator.frames, contact.operator.frames)
    assert np.array_equal(again.operator.weights, contact.operator.weights)
    assert np.array_equal(again.operator.stabiliser, contact.operator.stabiliser)
    assert np.array_equal(again.operator.points, contact.operator.points)


def test_contact_sent_between_ranks_is_the_same(model: GearModel, contact: GearContact) -> None:
    """Problem: a contact sent without the gears, which are attached again. Exact: the same contact operator."""
    bare = contact.without_bodies()
    assert bare.bodies == bare.geometry.bodies == ()
    received = bare.with_bodies(worn(model).bodies)
    assert all(body.worn is None for body in received.geometry.bodies)
    np.testing.assert_allclose(received.operator.gap - contact.operator.gap, sum(DEPTHS), rtol=1e-10)
