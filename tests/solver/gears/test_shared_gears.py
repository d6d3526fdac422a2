"""Gears under several torques, condensed once: a narrow helical pair with two levels on few coarse cells."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh
from evolvent.gears import meshed_sector
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.meshing.flank_levels import FlankLevel, LevelledSector, levelled_sector
from evolvent.gears.meshing.levelled_meshes import LevelledMesh, levelled_mesh
from evolvent.gears.problem.gear_problem import GearProblem, MeshSettings
from evolvent.gears.shared_gears import SharedGears, shared_gears_name, under_torques
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import spur_scene
from tests.support.paper_pairs import yang

LEVELS = (FlankLevel(2, 1, (1, 1, 1)), FlankLevel(2, 1, (1, 1, 1)))


def problems() -> list[GearProblem]:
    pair = yang()
    pinion, wheel = (replace(gear, face_width=1.4) for gear in pair.gears)
    narrow = GearProblem(
        GearPair(pinion, wheel, pair.centre_distance), 20e3, mesh=MeshSettings("quick", 0.8, two_level=True)
    )
    return under_torques(narrow, [2e3, 20e3])


def few_cells(problem: GearProblem, member: Member) -> LevelledMesh:
    """12 × 2 coarse cells, two levels under the light torque and one under the heavy one."""

    def adapted(sector: LevelledSector) -> LevelledSector:
        coarse = replace(sector.coarse, profile_elements=12, face_elements=2)
        return LevelledSector(coarse, LEVELS[: len(sector.levels)])

    return levelled_mesh(problem, member, adapted)


@pytest.mark.evidence
@pytest.mark.slow
def test_each_torque_has_the_gears_that_it_would_have_alone() -> None:
    """The light torque takes two levels, the heavy one the first of them; the compliance is that of gears condensed for
    this torque alone, on its own meshes, 1e-9: products of other sizes are rounded otherwise, by up to the
    condition number of the sector's stiffness, 6e7, times 1e-16. It is nothing with Debian 12's libraries and 1.2e-10
    with Debian 13's. Time counts once."""
    light, heavy = problems()
    assert [len(levelled_sector(each, Member.PINION).levels) for each in (light, heavy)] == [2, 1]
    gears = SharedGears([light, heavy])
    first, second = (gears.prepare(each, MPI.COMM_SELF, few_cells) for each in (heavy, light))
    assert first.seconds > 0.0 and first.condense_seconds > 0.0
    assert second.seconds == second.condense_seconds == 0.0
    for problem, found in ((heavy, first), (light, second)):
        alone = prepare_model(problem, MPI.COMM_SELF, few_cells).model
        assert found.model.load == alone.load and found.model.half_width == alone.half_width
        for own, other in zip(found.model.bodies, alone.bodies):
            assert own.levels == other.levels and (own.stabiliser is None) == (other.stabiliser is None)
            rows = own.rows(0, np.arange(len(own.flank.points)))
            force = np.random.default_rng(0).normal(size=(len(rows), 3))
            moved, wanted = (body.chain.apply(rows, force, rows) for body in (own, other))
            assert np.abs(moved - wanted).max() <= 1e-9 * np.abs(wanted).max()


def test_gears_of_one_mesh_are_condensed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where flanks have no levels, all torques share the mesh of the lightest: both gears are condensed once."""
    calls, condensed = [], meshed_sector.condensed_gear

    def counted(*given: object, **named: object) -> object:
        calls.append(given)
        return condensed(*given, **named)  # type: ignore[arg-type]

    monkeypatch.setattr(meshed_sector, "condensed_gear", counted)
    three = under_torques(gear_problem(spur_scene("mesh.level=quick")), [5e3, 10e3, 20e3])
    gears = SharedGears(three)
    models = [gears.prepare(each, MPI.COMM_SELF).model for each in three]
    assert len(calls) == 2
    assert len({id(model.bodies[0].flank) for model in models}) == 1
    assert [model.load.torque * model.width_factor for model in models] == pytest.approx([5e3, 10e3, 20e3])


def test_torque_beyond_those_that_the_meshes_serve_is_refused() -> None:
    """20 N·m on meshes for 1 to 10 N·m, whose fine flanks would be too short; a lighter torque is only less finely
    resolved. A range that falls is none."""
    for served in ((1e3, 10e3), (30e3, 20e3), (0.0, 20e3)):
        with pytest.raises(InputError, match="mesh_torques"):
            replace(problems()[0], torque=20e3, mesh_torques=served)
    assert replace(problems()[0], torque=20e3, mesh_torques=(30e3, 30e3)).lightest.torque == 30e3


def test_gears_in_line_contact_serve_all_modifications(monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: He's pair in line contact with two reliefs and torques. Exact: one name, gears condensed once, and the
    mesh that each would have alone, 1e-9. Where the contact is resolved they have gears of their own."""
    calls, condensed = [], meshed_sector.condensed_gear

    def counted(*given: object, **named: object) -> object:
        calls.append(given)
        return condensed(*given, **named)  # type: ignore[arg-type]

    relieved = [
        gear_problem(spur_scene("mesh.level=line", f"pinion.tip_relief_um={relief}", "wheel.tip_relief_um=25", torque))
        for relief, torque in ((20, "load.torque_Nm=170"), (30, "load.torque_Nm=90"))
    ]
    assert len({shared_gears_name(each) for each in relieved}) == 1
    resolved = [replace(each, mesh=MeshSettings("quick")) for each in relieved]
    assert len({shared_gears_name(each) for each in resolved}) == 2
    angles = 2.0 * np.pi / 50.0 * np.arange(3) / 3
    alone = [loaded_mesh(prepare_model(each, MPI.COMM_SELF).model, [each.torque], angles) for each in relieved]
    monkeypatch.setattr(meshed_sector, "condensed_gear", counted)
    gears = SharedGears(relieved)
    for problem, wanted in zip(relieved, alone):
        found = loaded_mesh(gears.prepare(problem, MPI.COMM_SELF).model, [problem.torque], angles)
        assert found.errors == pytest.approx(wanted.errors, rel=1e-9)
    assert len(calls) == 2
