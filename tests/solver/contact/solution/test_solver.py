"""The public API: steps, sweeps, placements, several contacts, refused steps; and the page that describes it."""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from evidence.verification.references.full_system import full_solution
from evolvent import (
    Body,
    Contact,
    Fixed,
    Freedom,
    Material,
    NotConverged,
    Placement,
    Problem,
    Rigid,
    SearchError,
    Solution,
    Step,
    Sweep,
    Traction,
    reactions,
    read_msh,
    solve,
    sweep,
)
from evolvent_meshes.shapes.blocks import rectangle
from tests.support.checkout import ROOT
from tests.support.contact_cases import FRICTION, cylinder
from tests.support.meshes.overlapping_groups import HEIGHT, WIDTH, write_overlapping


@pytest.mark.parametrize("version", [4.1, 2.2])
def test_body_of_a_mesh_whose_entities_are_in_two_groups(version: float, tmp_path: Path) -> None:
    """Problem: 100 N/mm over a width of 10 mm press a block 3 mm high onto one of 5 mm, which gmsh has meshed, with
    entities in two groups: MSH 2.2 has their elements twice. ν = 0. Exact: a motion of −10·(5 + 3)/210e3 mm, a force of
    100 N/mm."""
    write_overlapping(tmp_path / "block.msh", version)
    material, load = Material(210e3, 0.0), Rigid("top", (Freedom("y", load=-100.0),))
    low = Body(read_msh(tmp_path / "block.msh"), material, (Fixed("held"),), name="low")
    up = Body(rectangle(WIDTH, 3.0, 10, 3, origin=(0.0, HEIGHT)), material, (), rigid=load, name="up")
    solution = solve(Problem((low, up), (Contact((0, "top"), (1, "bottom")),)))
    assert solution.motions[1] == pytest.approx([-10.0 * (HEIGHT + 3.0) / 210e3], rel=1e-9)
    assert solution.contacts[0].force == pytest.approx([0.0, 100.0], abs=1e-7)


