"""Contact outside the searched window is found: a tip's edge that deep deflection brings against the other flank."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest

from evidence.robustness.campaigns.random_scenes import random_scene
from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.contact import overlap_check, pair_contact, tooth_contact
from evolvent.gears.contact.moved_contact import farthest_moved
from evolvent.gears.contact.overlap_check import overlap_outside, unsearched_overlaps
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.sweep import position_search
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of, spur_scene

DEEP = 277  # the seed of a plane pair whose next tooth pair touches far before its contact line reaches the flank
EARLY = 15
TIMES = 5.0  # its torque, so that the teeth give way by a quarter of a module


@pytest.fixture(scope="module")
def deep() -> GearModel:
    return model_of(random_scene(DEEP))


def solved(model: GearModel) -> SharedPosition:
    return shared_position(model, 0.0, (0.0, 0.0), [0.0], None)


def approach(shared: SharedPosition) -> float:
    """Extra rotation [rad] of the loaded gear."""
    return sum(shared.contact.stand.beyond_nominal) + float(shared.smooth.motion[0])


def test_contact_outside_the_window_is_found(deep: GearModel, monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: next pair's tip edge overlaps by 70 µm outside its window. Exact: the rotation with whole flanks
    searched; overlooking it gives another one, more than a tenth larger, as well balanced."""
    wanted = approach(solved(replace(deep, half_width=np.inf)))
    found = solved(deep)
    assert approach(found) == pytest.approx(wanted, rel=1e-4)
    monkeypatch.setattr(position_search, "overlap_outside", lambda *_: 0.0)
    overlooked = solved(deep)
    assert abs(approach(overlooked)) > 1.1 * abs(wanted)
    assert overlooked.smooth.residual < 1e-9 * overlooked.system.scale
    for shared, low, high in ((overlooked, 0.05, np.inf), (found, 0.0, 0.0)):
        depth = overlap_outside(shared.contact, shared.unsearched, shared.smooth.force, (0.0, 0.0))
        assert low <= depth <= high


def early(two_level: bool) -> GearModel:
    """A heavily loaded spur pair in space whose next tooth pair touches before its path of contact."""
    problem = gear_problem(random_scene(EARLY, plane=False))
    mesh = replace(problem.mesh, order=2, shape="hexahedron", two_level=two_level)
    return prepare_model(replace(problem, mesh=mesh)).model


