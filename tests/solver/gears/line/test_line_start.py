"""Positions of the resolved contact that start from line contact: the same results, in fewer iterations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.contact.newton.equilibrium import frictionless, normal_part
from evolvent.dynamics.excitation.loaded_mesh import searched_positions, under_torques
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.line import line_start
from evolvent.gears.line.line_start import LineStart, LineStarts, with_line_starts
from evolvent.gears.sweep import position_search
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import few_cells, helical_scene, model_of, spur_scene

ANGLE = 0.03
RELIEVED = tuple(
    f"{gear}.{key}" for gear in ("pinion", "wheel") for key in ("tip_relief_um=20", 'tip_relief_form="parabolic"')
)
IN_LEVELS = (*RELIEVED, "mesh.order=2", "load.torque_Nm=40", "contact.friction=0")


def position(model: GearModel, angle: float = ANGLE) -> SharedPosition:
    """A position without one before it."""
    return shared_position(model, angle, (0.0, 0.0), [0.0], None, exact=True)


def transmission_error(model: GearModel, found: SharedPosition) -> float:
    """Transmission error of a position [mm]."""
    return found.contact.stand.turned(model.load.on, float(found.smooth.motion[0])).transmission_error


@cache
def spur(*settings: str) -> GearModel:
    """He's pair in the plane, its positions with starts."""
    return with_line_starts(model_of(spur_scene("mesh.level=quick", *settings)))


@cache
def in_levels() -> GearModel:
    """A helical pair whose flanks have 6 × 2 coarse cells and a finer level, its positions with starts."""
    return with_line_starts(prepare_model(gear_problem(helical_scene(*IN_LEVELS)), MPI.COMM_SELF, few_cells).model)


def without(model: GearModel) -> GearModel:
    """Condensed gears whose positions have no starts."""
    return replace(model, starts=None)


def start_of(model: GearModel, angle: float = ANGLE) -> LineStart:
    """The start of a position, which has one."""
    assert isinstance(model.starts, LineStarts)
    found = model.starts(model, angle)
    assert found is not None
    return found


def counted(monkeypatch: pytest.MonkeyPatch, name: str) -> list[object]:
    """Results of the calls of a function of `position_search` from now on."""
    results: list[object] = []
    function: Callable[..., object] = getattr(position_search, name)

    def called(*arguments: object, **options: object) -> object:
        results.append(function(*arguments, **options))
        return results[-1]

    monkeypatch.setattr(position_search, name, called)
    return results


@pytest.mark.parametrize("make", [lambda: spur(*RELIEVED), in_levels])
@pytest.mark.parametrize("share", [0.1, 1.0])
def test_result_is_that_without_a_start(make: Callable[[], GearModel], share: float) -> None:
    """Problem: a relieved spur pair in the plane and a helical pair with flanks in levels, a tenth of the torque and
    all of it. Exact: the equilibrium that is found from the nominal contact lines, to 1e-8; the start's transmission
    error is within 10 % of it, as few coarse cells carry the loads of the helical pair."""
    whole = make()
    model = under_torques(whole, [share * whole.load.torque * whole.width_factor])[0]
    found, wanted = position(model), position(without(model))
    error = transmission_error(model, wanted)
    assert found.searched == wanted.searched
    assert transmission_error(model, found) == pytest.approx(error, rel=1e-8)
    assert found.smooth.traction == pytest.approx(wanted.smooth.traction, abs=1e-6 * wanted.smooth.traction.max())
    assert start_of(model).result.transmission_error == pytest.approx(error, rel=0.1)


@pytest.mark.parametrize("make", [lambda: spur(*RELIEVED), in_levels])
def test_newton_needs_fewer_steps(make: Callable[[], GearModel]) -> None:
    """Problem: four positions of the pairs above, one and the same system each. From the points that bear in line
    contact Newton's method takes at most 7 iterations, and in sum at most two thirds of those from the nominal lines
    (Yang's pair: docs/line_contact.md)."""
    model = make()
    from_line, from_nominal = list[int](), list[int]()
    for angle in 2.0 * np.pi / model.pair.pinion.z * np.arange(4) / 4:
        here = position(without(model), float(angle))
        system, guess = normal_part(here.system), start_of(model, float(angle))
        for counts, start in ((from_line, guess), (from_nominal, None)):
            pressed = position_search._initially_pressed(here.contact.geometry, None, start)
            counts.append(frictionless(system, pressed).iterations)
    assert max(from_line) <= 7
    assert sum(from_line) <= 2 / 3 * sum(from_nominal)


