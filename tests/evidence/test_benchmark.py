"""The benchmark's parts: what is compared must be the same problem, and the answer must be measured right. No times."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from evidence.benchmark.bars import BarRow
from evidence.benchmark.cases import cylinder, line_contact, sphere
from evidence.benchmark.gears import three_teeth
from evidence.benchmark.ours import solved
from evidence.benchmark.page import advantage, unmatched, write_page
from evidence.benchmark.peers.calculix import FACES, deck, element_faces
from evidence.benchmark.peers.surface import nodal_normals
from evidence.benchmark.pitch import PitchFacts
from evidence.benchmark.pitches import PitchRow, mean_error, one_position
from evidence.benchmark.precision import Row
from evidence.benchmark.pressure import Pressure, Reference
from evidence.benchmark.profile import PARTS, ProfileRow
from evidence.benchmark.programs import PEERS, solve
from evidence.benchmark.runs import Command, RunFailed, run
from evidence.benchmark.skips import SkipRow
from evidence.benchmark.spur import SpurRow
from evidence.benchmark.tables import read_rows, write_rows
from evidence.benchmark.task import Answer, Task
from evidence.benchmark.wear import BLOCKS, SMALL_CASES, WearCostRow, WearPrecisionRow, cost_rows, precision_rows
from tests.support.checkout import ROOT

LINE = line_contact()


def test_a_task_and_an_answer_survive_their_files(tmp_path: Path) -> None:
    """What is read is what was written: meshes, groups, supports."""
    task = sphere(2, 1, "tetrahedron")
    task.write(tmp_path / "task.npz")
    again = Task.read(tmp_path / "task.npz")
    assert (again.held, again.drive, again.contact) == (task.held, task.drive, task.contact)
    for one, other in zip(task.bodies, again.bodies):
        assert np.array_equal(one.cells, other.cells) and np.array_equal(one.points, other.points)
        assert one.facets.keys() == other.facets.keys()
    answer = Answer(1, np.arange(3.0), np.arange(3), iterations=4, seconds={"solve": 2.0})
    answer.write(tmp_path / "answer.npz")
    read = Answer.read(tmp_path / "answer.npz")
    assert (read.body, read.iterations, read.seconds, read.points) == (1, 4, {"solve": 2.0}, None)


@pytest.mark.parametrize(("task", "d"), [(cylinder(4, 2, "triangle"), 2), (sphere(2, 2, "hexahedron"), 3)])
def test_nodal_pressure_is_integrated_as_the_field_that_it_is(task: Task, d: int) -> None:
    """A parabola p = 300 − 100 (r/R)² at the nodes of the flat body, which order 2 represents: over the contact
    surface, |x| ≤ R or a quarter disc, ∫p = 2R (300 − 100/3) or π R²/4 (300 − 50); off itself by nothing."""
    mesh = task.bodies[1]
    nodes = np.unique(mesh.facets[task.contact[1]])
    radius = np.hypot(*mesh.points[nodes, : d - 1].T) if d == 3 else np.abs(mesh.points[nodes, 0])
    R = radius.max()
    found = Pressure.of(task, Answer(1, 300.0 - 100.0 * (radius / R) ** 2, nodes))
    exact = 2 * R * (300 - 100 / 3) if d == 2 else np.pi * R**2 / 4 * (300 - 50)
    assert found.force == pytest.approx(exact, rel=2e-3)
    assert found.value == pytest.approx(300.0 - 100.0 * (found.radius / R) ** 2, rel=2e-3)


def test_the_reference_is_found_again_from_its_own_points() -> None:
    """A smooth pressure √(1 − s)(c0 + c1 s) at points and with weights of a fine rule: the fit gives a, c0 and c1."""
    exact = Reference(0.51, (300.0, -20.0))
    radius = (np.arange(20000) + 0.5) * 0.6 / 20000
    for d in (2, 3):
        weights = np.full(len(radius), 2 * 0.6 / 20000) if d == 2 else np.pi / 2 * radius * 0.6 / 20000
        found = Reference.fitted(Pressure(radius, exact(radius), weights), 0.5, d)
        assert found.half_width == pytest.approx(0.51, rel=1e-4)
        assert found.coefficients == pytest.approx((300.0, -20.0), rel=2e-3)


def test_evolvent_solves_the_line_contact_of_the_benchmark() -> None:
    """Hertz: the peak of an ellipse with the force F of the solution is √(F E*/π R); a/R = 0.01, cells of a/4."""
    task = cylinder(4, 2, "quadrilateral")
    found = Pressure.of(task, solved(task))
    peak = LINE.peak * np.sqrt(found.force / (np.pi / 2 * LINE.peak * LINE.half_width))
    assert found.peak(LINE.half_width) == pytest.approx(peak, rel=0.005)


def test_three_teeth_are_one_body_each() -> None:
    """The copies of a sector are welded along their cuts: cells that share nodes connect all of a gear's mesh."""
    task = three_teeth(1.0)
    for mesh in task.bodies:
        first = np.repeat(mesh.cells[:, :1], mesh.cells.shape[1] - 1, axis=1).ravel()
        links = coo_matrix((np.ones(len(first)), (first, mesh.cells[:, 1:].ravel())), shape=2 * (len(mesh.points),))
        assert connected_components(links, directed=False)[0] == 1