@pytest.mark.slow
def test_contact_before_the_path_is_found_on_contact_cells(monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: next pair's tip edge overlaps by 6 µm, and its contact line has left the flanks. Exact: the rotation on
    one mesh; overlooking the overlap gives another one, a twentieth larger."""
    angle = np.radians(6.2027)
    wanted = approach(shared_position(early(two_level=False), angle, (0.0, 0.0), [0.0], None))
    model = early(two_level=True)
    found = shared_position(model, angle, (0.0, 0.0), [0.0], None)
    assert found.contact.geometry.half_width == np.inf
    assert len({int(tooth) for tooth in found.contact.geometry.tooth}) > 2
    assert approach(found) == pytest.approx(wanted, rel=0.01)
    monkeypatch.setattr(position_search, "overlap_outside", lambda *_: 0.0)
    assert abs(approach(shared_position(model, angle, (0.0, 0.0), [0.0], None))) > 1.04 * abs(wanted)


def test_nominal_contact_is_all_inside_the_window() -> None:
    """Problem: a pair at nominal load. Exact: all contact is in the window, which keeps its width."""
    model = model_of(helical_scene("contact.friction=0", "mesh.order=2"))
    found = shared_position(model, 0.0, (0.0, 0.0), [0.0], None)
    assert found.contact.geometry.half_width == model.half_width


def depth_outside(
    model: GearModel, beyond_nominal: tuple[float, float], rotation: tuple[float, float] = (0.0, 0.0)
) -> float:
    """Overlap [mm] of undeflected flanks outside half the window, searched at these rotations, then turned on [rad]."""
    stand = PairRotation(model.pair, 0.0, beyond_nominal)
    contact = pair_contact.gear_contact(model.bodies, stand, list(model.teeth), 0.5 * model.half_width)
    nothing = np.zeros((len(contact.geometry.node), 1))
    return overlap_outside(contact, unsearched_overlaps(contact.geometry, model.teeth), nothing, rotation)


def test_depth_of_an_overlap_of_rotated_flanks(deep: GearModel) -> None:
    """Undeflected flanks (no force) turned into each other by δ: they overlap by up to r_b·δ, the same at every point
    of an involute's line of action; off the path of contact by no more. Turned on by ε without another search the
    overlap grows as it does with one, within 5 % (other points are the deepest)."""
    base, δ, ε = deep.bodies[0].gear.base_radius, 2e-3, 1e-4
    depth = depth_outside(deep, (δ, 0.0))
    assert 0.0 < depth <= base * δ * (1.0 + 1e-3)
    for rotation in ((ε, 0.0), (0.0, ε)):
        turned = depth_outside(deep, (δ, 0.0), rotation)
        anew = depth_outside(deep, (δ + rotation[0], rotation[1]))
        assert turned > depth and turned - depth == pytest.approx(anew - depth, rel=0.05)


def test_places_share_one_product_with_the_compliance(monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: a helical pair under load, both neighbours of its middle tooth pair nearly touch. Exact: the
    deepest overlap of all places is the deepest that each has alone; they take one product a gear."""
    model = model_of(helical_scene("contact.friction=0", "mesh.order=2"))
    shared = solved(model)
    contact, force = shared.contact, shared.smooth.force
    monkeypatch.setattr(overlap_check, "NEARLY", 0.1)  # flanks this far apart, so that there are two places
    places = unsearched_overlaps(contact.geometry, model.teeth)
    assert len(places) >= 2
    turned = (2e-2, 0.0)  # rad: until they overlap
    kind = type(model.bodies[Member.PINION].chain)
    with patch.object(kind, "apply", autospec=True, side_effect=kind.apply) as product:
        together = overlap_outside(contact, places, force, turned)
    assert product.call_count == 2
    alone = [overlap_outside(contact, (place,), force, turned) for place in places]
    assert together == pytest.approx(max(alone), rel=1e-12) and together > 0.0


def test_overlap_as_deep_as_the_deflection_is_searched(deep: GearModel, monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: undeflected flanks overlap by a quarter of a module, so far do the teeth give way. Exact: how deep the
    search looks does not matter as long as it is deeper; looking 0.2 modules deep loses the contact altogether.
    More than half a module is refused."""
    module = deep.pair.pinion.normal_module

    def loaded(times: float) -> SharedPosition:
        return solved(replace(deep, load=replace(deep.load, torque=times * deep.load.torque)))

    found = loaded(TIMES)
    assert 0.2 * module < -found.contact.operator.gap.min() < 0.4 * module
    monkeypatch.setattr(tooth_contact, "PENETRATION", 1.0)
    assert approach(loaded(TIMES)) == pytest.approx(approach(found), rel=1e-9)
    monkeypatch.setattr(tooth_contact, "PENETRATION", 0.2)
    monkeypatch.setattr(GearContact, "overlap", 0.0)
    with pytest.raises(NotConverged, match="found none"):
        loaded(TIMES)
    monkeypatch.undo()
    with pytest.raises(NotConverged, match="deflect by less than half a module"):
        loaded(2.0 * TIMES)


def test_flanks_turned_into_each_other_by_more_than_half_a_module_are_not_searched(deep: GearModel) -> None:
    """Problem: either gear turned into the other by 0.51 modules of normal distance; and by less, on flanks that
    overlap as much by their modifications. Exact: refused as too deep, the first before any search."""
    module, gears = deep.pair.pinion.normal_module, deep.pair.gears
    per_module = [module / gear.base_radius / np.cos(gear.base_helix_angle) for gear in gears]
    for gear, share, searches in ((0, 0.51, 0), (1, 0.51, 0), (0, 0.2, 1)):
        turned = (share * per_module[0], 0.0) if gear == 0 else (0.0, share * per_module[1])
        counted = patch.object(pair_contact, "gear_contact", side_effect=pair_contact.gear_contact)
        with counted as search, patch.object(GearContact, "overlap", 0.51):
            with pytest.raises(NotConverged, match="deflect by less than half a module"):
                shared_position(deep, 0.0, turned, [0.0], None)
            assert search.call_count == searches


def test_contact_that_steep_modifications_move_out_of_the_window_is_found() -> None:
    """Problem: linear relief of 40 µm over the last 0.75 mm of He's pair; at a quarter of the pitch the next tooth pair
    touches at the start of its relief, 0.3 mm beside its contact line, which is on the path of contact. Right: the
    rotation with whole flanks searched; without this contact it is 1 µm of flank larger. At level fine the window ends
    between both; on coarser meshes its rim is in the contact."""
    steep = [f"{gear}.{key}" for gear in ("pinion", "wheel")
             for key in ("tip_relief_um=40", "tip_relief_start_diameter_mm=154.5")]
    model, step = model_of(spur_scene("mesh.level=fine", *steep)), 2.0 * np.pi / 50.0 / 20.0
    assert farthest_moved(model.pair) > model.half_width
    before = shared_position(model, 4 * step, (0.0, 0.0), [0.0], None, exact=True)
    turned = before.contact.stand.turned(model.load.on, float(before.smooth.motion[0])).beyond_nominal
    found, wanted = (
        shared_position(each, 5 * step, turned, [0.0], before.patch, exact=True)
        for each in (model, replace(model, half_width=np.inf))
    )
    assert set(found.contact.geometry.point_tooth[found.smooth.traction[:, 0] > 0.0].tolist()) == {-1, 0}
    assert approach(found) == pytest.approx(approach(wanted), rel=1e-4)
