"""Positions of a narrow helical pair at several misalignments, with one search for all.

Exact: each misalignment searched for itself, on the same condensed gears.
"""

from __future__ import annotations

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.dynamics.excitation import misaligned_mesh
from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh
from evolvent.dynamics.excitation.misaligned_mesh import misaligned_figures
from evolvent.gears.gear_model import GearModel
from evolvent.gears.shared_gears import SharedGears, shared_gears_name
from evolvent.gears.sweep.misaligned_position import misaligned_on
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import load_scene
from tests.support.checkout import ROOT

PAIR = ROOT / "evidence/benchmarks/accuracy/scenes/narrow_helical.toml"
MISALIGNMENTS = -8.0, -4.0, 0.0, 4.0, 8.0, 300.0
ANGLES = np.array(uniform_pitch(20, 4).angles)


@pytest.fixture(scope="module")
def models() -> dict[float, GearModel]:
    """By misalignment [µm], on gears that are condensed once."""
    settings = "mesh.elements_per_contact_width=0.8", "contact.friction=0"
    scenes = [load_scene(PAIR, [*settings, f"pair.misalignment_um={each}"]) for each in MISALIGNMENTS]
    problems = [gear_problem(scene) for scene in scenes]
    assert len({shared_gears_name(problem) for problem in problems}) == 1
    gears = SharedGears(problems)
    return {each: gears.prepare(problem).model for each, problem in zip(MISALIGNMENTS, problems)}


def test_misalignments_share_their_search(models: dict[float, GearModel], monkeypatch: pytest.MonkeyPatch) -> None:
    """Five misalignments: a search a position, the middle one exact; transmission errors within 4 nm per µm of
    misalignment (of 32 µm, 0.1 %), stiffness within 0.5 %; each differs from the middle one by much more."""
    searches = []

    def counted(*arguments: object, **words: object) -> SharedPosition:
        searches.append(arguments)
        return shared_position(*arguments, **words)  # type: ignore[arg-type]

    monkeypatch.setattr(misaligned_mesh, "shared_position", counted)
    named = MISALIGNMENTS[:5]
    found = np.array(list(misaligned_figures([models[each] for each in named], ANGLES)))
    assert len(searches) == len(ANGLES)
    for index, each in enumerate(named):
        exact = loaded_mesh(models[each], [200e3], ANGLES, MPI.COMM_SELF)
        off = np.abs(found[:, index, 0] - exact.errors[:, 0]).max()
        assert off < max(4e-6 * abs(each), 2e-8)
        assert found[:, index, 1] == pytest.approx(exact.stiffness[:, 0], rel=5e-3)
        if each:
            assert np.abs(found[:, index, 0] - found[:, 2, 0]).max() > 10.0 * off


def test_far_misalignment_is_searched(models: dict[float, GearModel]) -> None:
    """300 µm move the flanks by far more than a search may be used for: it is searched, and right to the tolerance of
    a solution."""
    searched = shared_position(models[0.0], 0.0, (0.0, 0.0), [0.0], None, exact=True)
    assert misaligned_on(models[300.0], searched) is None
    (found,) = misaligned_figures([models[300.0], models[0.0]], ANGLES[:1])
    exact = loaded_mesh(models[300.0], [200e3], ANGLES[:1], MPI.COMM_SELF)
    assert found[0, 0] == pytest.approx(exact.errors[0, 0], rel=1e-5)


def test_without_a_change_nothing_changes(models: dict[float, GearModel]) -> None:
    """The same misalignment again: the same rotation to 1e-9 of it."""
    searched = shared_position(models[4.0], 0.0, (0.0, 0.0), [0.0], None, exact=True)
    again = misaligned_on(models[4.0], searched)
    assert again is not None
    assert float(again.smooth.motion[0]) == pytest.approx(float(searched.smooth.motion[0]), rel=1e-6, abs=1e-12)


