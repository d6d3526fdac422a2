"""Bodies that travel wear on their whole track: wheels, discs and belts, against Archard's law."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent import Body, Contact, Fixed, Freedom, Material, Placement, Problem, Rigid, Step
from evolvent.fem.surface import surface_of
from evolvent.wear import Archard, BlockSettings, Cycle, CycleState, Travel, WearStudy
from evolvent.wear.mesh_motion import mesh_volume
from evolvent.wear.sliding_track import track_of
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import box
from evolvent_meshes.shapes.rings import ring_sphere
from tests.support.running.samples import sampled
from tests.support.wear_cases import LINE_LOAD, RADIUS, K, cylinder

SOFT, STIFF = Material(2.1e4, 0.3), Material(2.1e5, 0.3)
TURN, TRACK, LOAD, PUNCH = 2.0 * np.pi, 4.0, 100.0, 2.0  # rad; mm; N; mm
WHEEL = Cycle(travel=(Travel(0, rotation=(0.0, 0.0, TURN), centre=(0.0, RADIUS, 0.0)),))
DISC = Travel(1, rotation=(0.0, 0.0, TURN), centre=(0.0, -TRACK, 0.0))
BELT = Travel(1, translation=(60.0, 0.0, 0.0))
PIN, RING = (0, "bottom"), (1, "top")


OBLIQUE = replace(BELT, translation=(30.0, 40.0, 0.0))
QUADRATIC = [(DISC, 0.2), (OBLIQUE, 0.0), (DISC, 0.0), (BELT, 0.0), (BELT, 0.2), (OBLIQUE, 0.2)]
CASES = [*((travel, friction, 1) for travel, friction in QUADRATIC), *sampled([(*case, 2) for case in QUADRATIC], 2)]
"""Travel, friction and order of the cells; of order 2 those that take seconds each are `evidence` but for two."""


def punch(order: int = 1, friction: float = 0.0) -> Problem:
    """A square pin (body 0) of 2 mm on a slab of 4 mm, whose cells are a quarter smaller."""
    pin = box((PUNCH, PUNCH, 2.0), (6, 6, 4), order, origin=(-0.5 * PUNCH, -0.5 * PUNCH, 0.0))
    slab = box((4.0, 4.0, 2.0), (16, 16, 4), order, origin=(-2.0, -2.0, -2.0))
    down = Rigid("top", (Freedom("z", load=-LOAD),))
    bodies = Body(pin, STIFF, rigid=down, name="pin"), Body(slab, SOFT, (Fixed("bottom"),), name="slab")
    return Problem(bodies, (Contact(PIN, RING, friction, reach=0.1),))


def fresh(study: WearStudy) -> CycleState:
    """The first cycle."""
    return study.evaluate(np.zeros(len(study.areas)))


def certified(study: WearStudy, state: CycleState) -> None:
    """Both sides' volumes at their nodes and over their tracks are K/H ∫∫p|v_s| to rounding."""
    for side in study.sides:
        assert state.volumes[side] == pytest.approx(state.integrals[side], rel=1e-9)


@pytest.mark.parametrize("friction", [0.0, 0.2])
@pytest.mark.parametrize("order", [1, 2])
def test_wheel_wears_all_around_its_rim(order: int, friction: float) -> None:
    """Problem: a wheel turns on a block, 2D, different K/H. Exact: all around, the wheel loses (K₁/H) F' in a
    revolution, as volume 2πR times that; the block loses (K₂/H) F' 2πR in place. The contact is 0.015 R wide to each
    side, so that the pressure is inclined by up to 1e-4."""
    law = Archard(K, 3.0 * K)
    study = WearStudy(cylinder(8.0, order, friction, SOFT), (law,), WHEEL)
    state = fresh(study)
    rates = study.by_side(state.rate)
    certified(study, state)
    assert rates[0, "arc"] == pytest.approx([K * LINE_LOAD], rel=3e-4)
    assert state.volumes[0, "arc"] == pytest.approx(K * LINE_LOAD * TURN * RADIUS, rel=3e-4)
    assert state.volumes[1, "near"] == pytest.approx(3.0 * K * LINE_LOAD * TURN * RADIUS, rel=3e-4)
    assert study.areas[0] == pytest.approx(TURN * RADIUS, rel=1e-9)


