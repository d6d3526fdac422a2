"""The other programs get the same problem, and solve it where they are installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from evidence.benchmarks.comparison.evolvent_program import solved
from evidence.benchmarks.comparison.pressure import Pressure, Reference
from evidence.benchmarks.comparison.programs import PEERS, Program, solve
from evidence.benchmarks.comparison.round_contacts import cylinder, sphere
from evidence.benchmarks.peers.calculix import FACES, deck, element_faces
from evidence.benchmarks.peers.nodal_normals import nodal_normals


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
def test_installed_peers_solve_the_same_problem(program: Program, tmp_path: Path) -> None:
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
