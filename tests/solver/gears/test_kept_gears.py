"""Condensed gears that are kept between calls: in the plane, in space as one mesh and in levels."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any, NoReturn

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.fem.cache.cache import SIZE, Cache
from evolvent.fem.condensation.schur_complement import SectorSystem
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.meshed_sector import Mesher
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.sweep.position_search import shared_position
from evolvent.gears.two_level.level_patches import LevelPatches
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from tests.support.gear_cases import few_cells, helical_scene, spur_scene
from tests.support.running.processes import RunScript

RELIEF = "pinion.tip_relief_um=15", "wheel.tip_relief_um=25"
IN_SPACE = "pinion.lead_crowning_um=4", "pair.misalignment_um=12"
CROWNED = "pinion.lead_crowning_um=5", "mesh.level=quick", "mesh.order=1", "mesh.elements_per_contact_width=0.5"
CHANGED = *RELIEF, "contact.friction=0.2"
"""What differs between two calls, beside a torque that is a tenth larger, and crowning and misalignment in space."""


def plane(*settings: str) -> tuple[Scene, Mesher]:
    """He's pair in plane strain."""
    return spur_scene("mesh.level=quick", *settings), run_mesh


def crowned(*settings: str) -> tuple[Scene, Mesher]:
    """He's pair in space, as its pinion is crowned; cells of order 1."""
    return spur_scene(*CROWNED, *settings), run_mesh


def one_mesh(*settings: str) -> tuple[Scene, Mesher]:
    """A helical pair on one mesh a sector."""
    return helical_scene(*settings), run_mesh


def in_levels(*settings: str) -> tuple[Scene, Mesher]:
    """The helical pair with a level on few coarse cells."""
    return helical_scene("mesh.order=2", *settings), few_cells


def prepared(case: tuple[Scene, Mesher]) -> GearModel:
    """Condensed gears of a scene."""
    scene, mesh = case
    return prepare_model(gear_problem(scene), MPI.COMM_SELF, mesh).model


def error(model: GearModel) -> float:
    """Transmission error of a position without friction [mm]."""
    found = shared_position(model, 0.02, (0.0, 0.0), [0.0], None, exact=True)
    return found.contact.stand.turned(model.load.on, float(found.smooth.motion[0])).transmission_error


def nothing_condensed(monkeypatch: pytest.MonkeyPatch) -> None:
    """From here on whatever condenses fails."""

    def refused(*_: object, **__: object) -> NoReturn:
        raise AssertionError("condensed")

    monkeypatch.setattr(SectorSystem, "condensed", refused)
    monkeypatch.setattr(LevelPatches, "response", refused)


@pytest.mark.parametrize(
    ("make", "changed"),
    [(plane, CHANGED), (crowned, CHANGED), (one_mesh, (*CHANGED, *IN_SPACE)), (in_levels, (*CHANGED, *IN_SPACE))],
)
def test_a_second_call_condenses_nothing(
    make: Any, changed: tuple[str, ...], kept: Cache, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Problem: gears are condensed, then wanted with other reliefs, crowning, misalignment and friction, and under a
    torque that is a tenth larger. Exact: nothing is condensed, and the transmission error is that of gears condensed
    without a cache, 1e-9."""
    first = make()
    prepared(first)
    other = make(*changed, f"load.torque_Nm={1.1 * first[0].load.torque_Nm}")
    with monkeypatch.context() as patch:
        nothing_condensed(patch)
        found = prepared(other)
    monkeypatch.setenv(SIZE, "0")
    assert error(found) == pytest.approx(error(prepared(other)), rel=1e-9)


@pytest.mark.parametrize("make", [plane, in_levels])
def test_gears_from_the_cache_are_those_that_were_condensed(make: Any, kept: Cache) -> None:
    """Displacements of all flank nodes under random forces, bit by bit; arrays of the cache are read-only."""
    first, second = (prepared(make(*RELIEF)) for _ in range(2))
    for own, other in zip(first.bodies, second.bodies):
        rows = own.rows(0, np.arange(len(own.flank.points)))
        force = np.random.default_rng(0).normal(size=(len(rows), own.d))
        assert np.array_equal(own.chain.apply(rows, force, rows), other.chain.apply(rows, force, rows))
        assert np.array_equal(own.flank.points, other.flank.points)
    assert error(first) == error(second)


@pytest.mark.parametrize(
    "settings",
    [("pinion.teeth=21",), ("pinion.bore_diameter_mm=38",), ("material.E_GPa=200",), ("mesh.order=2",),
     ("load.torque_Nm=240",)],
)
def test_other_gears_are_condensed(
    settings: tuple[str, ...], kept: Cache, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another tooth number, bore, modulus, order, or a torque that wants another mesh: condensed."""
    prepared(one_mesh())
    nothing_condensed(monkeypatch)
    with pytest.raises(AssertionError, match="condensed"):
        prepared(one_mesh(*settings))


def test_a_damaged_entry_is_condensed_again(kept: Cache) -> None:
    """A flipped bit in each file: the gears are those condensed before, and the files are whole again."""
    first = prepared(plane())
    entries = kept.entries()
    assert len(entries) == 2
    for each in entries:
        content = bytearray(each.path.read_bytes())
        content[len(content) // 2] ^= 4
        each.path.write_bytes(content)
    assert error(prepared(plane())) == pytest.approx(error(first), rel=1e-12)
    assert {each.size for each in kept.entries()} == {each.size for each in entries}


def test_whole_gears_are_not_kept(kept: Cache) -> None:
    """`--exact one-sector` is the long way that shows what sectors are worth: it is computed each time."""
    scene, mesh = plane()
    problem = gear_problem(scene)
    whole = replace(problem, options=replace(problem.options, whole_gears=True))
    prepare_model(whole, MPI.COMM_SELF, mesh)
    assert not kept.entries()


ON_RANKS = """
import json, sys
from mpi4py import MPI
from evolvent.gears.gear_model import prepare_model
from evolvent.scene.gear_problem import gear_problem
from tests.solver.gears import test_kept_gears as tests

if sys.argv[1] == "refused":
    import pytest
    tests.nothing_condensed(pytest.MonkeyPatch())
scene, mesh = tests.in_levels(*tests.RELIEF)
model = prepare_model(gear_problem(scene), MPI.COMM_WORLD, mesh).model
errors = MPI.COMM_WORLD.gather(tests.error(model))
if errors is not None:
    print(json.dumps(errors))
"""


@pytest.mark.mpi
def test_ranks_share_what_is_kept(kept: Cache, run_script: RunScript) -> None:
    """Problem: gears in levels, condensed on two ranks, then wanted on one rank and on two. Exact: nothing is condensed
    again, and all ranks find the transmission error of the first, 1e-9."""
    found: list[float] = []
    for how, ranks in (("condensed", 2), ("refused", 1), ("refused", 2)):
        done = run_script("-c", ON_RANKS, how, ranks=ranks)
        assert done.returncode == 0, done.stderr
        found += json.loads(done.stdout)
    assert len(found) == 5 and found == pytest.approx([found[0]] * 5, rel=1e-9)
