"""Displacements at the roots, condensed with the flanks, and what holds a gear, against the field of whole sectors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.gears.condensed_gear import GearBody, condensed_gear
from evolvent.gears.gear_model import GearModel, Mesher, prepare_model
from evolvent.gears.meshing.levelled_meshes import LevelledMesh
from evolvent.gears.meshing.root_meshes import RootMesh, root_nodes, with_back_root
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.ring.ring_compliance import ChainedCompliance
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_result import NodalForces, nodal_forces
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent.results.fields.deformation import GearField
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from tests.support.gear_cases import few_cells, helical_scene, model_of, spur_scene
from tests.support.gear_reactions import reaction_imbalance

POSITIONS = 2


def few_cells_with_roots(problem: GearProblem, member: Member) -> LevelledMesh:
    """Few cells on a flank with a level, and the nodes of both roots."""
    levelled = few_cells(problem, member)
    return replace(levelled, mesh=with_back_root(levelled.mesh))


def loaded(scene: Scene, mesh: Mesher = RootMesh()) -> tuple[GearModel, list[NodalForces]]:  # noqa: B008  frozen
    """Gears with the nodes of their roots, and the forces on each at two positions with friction."""
    model = prepare_model(gear_problem(scene), MPI.COMM_SELF, mesh).model
    positions = sweep_pitch(model, uniform_pitch(scene.pinion.teeth, POSITIONS), [0.1], initial_state([0.1]))
    results = [position.results[0] for position in positions]
    return model, [nodal_forces(results, body.member) for body in model.bodies]


def check_roots(body: GearBody, loads: NodalForces) -> None:
    """Of every tooth, at both positions."""
    ring = body.chain
    assert isinstance(ring, ChainedCompliance | TwoLevelRing)
    field, found = GearField(body, loads), ring.observed_displacements(loads.rows, loads.forces)
    assert len(found) > len(np.unique(loads.rows[:, 0]))
    for number, moved in found.items():
        for k in range(POSITIONS):
            wanted = field.displacement(k, number)[root_nodes(body.mesh)]
            assert np.abs(moved[k] - wanted).max() < 1e-9 * np.abs(field.displacement(k, number)).max()


@pytest.mark.parametrize("member", Member)
@pytest.mark.parametrize("kind", ["spur", "helical"])
def test_roots_move_as_the_whole_sector(kind: str, member: Member) -> None:
    """Exact: both gears, with Nitsche's flux and without; teeth with a load and without."""
    small = "contact.friction=0.1", "sweep.positions=2"
    model, loads = loaded(spur_scene("mesh.level=quick", *small) if kind == "spur" else helical_scene(*small))
    check_roots(model.bodies[member], loads[member])


def test_roots_below_flanks_with_levels() -> None:
    """Exact: forces act on the sector through its coarse flank, in the field and at the roots."""
    narrow = "mesh.order=2", "pinion.face_width_mm=4", "wheel.face_width_mm=4"
    model, loads = loaded(helical_scene(*narrow, "contact.friction=0.1"), few_cells_with_roots)
    for body, own in zip(model.bodies, loads):
        assert isinstance(body.chain, TwoLevelRing)
        check_roots(body, own)


def test_meshes_of_a_run_observe_nothing() -> None:
    """Only meshes with a `BACK_ROOT` have root nodes; without, displacements there are refused."""
    model = model_of(spur_scene("mesh.level=quick"))
    chain = model.bodies[0].chain
    assert len(root_nodes(model.bodies[0].mesh)) == 0
    assert isinstance(chain, ChainedCompliance)
    with pytest.raises(ValueError, match="wanted observed nodes, found none"):
        chain.observed_displacements(np.array([[0, 0]]), np.ones((1, 1, 2)))


@pytest.mark.parametrize("member", Member)
def test_reactions_of_all_sectors_balance_the_forces(member: Member) -> None:
    """Of He's pair, two teeth under random forces. Exact: what holds the bore of all z sectors, K u there, is the
    negative of their sum, 1e-6, in moment, too."""
    problem = gear_problem(spur_scene("mesh.level=quick"))
    gear, mesh = problem.pair.gears[member], RootMesh()(problem, member)
    assert isinstance(mesh, MeshData)
    body = condensed_gear(
        gear, mesh, problem.materials[member], range(gear.z), member, carries_pressure=member is Member.PINION
    )
    assert (reaction_imbalance(body) < 1e-6).all()