def test_plane_belt_wears_along_its_whole_length() -> None:
    """Problem: a belt of length l = |translation| slides past a cylinder, 2D, at an angle to the axes as made. Exact:
    all along, it loses (K₂/H) F' in a cycle; the cylinder (K₁/H) F' l in place."""
    R, length = np.array([[0.6, -0.8], [0.8, 0.6]]), 250.0
    pin, slab = cylinder(8.0, material=SOFT).bodies
    slab = replace(slab, mesh=replace(slab.mesh, points=slab.mesh.points @ np.pad(R, (0, 1))))
    step = Step(placements=(Placement.at_rest(2), Placement(R, np.zeros(2))))
    cycle = Cycle((step,), (Travel(1, translation=(length, 0.0, 0.0)),))
    study = WearStudy(replace(cylinder(8.0), bodies=(pin, slab)), (Archard(K, 3.0 * K),), cycle)
    state = fresh(study)
    certified(study, state)
    assert study.by_side(state.rate)[1, "near"] == pytest.approx([3.0 * K * LINE_LOAD], rel=3e-4)
    assert state.volumes[0, "arc"] == pytest.approx(K * LINE_LOAD * length, rel=3e-4)


def in_strips(study: WearStudy, state: CycleState, strips: Floats) -> tuple[Floats, Floats]:
    """Volumes of the track and of the contact's points, K/H ∫∫p|v_s|, between ascending c of the strips' ends."""
    track, own = study.tracks[RING], state.contacts[0][0]
    fine = np.linspace(track.grid[0], track.grid[-1], 10001)
    middle, step = 0.5 * (fine[1:] + fine[:-1]), fine[1] - fine[0]
    depth, length = (np.interp(middle, track.grid, v) for v in (study.by_side(state.rate)[RING], track.lengths))
    lost = np.histogram(middle, strips, weights=depth * length * step)[0]
    c = track.coordinate.at(own.result.points)
    taken = np.histogram(c, strips, weights=study.laws[0].second * own.work)[0]
    return lost, taken


@pytest.mark.parametrize(("travel", "friction", "order"), CASES)
def test_track_loses_what_passes_over_it(travel: Travel, friction: float, order: int) -> None:
    """Problem: a square punch on a rotating disc, and on a belt that slides along its side and at an angle. Exact: at c
    the track loses (K/H)∫p along the path, so a strip between two c loses the wear of the points that pass over it, for
    any p; within 3 % in strips a third of the punch wide, as hat functions smooth over one cell. In all the volume is
    (K/H)∫∫p|v_s|."""
    study = WearStudy(punch(order, friction), (Archard(K, 2.0 * K),), Cycle(travel=(travel,)))
    state = fresh(study)
    certified(study, state)
    c = study.tracks[RING].coordinate.at(state.contacts[0][0].result.points)
    ends = np.linspace(c.min(), c.max(), 4) + np.array([-0.26, 0.0, 0.0, 0.26])  # beside the edge a cell's width, too
    lost, taken = in_strips(study, state, ends)
    assert lost == pytest.approx(taken, rel=0.03)
    assert state.volumes[RING] == pytest.approx(2.0 * state.volumes[PIN], rel=1e-9)


