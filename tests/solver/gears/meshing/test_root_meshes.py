"""Resolutions of sectors whose root stress is wanted, and the two roots of their meshes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.fem.surface import surface_of
from evolvent.gears.meshing.root_meshes import (
    BACK_ROOT,
    LEAST_RIM,
    LOADED_ROOT,
    RootMesh,
    adapted_root_mesh,
    finer_roots,
    root_nodes,
)
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.section import SectorResolution
from tests.support.gear_cases import spur_scene

THICK = (0.3, 0.45, 0.66)


@pytest.fixture(scope="module")
def problem() -> GearProblem:
    return gear_problem(spur_scene("mesh.level=quick"))


def meshed(problem: GearProblem, sector: SectorResolution) -> MeshData:
    mesh = adapted_root_mesh(problem, Member.PINION, lambda _: sector)
    assert isinstance(mesh, MeshData)
    return mesh


def depth_at_cut(mesh: MeshData) -> float:
    """Length [mm] of the cut's edge that begins at the root."""
    on_cut = np.unique(mesh.facets["cut_high"])
    (outermost,) = np.intersect1d(on_cut, surface_of(mesh, LOADED_ROOT).nodes)
    distances = np.sort(np.linalg.norm((mesh.points[on_cut] - mesh.points[outermost])[:, :2], axis=1))
    return float(distances[2])  # of second order: the node itself, the middle, the corner


def test_finer_roots_have_thin_cells_below_thick_layers(problem: GearProblem) -> None:
    """Layers of 1.41 mm below the flank: the cells at the cut are as deep as the band of 0.3 or 0.15 modules, 1e-6,
    where roots are finer; those of a run as deep as the layers."""
    run = SectorResolution(layer_depths=THICK)
    module = problem.pair.pinion.normal_module
    assert depth_at_cut(meshed(problem, run)) == pytest.approx(sum(THICK), rel=1e-6)
    for times in (1, 2):
        fine = finer_roots(run, times)
        assert depth_at_cut(meshed(problem, fine)) == pytest.approx(0.3 * module / times, rel=1e-6)


def test_counts_of_finer_roots() -> None:
    """Fillets, necks and core are finer, the flank is not."""
    run = SectorResolution()
    fine = finer_roots(run, 3)
    assert (fine.fillet_elements, fine.back_elements, fine.neck_elements, fine.core_elements) == (18, 15, 9, 6)
    assert fine.profile_elements == run.profile_elements and fine.rim_elements == run.rim_elements


@pytest.mark.parametrize(("rim", "coarse"), [(4, LEAST_RIM), (6, 3), (10, 5)])
def test_companions_keep_rows_in_the_rim(problem: GearProblem, rim: int, coarse: int) -> None:
    """Half of the rows, and three at least: the smallest number of rows that the stress bears."""
    mesh = RootMesh(coarse=True)
    adapted = mesh._adapted(replace(SectorResolution(), rim_elements=rim))
    assert adapted.rim_elements == coarse
    assert adapted.fillet_elements == SectorResolution.fillet_elements


def test_roots_of_both_sides(problem: GearProblem) -> None:
    """The back's root reaches up to the radius of the loaded one's, to 1e-9; nodes of both are named, ascending."""
    mesh = RootMesh()(problem, Member.PINION)
    assert isinstance(mesh, MeshData)
    tops = [np.hypot(*surface_of(mesh, name).points.T).max() for name in (LOADED_ROOT, BACK_ROOT)]
    nodes = root_nodes(mesh)
    assert tops[1] <= tops[0] * (1.0 + 1e-9)
    assert (np.diff(nodes) > 0).all()
    assert set(nodes) == {*surface_of(mesh, LOADED_ROOT).nodes, *surface_of(mesh, BACK_ROOT).nodes}