def test_search_is_made_once_and_wide_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: a window of half of the contact's width, which fits when it was widened twice. With the start the flanks
    are searched once, in the window that is found in some searches without it."""
    model = replace(spur(*RELIEVED), half_width=0.6 * start_of(spur(*RELIEVED)).reach)
    searches = counted(monkeypatch, "facing_flanks")
    wanted = position(without(model))
    assert len(searches) > 2
    searches.clear()
    assert position(model).searched == wanted.searched
    assert len(searches) == 1


def test_positions_in_the_plane_start_from_the_one_before() -> None:
    """In the plane only the first of some positions, in space each one is started from line contact."""
    assert [started(spur(*RELIEVED)), started(in_levels())] == [1, 3]


def started(model: GearModel) -> int:
    """How many of three positions of a sweep ask for a start."""
    asked: list[float] = []

    def recorded(_: GearModel, angle: float) -> LineStart:
        asked.append(angle)
        return start_of(model, angle)

    for _ in searched_positions([replace(model, starts=recorded)], ANGLE + 1e-3 * np.arange(3)):
        pass
    return len(asked)


def test_edges_and_wear_have_no_start() -> None:
    """Where the edge of a tip bears, and on flanks that have worn since they were condensed, positions are found
    without a start, as those of the same gears without starts."""
    unrelieved = spur()
    angles = 2.0 * np.pi / 50.0 * np.arange(12) / 12
    assert unrelieved.starts is not None
    on_edge = [float(angle) for angle in angles if unrelieved.starts(unrelieved, float(angle)) is None]
    assert on_edge
    found, wanted = position(unrelieved, on_edge[0]), position(without(unrelieved), on_edge[0])
    assert np.array_equal(found.smooth.motion, wanted.smooth.motion)
    relieved = spur(*RELIEVED)
    pinion, wheel = relieved.bodies
    worn = replace(relieved, bodies=(replace(pinion, worn=np.full(len(pinion.flank.points), 1e-4)), wheel))
    assert worn.starts is not None
    assert worn.starts(worn, ANGLE) is None


def test_measured_flanks_have_starts() -> None:
    """Problem: a spur pinion with a flank that is 2 µm thinner everywhere, as measured. Exact: its transmission error
    is 2 µm larger than that without, in line contact as resolved."""
    plain = spur(*RELIEVED)
    pinion, wheel = plain.bodies
    depth = 2e-3
    chart = _Even(depth)
    bodies = replace(pinion, worn=np.full(len(pinion.flank.points), depth)), wheel
    thinner = with_line_starts(replace(without(plain), bodies=bodies, charts=(chart, None)))  # type: ignore[arg-type]
    difference = start_of(thinner).result.transmission_error - start_of(plain).result.transmission_error
    assert difference == pytest.approx(depth, rel=1e-6)
    assert transmission_error(thinner, position(thinner)) == pytest.approx(
        transmission_error(plain, position(plain)) + depth, rel=1e-4
    )


class _Even:
    """A chart of one depth everywhere."""

    varies_over_the_face = False

    def __init__(self, depth: float) -> None:
        self.depth = depth

    def at(self, _: object, roll_length: Floats, __: object) -> Floats:
        return np.full(len(roll_length), self.depth)


def test_gears_that_cannot_carry_lines_have_no_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Gears for line contact, with cells of first order, of whole rings, and with more nodes on a flank than are
    allowed are returned as they are."""
    ring = "mesh.elements_per_contact_width=0.5", 'exact.parts=["one-sector"]'
    for settings in (("mesh.level=line",), ("mesh.order=1",), ring):
        model = model_of(spur_scene(*settings))
        assert with_line_starts(model) is model
    assert in_levels().bodies[Member.PINION].flank.points.shape[0] > 200
    monkeypatch.setattr(line_start, "MOST_NODES", 200)
    assert with_line_starts(without(in_levels())).starts is not None  # the coarse sector's flank carries the loads
    monkeypatch.setattr(line_start, "MOST_NODES", 20)
    assert with_line_starts(without(in_levels())).starts is None