def test_depth_across_a_belt_integrates_to_the_load() -> None:
    """Problem: a belt of length l = |translation| slides under a square punch. Exact: its depth integrated across the
    path is (K/H) F for any pressure, and more than a cell beside the punch it is zero."""
    study = WearStudy(punch(), (Archard(0.0, K),), Cycle(travel=(BELT,)))
    rate, track = study.by_side(fresh(study).rate)[RING], study.tracks[RING]
    assert track.areas.sum() == pytest.approx(60.0 * 4.0, rel=1e-12)
    assert rate @ track.areas / 60.0 == pytest.approx(K * LOAD, rel=1e-9)
    beside = np.abs(track.grid) > 0.5 * PUNCH + 0.26
    assert beside.any() and not rate[beside].any()


def test_rate_of_the_unworn_pin_is_independent_of_the_disc() -> None:
    """Problem: the first cycle, with no wear yet. Exact: the pin's rate is the same for any K/H of the disc."""
    cycle = Cycle(travel=(DISC,))
    rates = []
    for second in (0.0, 5.0 * K):
        study = WearStudy(punch(), (Archard(K, second),), cycle)
        rates.append(study.by_side(fresh(study).rate)[PIN])
    np.testing.assert_allclose(rates[1], rates[0], rtol=1e-12)


def test_track_of_a_placed_body_is_that_of_the_body_as_made() -> None:
    """Problem: disc and axis are made 3 mm aside and turned by 90°, and the step places them under the pin. Exact: the
    same depth over the radius."""
    plain = WearStudy(punch(), (Archard(0.0, K),), Cycle(travel=(DISC,)))
    R, shift = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), np.array([3.0, 0.0, 0.0])
    pin, disc = punch().bodies
    disc = replace(disc, mesh=replace(disc.mesh, points=disc.mesh.points @ R + shift))
    step = Step(placements=(Placement.at_rest(3), Placement(R, -R @ shift)))
    moved = WearStudy(replace(punch(), bodies=(pin, disc)), (Archard(0.0, K),), Cycle((step,), (DISC,)))
    np.testing.assert_allclose(moved.tracks[RING].grid, plain.tracks[RING].grid, rtol=1e-12)
    np.testing.assert_allclose(fresh(moved).rate, fresh(plain).rate, rtol=1e-6, atol=1e-6 * fresh(plain).rate.max())


def test_track_on_the_side_of_a_cylinder() -> None:
    """Problem: a plane at the radius R of a far axis, extended along it. Exact: c is the place along the axis, and the
    ring is 2πR long everywhere."""
    strip = surface_of(box((1e-3, 2.0, 1.0), (1, 8, 2), 1, origin=(-5e-4, 0.0, -1.0)), "top")
    track = track_of(strip, Travel(0, rotation=(0.0, 1.0, 0.0), centre=(0.0, 0.0, -RADIUS)))
    assert (track.grid[0], track.grid[-1]) == (0.0, 2.0)
    assert track.lengths == pytest.approx(TURN * RADIUS, rel=1e-6)


@pytest.mark.parametrize(
    ("travel", "found"),
    [
        (replace(DISC, translation=(1.0, 0.0, 0.0)), "found both"),
        (Travel(1), "found neither"),
        (Travel(1, rotation=(TURN, 0.0, 0.0)), "4 mm wide that leaves it by 2"),
        (Travel(1, translation=(0.0, 0.0, 1.0)), "4 mm wide that leaves it by 4"),
    ],
)
def test_travel_without_a_track_is_refused(travel: Travel, found: str) -> None:
    """Rotation and translation at once, neither, an axis in the surface, and a path out of it are refused."""
    with pytest.raises(ValueError, match=found):
        WearStudy(punch(), (Archard(K, K),), Cycle(travel=(travel,)))


