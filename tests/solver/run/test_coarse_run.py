"""The coarse companion of a run: what of its failure costs the error bars only, and what ends the run."""

from __future__ import annotations

import pytest
from mpi4py import MPI

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.fem.condensation.mumps import NotPositiveDefinite, OutOfMemory
from evolvent.run import coarse_run
from evolvent.run.coarse_run import solve_companion
from evolvent.run.pitch_run import pitch_of
from evolvent_meshes.mesh.mesh_data import MeshError
from tests.support.gear_cases import spur_scene


def fail_with(error: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    """Makes condensing the companion's gears raise this error."""

    def prepare(*_: object) -> None:
        raise error

    monkeypatch.setattr(coarse_run, "prepare_model", prepare)


@pytest.mark.parametrize("kind", [NotConverged, SearchError, MeshError, NotPositiveDefinite, OutOfMemory])
def test_solver_error_costs_the_error_bars_only(kind: type[Exception], monkeypatch: pytest.MonkeyPatch) -> None:
    """A coarse companion that cannot be meshed, factored or solved: no run, and a sentence with the reason."""
    fail_with(kind("no equilibrium"), monkeypatch)
    scene = spur_scene()
    companion = solve_companion(scene, pitch_of(scene), MPI.COMM_SELF)
    assert companion.run is None
    assert companion.failure == "Error bars: their coarse companion could not be solved: no equilibrium"


@pytest.mark.parametrize("kind", [TypeError, AttributeError, AssertionError, ValueError, KeyError])
def test_bug_in_the_companion_is_raised(kind: type[Exception], monkeypatch: pytest.MonkeyPatch) -> None:
    """A bug leaves as what it is; reported as an unsolved companion, it would never be found."""
    fail_with(kind("a bug"), monkeypatch)
    scene = spur_scene()
    with pytest.raises(kind, match="a bug"):
        solve_companion(scene, pitch_of(scene), MPI.COMM_SELF)
