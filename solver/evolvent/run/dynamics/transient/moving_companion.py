"""The coarse companion of a scene's cases, for their error bars: the same pair on elements of twice the size, in the
time steps of the scene and in steps of a quarter."""

from __future__ import annotations

from collections.abc import Callable

from evolvent.dynamics.pair_model import DriveSettings
from evolvent.dynamics.results.transient.compared import FINER
from evolvent.dynamics.results.transient.errors import MovingCompanion
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.results.archive.archive import COARSE as PART
from evolvent.run.call import Call
from evolvent.run.dynamics.transient.cases import PairCases, PairMeshes, one_pitch, statics_scene
from evolvent.run.dynamics.transient.kept_cases import COARSE, FINER_STEPS, KeptCases
from evolvent.run.kept_pitch import Meshes
from evolvent.run.progress import Progress
from evolvent.scene.scene import Scene

MODES = 3
"""Natural modes of each harmonic of the companion, at least, unless the scene sets their number. With these a small
pair whose flanks separate and meet has its mesh force within 0.2 % of that with all modes, with one within 2 %
(tests/solver/dynamics/transient/test_full_gears.py)."""
ON = PairMeshes(Meshes(companion_mesh, PART, one_pitch, statics_scene), MODES)
"""Meshes and modes of the companion."""


def moving_companion(
    call: Call, scene: Scene, settings: DriveSettings, kept: Callable[[str], KeptCases]
) -> MovingCompanion:
    """The companion of a transient, on rank 0. kept: archive by the kind of cases. Collective. Raises MeshError,
    NotConverged, SearchError, BalanceError, ArchiveError, WriteError."""
    with Progress(hidden=True) as hidden:
        cases = PairCases.of(call, scene, settings, ON, hidden)
    contacts = cases.contacts(FINER)
    finer = cases.tried(kept(FINER_STEPS), contacts)
    same = cases.tried(kept(COARSE), contacts.thinned(FINER))
    return MovingCompanion(cases.pair.model, scene.mesh.order, tuple(cases.static.solved.by_friction), same, finer)