def test_surface_off_its_track_is_refused() -> None:
    """A rotating sphere, a wheel that turns about another axis than its own, and two travels of one body are
    refused."""
    ball = surface_of(ring_sphere(RADIUS, 3.0, 3.0, 1.0, 0.5, 1.5), "arc")
    with pytest.raises(ValueError, match="wanted a surface that stays on its own track"):
        track_of(ball, Travel(0, rotation=(0.0, 0.0, TURN)))
    aside = Travel(0, rotation=(0.0, 0.0, TURN), centre=(0.1, RADIUS, 0.0))
    with pytest.raises(ValueError, match="wanted a surface that stays on its own track"):
        WearStudy(cylinder(3.0), (Archard(K),), Cycle(travel=(aside,)))
    with pytest.raises(ValueError, match="wanted one travel of a body that wears, found 2"):
        WearStudy(punch(), (Archard(K, K),), Cycle(travel=(DISC, DISC)))


@pytest.mark.parametrize(("travel", "off"), [(BELT, 0.01), (DISC, 0.1)])
def test_mesh_follows_the_depth_of_its_track(travel: Travel, off: float) -> None:
    """Problem: the mesh moves down by the depth of its track. Exact: it loses the integral of its nodal depth within
    0.1 %. The contact is the same as with the depth in the gap, as far as the mesh resolves the track: whole rows of
    nodes lie on the belt's grid, none on the disc's, whose depth ends within a cell beside the punch; the pressure has
    changed by a third."""
    study = WearStudy(punch(), (Archard(K, 40.0 * K),), Cycle(travel=(travel,)))
    new = fresh(study)
    depth = 60.0 * new.rate
    gap, before = study.evaluate(depth), study.geometry.problem.bodies[1].mesh
    surface = surface_of(before, "top")
    nodal = study.tracks[RING].hats(surface.points) @ study.by_side(depth)[RING]
    study.update_meshes(depth)
    followed, after = study.evaluate(depth), study.geometry.problem.bodies[1].mesh
    assert mesh_volume(before) - mesh_volume(after) == pytest.approx(surface.weights() @ nodal, rel=1e-3)
    volume = study.areas @ gap.rate
    assert study.areas @ np.abs(gap.rate - new.rate) > 0.1 * volume
    assert study.areas @ np.abs(followed.rate - gap.rate) < off * volume


def test_implicit_and_explicit_blocks_of_pin_and_disc_agree() -> None:
    """Problem: pin and disc wear in explicit blocks at 0.5 %, and in implicit ones at 1 % and at 0.25 %. Every block's
    volumes are certified, and with the tolerance the final depths of the implicit blocks converge to those of the
    explicit ones, from within 5 % to within 1.5 % of the volume."""
    depths = []
    for implicit, tolerance in ((False, 0.005), (True, 0.01), (True, 0.0025)):
        study = WearStudy(punch(), (Archard(K, 6.0 * K),), Cycle(travel=(DISC,)))
        blocks = list(study.blocks(400.0, BlockSettings(1.0, tolerance, implicit)))
        assert len(blocks) > 5
        for block in blocks:
            certified(study, block.state.evaluation)
        depths.append(blocks[-1].state.depth)
    off = [study.areas @ np.abs(depth - depths[0]) / (study.areas @ depths[0]) for depth in depths]
    assert off[1] < 0.05 and off[2] < min(0.015, 0.5 * off[1])


def test_worn_belt_tends_to_a_uniform_rate() -> None:
    """Problem: only the belt wears, until its rate is uniform under the punch. Exact: (K/H) F/b over the width b, where
    the rate of an unworn belt varies by a fifth; within 3 % except for the cells at the edges."""
    study = WearStudy(punch(), (Archard(0.0, 10.0 * K),), Cycle(travel=(BELT,)))
    *_, block = study.blocks(1e4, BlockSettings(20.0, 0.01))
    inside = np.abs(study.tracks[RING].grid) < 0.5 * PUNCH - 1e-9
    first, last = (state.rate[inside] / (10.0 * K * LOAD / PUNCH) for state in (fresh(study), block.state.evaluation))
    assert np.abs(first / first.mean() - 1.0).max() > 0.1
    assert np.abs(last / last.mean() - 1.0).max() < 0.03