@pytest.mark.parametrize("shape", ["quadrilateral", "triangle", "hexahedron", "tetrahedron"])
def test_calculix_gets_the_faces_of_the_contact(shape: str) -> None:
    """Every facet of the contact has one (cell, face), with the facet's own corners."""
    task = (cylinder if shape in ("quadrilateral", "triangle") else sphere)(4, 1, shape)
    for body, group in enumerate(task.contact):
        mesh = task.bodies[body]
        found = {frozenset(mesh.cells[c, list(FACES[shape][f])].tolist()) for c, f in element_faces(mesh, group)}
        assert found == {frozenset(nodes) for nodes in mesh.facets[group].tolist()}


def test_calculix_mortar_bears_one_support_a_contact_node() -> None:
    """With two, CalculiX 2.20 dies while factoring: a node of the slave's contact surface appears at most once."""
    task = sphere(4, 1, "hexahedron")
    slave = task.bodies[1]
    contact = {str(k + len(task.bodies[0].points) + 1) for k in np.unique(slave.facets[task.contact[1]])}

    def held(mortar: bool) -> list[str]:
        lines = list(deck(task, mortar))
        start = lines.index("*BOUNDARY")
        words = [line.split(",") for line in lines[start + 1 : lines.index("*SURFACE INTERACTION, NAME=PRESS")]]
        return [w[0] for w in words if len(w) == 3 and w[0] in contact]

    assert len(held(True)) == len(set(held(True))) == len(set(held(False))) < len(held(False))


def test_normals_of_the_ball_point_away_from_its_centre() -> None:
    """A sphere's outward normal is radial; nodal means on cells of a/4 are within 2 degrees of it."""
    task = sphere(4, 1, "hexahedron")
    nodes, normal = nodal_normals(task.bodies[0], "contact")
    radial = task.bodies[0].points[nodes] - [0.0, 0.0, 8.0]
    cosine = np.sum(normal * radial, axis=1) / np.linalg.norm(radial, axis=1)
    assert cosine.min() > np.cos(np.radians(2.0))


@pytest.mark.parametrize("program", PEERS, ids=lambda p: p.name)
def test_installed_peers_solve_the_same_problem(program, tmp_path: Path) -> None:
    """On the same coarse mesh, cells of a/8 (2D) or a/4 (3D) at order 1, a peer's force is Evolvent's within 3 % (a
    penalty of 1e7 N/mm³ takes 1 to 2 % of it) and its profile within 15 %: a wrong group, sign or unit is far off."""
    if not program.available():
        pytest.skip(f"{program.name} is not installed")
    task = sphere(4, 1, "hexahedron") if program.only and "mortar" in program.name else cylinder(8, 1, "quadrilateral")
    task.write(tmp_path / "task.npz")
    theirs = Pressure.of(task, solve(program, tmp_path / "task.npz", tmp_path).answer)
    ours = Pressure.of(task, solved(task))
    reference = Reference.fitted(ours, 0.5 if task.dimension == 2 else 0.47, task.dimension)
    assert theirs.force == pytest.approx(ours.force, rel=0.03)
    assert theirs.error(reference) < 0.15


def test_a_run_costs_what_its_process_takes(tmp_path: Path) -> None:
    """A process that holds 200 MB and spins half a second is told apart from one that does nothing; errors and time
    limits are said."""
    code = "x = bytearray(200_000_000); import time; e = time.process_time() + 0.5\nwhile time.process_time() < e: pass"
    busy = run(Command((sys.executable, "-c", code), tmp_path, tmp_path / "busy.log"))
    idle = run(Command((sys.executable, "-S", "-c", "pass"), tmp_path, tmp_path / "idle.log"))
    assert busy.cpu >= 0.5 > idle.cpu
    assert busy.memory_MB > 190 > 60 > idle.memory_MB
    with pytest.raises(RunFailed, match="exit code 3"):
        run(Command((sys.executable, "-c", "raise SystemExit(3)"), tmp_path, tmp_path / "bad.log"))
    words = sys.executable, "-c", "import time; time.sleep(60)"
    sleeping = Command(words, tmp_path, tmp_path / "long.log", time_limit=0.5)
    with pytest.raises(RunFailed, match="ended after"):
        run(sleeping)


