"""Displacement and stress inside teeth: against the compliance that contact saw, torques, and as ParaView reads it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyvista

from evolvent.fem.stress import von_mises
from evolvent.gears.condensed_gear import sector_body, sector_parts
from evolvent.gears.gear_model import GearModel
from evolvent.gears.meshing import levelled_meshes
from evolvent.gears.sweep.pitch_sweep import SweptPosition, initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent.results.fields.deformation import Deformation
from evolvent.run.kinds.run import Run
from evolvent.scene.scene import Scene
from evolvent_meshes.rotation import turn
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import helical_scene, model_of, spur_scene

Case = tuple[GearModel, list[SweptPosition], Deformation]


@pytest.fixture(scope="module", params=["spur", "helical"])
def case(request: pytest.FixtureRequest) -> Case:
    """Two positions of a pair, with friction."""
    small = "contact.friction=0.1", "sweep.positions=2"
    scene: Scene = spur_scene("mesh.level=quick", *small) if request.param == "spur" else helical_scene(*small)
    model = model_of(scene)
    swept = list(sweep_pitch(model, uniform_pitch(scene.pinion.teeth, 2), [0.1], initial_state([0.1])))
    return model, swept, Deformation.of(model.bodies, [position.results[0] for position in swept])


def test_recovered_flank_displacement_is_that_of_the_compliance(case: Case) -> None:
    """Exact: on the flanks the recovered field is what the gears' compliance gives there under the same forces, on
    every tooth that carries load and at every position, to the tolerance of the coupling of teeth."""
    model, swept, deformation = case
    for k, position in enumerate(swept):
        result = position.results[0]
        for gear, rows, forces in (
            (0, result.pinion_rows, result.pinion_forces), (1, result.wheel_rows, result.wheel_forces),
        ):
            body, pitch = model.bodies[gear], 2.0 * np.pi / model.bodies[gear].gear.z
            parts = sector_parts(sector_body(body.mesh, body.material, body.member), body.flank, body.traction, pitch)
            assert len(deformation.gears[gear].teeth(k)) >= 1
            for number in deformation.gears[gear].teeth(k):
                u = deformation.gears[gear].displacement(k, number)
                nodes = np.arange(len(body.flank.points))
                every = np.column_stack([np.full(len(nodes), number), nodes])
                wanted = body.chain.apply(rows, forces, every) @ turn(number * pitch, body.d)
                found = (parts.functionals @ u.ravel()).reshape(wanted.shape)
                assert np.abs(found - wanted).max() < 1e-8 * np.abs(wanted).max()


@pytest.mark.evidence
@pytest.mark.slow
def test_levels_move_the_sector_as_contact_saw_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A helical pair whose flanks have levels of their own. Exact: the forces on the coarse flanks add up to those on
    the fine ones, and on a tooth that carries no load, where finer cells change nothing, the fine flank moves as the
    coarse sector's shape functions say."""
    monkeypatch.setattr(levelled_meshes, "MOST_DOFS", 0)
    narrow = "mesh.order=2", "pinion.face_width_mm=4", "wheel.face_width_mm=4"
    model = model_of(helical_scene(*narrow, "contact.friction=0.1"))
    result = next(sweep_pitch(model, uniform_pitch(20, 2), [0.1], initial_state([0.1]))).results[0]
    loads = (result.pinion_rows, result.pinion_forces), (result.wheel_rows, result.wheel_forces)
    deformation = Deformation.of(model.bodies, [result])
    for body, field, (rows, forces) in zip(model.bodies, deformation.gears, loads):
        ring = body.chain
        assert isinstance(ring, TwoLevelRing)
        assert np.sum(field._forces[0], axis=0) == pytest.approx(np.sum(forces, axis=0), rel=1e-9)
        idle = next(n for n in (body.member.sign * tooth for tooth in model.teeth) if n not in field.teeth(0))
        moved = field.displacement(0, idle)[ring.flank.nodes]
        for level in ring.levels:
            moved = level.transfer @ moved
        every = np.column_stack([np.full(ring.size, idle), np.arange(ring.size)])
        wanted = ring.apply(rows, forces, every) @ turn(idle * 2.0 * np.pi / body.gear.z, 3)
        assert np.abs(moved - wanted).max() < 1e-6 * np.abs(wanted).max()


def test_forces_on_the_gears_balance_the_torques(case: Case) -> None:
    """Exact: the moments of what both gears carry about their axes are the torques of the position."""
    model, swept, _ = case
    for result in (position.results[0] for position in swept):
        for gear, rows, forces in (
            (0, result.pinion_rows, result.pinion_forces), (1, result.wheel_rows, result.wheel_forces),
        ):
            body = model.bodies[gear]
            angles = rows[:, 0] * 2.0 * np.pi / body.gear.z
            x = np.array([turn(a, 2) @ p[:2] for a, p in zip(angles, body.flank.points[rows[:, 1]])])
            moment = float(np.sum(x[:, 0] * forces[:, 1] - x[:, 1] * forces[:, 0]))
            assert abs(moment) == pytest.approx(result.torques[gear], rel=0.01)


def test_stress_is_largest_at_flank_or_fillet(case: Case) -> None:
    """The stress is the largest of its gear near the flank or in the fillets, not at the bore's side, and the flank
    that bears moves by micrometres."""
    _, _, deformation = case
    for tooth in deformation.teeth(0):
        stress = von_mises(tooth.stress)
        radius = np.hypot(*tooth.mesh.points[tooth.mesh.cells].mean(axis=1)[:, :2].T)
        assert radius[np.argmax(stress)] > np.median([radius.min(), radius.max()])
        assert 1e-4 < np.abs(tooth.displacement).max() < 0.1


def test_deformed_series_opens_in_pyvista(tmp_path: Path) -> None:
    """A run of He's pair that asks for it: one time a position, displacement at the nodes, stress in the cells of both
    gears; the bore stays where it is. A run that does not ask has none."""
    scene = spur_scene("mesh.level=quick", "sweep.positions=3", "output.deformation=true", "contact.friction=0")
    quietly(Run.of(scene), tmp_path / "out")
    reader = pyvista.get_reader(str(tmp_path / "out/fields/deformed.pvd"))
    assert len(reader.time_values) == 3
    grid = reader.read()[0]
    size = np.linalg.norm(grid.point_data["displacement_mm"], axis=1)
    assert 5e-4 < size.max() < 0.1 and size.min() == 0.0
    assert set(np.unique(grid.cell_data["gear"])) == {0.0, 1.0}
    assert grid.cell_data["stress_MPa"].shape == (grid.n_cells, 9)
    assert 100.0 < grid.cell_data["von_mises_MPa"].max() < 2000.0
    quietly(Run.of(spur_scene("mesh.level=quick", "sweep.positions=3", "contact.friction=0")), tmp_path / "bare")
    assert not (tmp_path / "bare/fields").exists()
