"""Pressure at a tip's corner acts along the normal of the smooth flank that the corner slides on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evidence.robustness.campaigns.random_scenes import random_scene
from evidence.robustness.campaigns.scene_outcomes import Verdict, outcome_of
from evolvent.contact.nitsche.contact_operator import contact_operator
from evolvent.contact.search.pairing import pair_surfaces
from evolvent.fem.nodal_frames import tangent_frames
from evolvent.fem.surface import Surface
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import model_of, spur_scene, swept

LIGHT = 1e-3  # of the torque, so that nothing but the corner itself gives way
OFF = 0.4  # modules beyond the path of contact


@pytest.fixture(scope="module")
def spur() -> GearModel:
    """He's pair with one tooth pair alone, whose whole flanks are searched."""
    model = model_of(spur_scene())
    return replace(
        model, teeth=(0,), half_width=np.inf, load=replace(model.load, torque=LIGHT * model.load.torque)
    )


def at_corner(model: GearModel, gear: Member) -> PositionResult:
    """Where the tip's corner of a gear bears: the pinion's after the path of contact, the wheel's before it."""
    pair = model.pair
    start, end = pair.path_of_contact
    beyond = OFF * pair.pinion.normal_module
    ξ = end + beyond if gear == Member.PINION else start - beyond
    return swept(model, np.degrees([ξ / pair.pinion.base_radius]), [0.0])[0].results[0]


def arm(model: GearModel, result: PositionResult, gear: Member) -> float:
    """Of the force at a gear's corner about the gear's own axis [mm]: the force lies on the line through the corner
    that touches the base circle of the other gear."""
    body, other = model.bodies[gear], gear.mate
    rotation, centre = result.stand.rotation(gear, 2), result.stand.centre(gear, 2)
    corner = body.flank.points[body.tip_zone][0] @ rotation.T + centre
    away = corner - result.stand.centre(other, 2)
    slant = np.arcsin(model.pair.gears[other].base_radius / np.linalg.norm(away))
    arms = [abs(_cross(corner - centre, _turned(away, sign * slant))) for sign in (-1.0, 1.0)]
    return min(arms, key=lambda value: abs(value - body.gear.base_radius))


def _turned(vector: Floats, angle: float) -> Floats:
    """Unit vector."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]]) @ vector / np.linalg.norm(vector)


def _cross(a: Floats, b: Floats) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


@pytest.mark.parametrize("gear", Member)
def test_force_of_a_tip_corner_is_normal_to_the_smooth_flank(spur: GearModel, gear: Member) -> None:
    """Problem: a gear's tip corner bears on the other gear's flank off the path of contact, under hardly any load.
    Exact: without friction the force is normal to the involute on which the corner lies, so that it touches that base
    circle; T_1/T_2 are the arms of that line. The corner's own normal gives a ratio more than 1 % away."""
    result = at_corner(spur, gear)
    assert result.contact.edge.all()
    own, other = abs(result.torques[gear]), abs(result.torques[gear.mate])
    base = [each.base_radius for each in spur.pair.gears]
    wanted = arm(spur, result, gear) / base[gear.mate]
    assert abs(wanted / (base[gear] / base[gear.mate]) - 1.0) > 0.01
    assert own / other == pytest.approx(wanted, rel=1e-3)


def line(ends: tuple[Floats, Floats], cells: int) -> Surface:
    """A straight surface of second order; what lies to its right is outside."""
    share = np.linspace(0.0, 1.0, 2 * cells + 1)[:, None]
    points = (1.0 - share) * ends[0] + share * ends[1]
    facets = np.array([[2 * i, 2 * i + 2, 2 * i + 1] for i in range(cells)])
    return Surface.from_arrays(points, facets, "interval", 2)


def test_gap_along_turned_normals_is_the_distance_along_them() -> None:
    """Problem: a straight surface before another one at 5°, pressed along the other's normal. Exact: the gap is the
    distance from that surface, and the frames are its normal and tangent."""
    slope = np.radians(5.0)
    n2 = np.array([np.sin(slope), -np.cos(slope)])
    first = line((np.array([1.0, 0.0]), np.array([0.0, 0.0])), 3)
    middle, along = np.array([0.5, 0.1]), np.array([np.cos(slope), np.sin(slope)])
    second = line((middle - along, middle + along), 4)
    pairing = pair_surfaces(first, second, 1.0, 1.0)
    plain = contact_operator(pairing, first, second, np.ones((7, 2)), tangent_frames(first.normals))
    turned = plain.pressing_along(np.tile(-n2, (7, 1)))
    assert turned.gap == pytest.approx((middle - turned.points) @ -n2, abs=1e-12)
    assert np.abs(turned.gap - plain.gap).max() > 1e-4
    assert turned.frames == pytest.approx(np.tile([-n2, along * -1.0], (7, 1, 1)), abs=1e-12)


@pytest.mark.parametrize("seed", [344, 482])
def test_energy_balances_with_loaded_tip_edges(seed: int) -> None:
    """Problem: helical pairs whose tip edges carry much. Exact: over a pitch no energy is missing; along the pinion's
    normals alone 1.0e-2 was."""
    outcome = outcome_of(random_scene(seed), seed)
    assert outcome.verdict is Verdict.CONVERGED
    assert outcome.balance < 6e-3