def test_programs_of_the_page_on_own_problems_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The programs in docs/own_problem.md run as they stand; the first one has at most 40 lines and carries its load,
    and the peak that it prints is within 0.2 % of that of a mesh ten times as fine, 2275.4 MPa; the ground carries what
    the contact gives, and ParaView's files are there; UFL finds the strain energy of a slab that dolfinx has meshed,
    p²(1 − ν²)/2E times its area."""
    text = (ROOT / "docs/own_problem.md").read_text()
    first, second, third = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(first.strip().splitlines()) <= 40
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(compile(first, "own_problem.md", "exec"), names)
    force = names["solution"].contacts[0].force
    assert force[1] == pytest.approx(-names["LOAD"], rel=1e-8)
    assert names["contact"].pressure.max() == pytest.approx(2275.4, rel=2e-3)
    assert f"{names['contact'].pressure.max():,.0f} MPa" in text
    exec(compile(second, "own_problem.md", "exec"), names)
    assert names["share"] == 1.0
    assert names["bottom"].force[1] == pytest.approx(names["LOAD"], rel=1e-8)
    assert len(list((tmp_path / "out").glob("*.vtu"))) == 3 * len(names["solutions"])
    exec(compile(third, "own_problem.md", "exec"), names)
    assert names["energy"] == pytest.approx(100.0**2 * (1.0 - 0.3**2) / (2.0 * 210e3) * 200.0, rel=1e-10)


def test_page_on_own_problems_lists_every_public_name() -> None:
    """The tables of docs/own_problem.md have every public name."""
    text = (ROOT / "docs/own_problem.md").read_text()
    rows = "\n".join(line.split("|")[1] for line in text.splitlines() if line.startswith("|"))
    assert [name for name in importlib.import_module("evolvent").__all__ if f"`{name}" not in rows] == []


def test_surfaces_out_of_reach_are_refused() -> None:
    """Two blocks 1 mm apart, and a reach of 0.1 mm: SearchError, with both surfaces and what to do."""
    upper, lower = rectangle(2.0, 1.0, 4, 2, origin=(0.0, 1.0)), rectangle(2.0, 1.0, 5, 2, origin=(0.0, -1.0))
    bodies = Body(upper, rigid=Rigid("top", (Freedom("y", load=-1.0),))), Body(lower, supports=(Fixed("bottom"),))
    problem = Problem(bodies, (Contact((0, "bottom"), (1, "top"), reach=0.1),))
    with pytest.raises(SearchError, match=r"'bottom' of body 0 and 'top' of body 1: wanted .* 0\.1 mm.*found none"):
        solve(problem)


def test_load_factor_scales_a_closed_contact() -> None:
    """Two flat blocks that stay in full contact are linear: half the load, half the pressure and displacement."""
    problem = _flat()
    half, full = list(sweep(problem, [Step(0.5), Step(1.0)]))
    assert np.allclose(2.0 * half.contacts[0].pressure, full.contacts[0].pressure, rtol=1e-9)
    assert np.allclose(2.0 * half.displacement(0), full.displacement(0), atol=1e-12)


def test_load_and_displacement_give_the_same_contact() -> None:
    """Prescribing the motion that resulted from a load gives that load, also in a later step of the same sweep."""
    problem = cylinder(0.0)
    by_load = solve(problem)
    sunk = float(by_load.motions[0][0])
    _, by_motion = sweep(problem, [Step(), Step(freedoms=((0, Freedom("y", displacement=sunk)),))])
    assert by_motion.contacts[0].force[1] == pytest.approx(-5e3, rel=1e-8)
    assert np.allclose(by_motion.contacts[0].pressure, by_load.contacts[0].pressure, atol=1e-6)


def test_iterations_include_those_of_the_frictionless_start() -> None:
    """With friction the iterations are those of the frictionless start, the same as without, and at least one more."""
    assert solve(cylinder(FRICTION)).iterations > solve(cylinder(0.0)).iterations > 0


def test_tangential_load_after_the_normal_load_makes_partial_slip() -> None:
    """First pressed, then pushed with half of what slides: the tangential load arrives, some points stick and some
    slide. Repeating the same step moves the cylinder by less than a thousandth of what the push did; the traction near
    the edge of sticking, a kink that the stored nodal history cannot follow, moves by some per cent at a/3."""
    problem = cylinder(FRICTION, first=1, extra=(Freedom("x", displacement=0.0),))
    push = Step(freedoms=((0, Freedom("x", load=0.5 * FRICTION * 5e3)),))
    pressed, pushed, again = sweep(problem, [Step(), push, push])
    assert pushed.contacts[0].force[0] == pytest.approx(-0.5 * FRICTION * 5e3, rel=1e-9)
    assert pushed.contacts[0].force[1] == pytest.approx(5e3, rel=1e-9)
    contact = pushed.contacts[0]
    shear = np.abs(contact.traction[:, 0])
    touching = contact.pressure > 0.0
    sticks = shear < FRICTION * contact.pressure * (1.0 - 1e-9)
    assert (touching & sticks).any()
    assert (touching & ~sticks).any()
    assert pushed.motions[0][1] > pressed.motions[0][1]
    assert again.motions[0][1] == pytest.approx(pushed.motions[0][1], rel=1e-3)
    change = np.linalg.norm(again.contacts[0].traction - contact.traction, axis=1)
    assert contact.weights @ change**2 < 0.05**2 * (contact.weights @ (FRICTION * contact.pressure) ** 2)


def test_friction_reverses_when_a_sliding_block_returns() -> None:
    """The lower block moved to the right and back under the pressed cylinder: friction μP to the right, then to the
    left. A solver that forgets the last step, or loses μ, cannot do this."""
    problem = cylinder(FRICTION, first=1, extra=(Freedom("x", displacement=0.0),))
    places = [(Placement.at_rest(2), Placement(np.eye(2), np.array([x, 0.0]))) for x in (0.0, 0.5, 0.2)]
    forces = [s.contacts[0].force[0] for s in sweep(problem, [Step(placements=p) for p in places])]
    assert forces[1] == pytest.approx(FRICTION * 5e3, rel=1e-6)
    assert forces[2] == pytest.approx(-FRICTION * 5e3, rel=1e-6)


def test_contact_does_not_depend_on_the_common_frame() -> None:
    """Both bodies rotated and translated together: the same pressure, and the traction rotated."""
    problem = cylinder(FRICTION)
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    place = Placement(turn, np.array([5.0, -3.0]))
    here, there = solve(problem), solve(problem, Step(placements=(place, place)))
    assert np.allclose(here.contacts[0].pressure, there.contacts[0].pressure, atol=1e-7)
    assert np.allclose(here.contacts[0].traction @ turn.T, there.contacts[0].traction, atol=1e-7)


def test_two_contacts_share_the_load() -> None:
    """A stack of three blocks: both interfaces transmit the whole load, one with friction and one without."""
    blocks = [rectangle(2.0, 1.0, n, 2, origin=(0.0, y)) for n, y in ((4, 2.0), (5, 1.0), (3, 0.0))]
    bodies = (
        Body(blocks[0], supports=(Fixed("left", "x"),), loads=(Traction("top", (0.0, -60.0)),)),
        Body(blocks[1], supports=(Fixed("left", "x"),)),
        Body(blocks[2], supports=(Fixed("left", "x"), Fixed("bottom", "y"))),
    )
    contacts = (Contact((0, "bottom"), (1, "top"), 0.2, reach=0.1), Contact((1, "bottom"), (2, "top"), 0.0, reach=0.1))
    solution = solve(Problem(bodies, contacts))
    for contact in solution.contacts:
        assert np.allclose(contact.pressure, 60.0, rtol=1e-9)


def test_lifted_part_of_an_interface_has_no_tension() -> None:
    """Only part of a tilted load's interface touches: no tension anywhere, the rest of the load where it touches.

    A block 2 wide and 4 high pushed at its top to the side lifts off on one edge."""
    lower, upper = rectangle(2.0, 1.0, 8, 4), rectangle(2.0, 4.0, 6, 12, origin=(0.0, 1.0))
    bodies = (
        Body(upper, loads=(Traction("top", (12.0, -60.0)),)),
        Body(lower, supports=(Fixed("bottom"),)),
    )
    solution = solve(Problem(bodies, (Contact((0, "bottom"), (1, "top"), 0.5, reach=0.1),)))
    contact = solution.contacts[0]
    assert contact.pressure.min() == 0.0
    assert contact.force == pytest.approx([24.0, -120.0], rel=1e-8)
    assert _centre(solution, 1) == pytest.approx(1.0 + 24.0 * 4.0 / 120.0, abs=1e-9)


def _centre(solution: Solution, body: int) -> float:
    """x of the resultant contact force on a flat body, from its nodal forces (half a hat function at an edge acts
    inside the edge node, so the nodal pressures alone would not do)."""
    condensed = solution.condensed[body]
    force = (condensed.test_functionals.T @ solution.nodal_forces[body]).reshape(-1, 2)[:, 1]
    return float(force @ condensed.assembled.body.mesh.points[:, 0] / force.sum())


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda p: Problem(p.bodies, (Contact((0, "arc"), (2, "top")),)), "below 2"),
        (lambda p: Problem(p.bodies, (Contact((0, "ark"), (1, "top")),)), "ark"),
        (lambda p: Problem((*p.bodies, p.bodies[1]), p.contacts), r"found 1 and none for body 2 \('body'\); add"),
        (lambda p: Problem(p.bodies, ()), "found 0 and none for body 0"),
        (lambda p: Problem((), ()), "at least one contact"),
        (lambda p: solve(p, Step(freedoms=((0, Freedom("x", load=1.0)),))), "declare"),
        (lambda p: solve(p, Step(freedoms=((7, Freedom("y", load=1.0)),))), "below 2"),
    ],
)
def test_inconsistent_steps_are_refused(make: Callable[[Problem], object], message: str) -> None:
    """Each mistake is a ValueError that names what was found."""
    with pytest.raises(ValueError, match=message):
        make(cylinder())


def test_rigid_coupling_rotates_about_its_centre() -> None:
    """A moment about the coupling's centre tilts a punch: the pressure's centre moves by moment over force."""
    punch = rectangle(2.0, 1.0, 6, 3, origin=(-1.0, 0.0))
    ground = rectangle(6.0, 3.0, 24, 6, origin=(-3.0, -3.0))
    rigid = Rigid("top", (Freedom("y", load=-1000.0), Freedom("rz", load=-150.0)), centre=(0.0, 1.0, 0.0))
    problem = Problem(
        (Body(punch, rigid=rigid), Body(ground, supports=(Fixed("bottom"),))),
        (Contact((0, "bottom"), (1, "top"), reach=0.2),),
    )
    solution = solve(problem)
    assert _centre(solution, 1) == pytest.approx(0.15, rel=1e-8)
    assert solution.contacts[0].force[1] == pytest.approx(-1000.0, rel=1e-9)


def test_sweep_continues_after_a_step_that_failed() -> None:
    """A cylinder is pressed, then pushed by more than friction can hold: that step has no equilibrium, and the error
    says so. The same sweep then solves a smaller push with the result of a sweep without the failure, slip included."""
    problem = cylinder(FRICTION, first=1, extra=(Freedom("x", displacement=0.0),))

    def push(share: float) -> Step:
        return Step(freedoms=((0, Freedom("x", load=share * FRICTION * 5e3)),))

    run, plain = Sweep(problem), Sweep(problem)
    for each in (run, plain):
        each.solve(Step())
    with pytest.raises(NotConverged, match=r"no equilibrium.*more than μ times.*prescribe that motion"):
        run.solve(push(1.5))
    assert run.solved == plain.solved == 1
    after, wanted = run.solve(push(0.5)), plain.solve(push(0.5))
    assert np.allclose(after.contacts[0].traction, wanted.contacts[0].traction, atol=1e-6 * 1375.0)
    assert after.motions[0][1] == pytest.approx(wanted.motions[0][1], rel=1e-8)
    assert run.solved == 2


def test_every_step_logs_one_line(caplog: pytest.LogCaptureFixture) -> None:
    """One line a step on the logger "evolvent": number, load factor, iterations, force and peak pressure."""
    with caplog.at_level("INFO", logger="evolvent"):
        first, _ = sweep(_flat(), [Step(0.5), Step(1.0)])
    lines = [record.getMessage() for record in caplog.records if record.name == "evolvent"]
    assert len(lines) == 2
    assert lines[0] == f"step 1: load factor 0.5, {first.iterations} iterations, contact 100 N/mm at up to 50 MPa"
    assert lines[1].startswith("step 2: load factor 1, ")


def test_prescribed_displacement_of_a_face_gives_uniaxial_strain() -> None:
    """Two blocks of height h each pressed by moving the top: uniaxial strain under rollers on all sides,
    p = E(1−ν)/((1+ν)(1−2ν)) δ/2h, and the reactions at the moved face and at the bottom are p times the width."""
    upper, lower = rectangle(2.0, 1.0, 4, 2, origin=(0.0, 1.0)), rectangle(2.0, 1.0, 5, 2)
    rolls = (Fixed("left", "x"), Fixed("right", "x"))
    bodies = (
        Body(upper, supports=(*rolls, Fixed("top", "y", -0.003))),
        Body(lower, supports=(*rolls, Fixed("bottom", "y"))),
    )
    problem = Problem(bodies, (Contact((0, "bottom"), (1, "top"), reach=0.1),))
    half, whole = sweep(problem, [Step(0.5), Step()])
    p = 210e3 * 0.7 / (1.3 * 0.4) * 0.003 / 2.0
    assert np.allclose(half.contacts[0].pressure, 0.5 * p, rtol=1e-9)
    assert np.allclose(whole.contacts[0].pressure, p, rtol=1e-9)
    assert np.allclose(whole.displacement(0)[np.unique(upper.facets["top"]), 1], -0.003, rtol=1e-12)
    moved, bottom = reactions(whole, 0)[2].force, reactions(whole, 1)[2].force
    assert moved == pytest.approx([0.0, -2.0 * p], rel=1e-9, abs=1e-9)
    assert bottom == pytest.approx([0.0, 2.0 * p], rel=1e-9, abs=1e-9)


def test_prescribed_displacement_agrees_with_the_full_system() -> None:
    """The same on all degrees of freedom (full_system.py), with friction and a clamped bottom: the same motion."""
    upper, lower = rectangle(2.0, 1.0, 4, 2, origin=(0.0, 1.0)), rectangle(2.0, 1.0, 5, 2)
    bodies = (
        Body(upper, supports=(Fixed("left", "x"), Fixed("top", "y", -0.003))),
        Body(lower, Material(70e3, 0.3), (Fixed("bottom"),)),
    )
    problem = Problem(bodies, (Contact((0, "bottom"), (1, "top"), 0.2, reach=0.1),))
    x, _ = full_solution(problem, Step())
    solution = solve(problem)
    free = solution.condensed[0].assembled.free
    condensed = solution.condensed[0].deformation(solution.nodal_forces[0], 1.0)
    assert np.allclose(x[: len(free)], condensed[free], atol=1e-9 * np.abs(condensed).max())


def _flat() -> Problem:
    upper, lower = rectangle(2.0, 1.0, 4, 2, origin=(0.0, 1.0)), rectangle(2.0, 1.0, 5, 2)
    bodies = (
        Body(upper, supports=(Fixed("left", "x"),), loads=(Traction("top", (0.0, -100.0)),)),
        Body(lower, supports=(Fixed("left", "x"), Fixed("bottom", "y"))),
    )
    return Problem(bodies, (Contact((0, "bottom"), (1, "top"), reach=0.1),))