def test_an_advantage_counts_only_at_no_larger_error(tmp_path: Path) -> None:
    """Evolvent's fast but coarse row may not beat a peer's better one; a peer that nobody matches is said so; rows
    survive their file."""

    def row(program: str, seconds: float, error: float, dofs: int = 50_000) -> Row:
        return Row("c", program, "quadrilateral", 2, 8, dofs, cpu=seconds, profile_error=error)

    rows = [row("Evolvent", 1.0, 0.05), row("Evolvent", 4.0, 0.01), row("GetFEM", 6.0, 0.02), row("GetFEM", 2.0, 0.06)]
    assert [ratio for *_, ratio in advantage(rows, 20_000)] == [1.5, 2.0]
    assert unmatched([*rows, row("Kratos", 9.0, 0.001)], 20_000)[0].program == "Kratos"
    assert not advantage([row("Evolvent", 1.0, 0.05), row("GetFEM", 6.0, 0.05, 10_000)], 20_000)
    write_rows(tmp_path / "rows.csv", rows)
    assert [r.cpu for r in read_rows(tmp_path / "rows.csv", Row)] == [1.0, 4.0, 6.0, 2.0]


def test_a_pitch_is_told_from_one_position() -> None:
    """Seconds of start 1, meshing 50, assembling 2, condensing 3 and positions 4, 5, 6 (again): one position takes
    1 + 2 + 3 + 4, the pitch 1 + 2 + 3 + 15; the mean of 7 and 9 mm is 8."""
    facts = PitchFacts(10, 1, 1.0, 50.0, 2.0, 3.0, (4.0, 5.0, 6.0), 2, (3, 3, 3), (7.0, 9.0), 100.0, 20.0)
    assert one_position(facts) == 10.0
    assert facts.without_meshing == 21.0
    assert facts.counted == 2
    assert mean_error(facts) == 8.0


def test_profiled_functions_are_there() -> None:
    """The profile looks functions up by file and name: one that was renamed would silently take no time."""
    solver = ROOT / "solver"
    for _, file, function in PARTS:
        tree = ast.parse((solver / file).read_text(encoding="utf-8"))
        assert function in {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}, (file, function)


def test_the_page_says_what_was_measured(tmp_path: Path) -> None:
    """Rows of every kind, in and out of their bars: the page holds ratios of the rows (30/10, 25/1, one of two inside),
    names the skip beyond its tolerance, and leaves out what was not measured."""
    nan = float("nan")
    rows = {
        "skips": [SkipRow("plane", "demos/a.toml", "", 10.0, 30.0, 100.0, 250.0, 1e-5, 1e-3),
                  SkipRow("window", "demos/a.toml", "", 10.0, 11.0, 100.0, 100.0, 1e-2, 1e-3)],
        "spur": [SpurRow(1.0, 0, 1.0, 100.0, 0.003, 1.0, 3, 25.0, 900.0, 0.002)],
        "bars": [BarRow("a", "peak", 0.1, 100.0, 2.0, 1.0, 0.1), BarRow("b", "peak", 0.1, 100.0, 2.0, 3.0, 0.1)],
        "wear_cost": [WearCostRow("spur", 1000, 1.0, 2.0, 8.0), WearCostRow("helical", 1000, 9.0, 1.0, 8.0)],
        "wear": [WearPrecisionRow("implicit", 0.05, 10, 0, 2.0, 0.02, -0.01),
                 WearPrecisionRow("explicit", 0.05, 30, 2, 4.0, 0.001, 0.001)],
        "profile": [ProfileRow("search", 1000, 4, 2.0, 0.25, 4), ProfileRow("everything else", 1000, 4, 6.0, 0.75, 1)],
        "pitches": [PitchRow("hexahedron", 2, 1, 0.5, 1000, 4, 5.0, 9.0, 14.0, 300.0, 0.01, 0.001),
                    PitchRow("hexahedron", 1, 1, 0.7, 0, 0, nan, nan, nan, nan, nan, nan, "killed")],
    }  # fmt: skip
    for name, own in rows.items():
        write_rows(tmp_path / "benchmark" / f"{name}.csv", own)
    text = write_page(tmp_path).read_text(encoding="utf-8")
    for wanted in ("**3.00**", "Beyond their tolerance: window.", "**25.0**", "**1 of 2** figures", "75.0", "14",
                   "killed", "**3.00**", "8.00", "whole met, bare missed"):
        assert wanted in text
    assert (tmp_path / "pictures/benchmark/pitches.png").stat().st_size > 10_000
    assert "Cylinder on block" not in text


def test_wear_rows() -> None:
    """A coarse spur pair: twenty blocks and one sweep are timed; the tighter tolerance makes more blocks and a smaller
    error, and the volume's error is not larger than that of the depths."""
    row = next(cost_rows(SMALL_CASES))
    assert BLOCKS == 20 and min(row.prepare, row.sweep) > 0.0 and row.study > row.sweep
    loose, tight = list(precision_rows(SMALL_CASES[0], (0.2, 0.02)))[:2]
    assert loose.blocks < tight.blocks and tight.error < loose.error < 0.2
    assert abs(tight.volume_error) <= tight.error
