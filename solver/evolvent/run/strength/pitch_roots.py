"""Root stress of both gears over a pitch of a scene, on meshes with finer roots."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Mesher, Preparer, prepare_model
from evolvent.gears.meshing.root_meshes import RootMesh
from evolvent.results.tables.run_warnings import tip_edge_contact
from evolvent.run.coarse_run import as_run
from evolvent.run.pitch_run import pitch_of
from evolvent.run.progress import CONDENSING, MESHING, POSITIONS, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.strength import StrengthSection
from evolvent.strength.certified_roots import certified_roots
from evolvent.strength.peak_positions import Roots


@dataclass(frozen=True)
class PitchRoots:
    """Root stress of the positions of a pitch, of those around its largest values, and of those at which a tooth of a
    spur gear is loaded at its outer point of single or double contact."""

    angles: tuple[float, ...]
    """Pinion rotations beyond those of uniform spacing [rad]."""
    roots: Roots
    """Root stresses of both gears at each friction coefficient."""
    deflected: bool
    """Whether contact was searched again on deflected flanks."""
    tip_edges: str
    """Beginning of a sentence on contact on tip edges, see `tip_edge_contact`; empty where none bears."""


def scene_root_meshes(scene: Scene) -> tuple[RootMesh, RootMesh]:
    """The root mesh of the results, and the coarse one of the error bars."""
    times = (scene.strength or StrengthSection()).root_refinement
    return RootMesh(times), RootMesh(times, coarse=True)


def pitch_roots(
    scene: Scene, mesh: Mesher, comm: MPI.Comm, progress: Progress, stage: str = POSITIONS,
    angles: Sequence[float] | None = None, prepare: Preparer = prepare_model,
) -> PitchRoots:
    """Root stresses of both gears over a pitch at each friction coefficient. Collective.

    mesh: of `root_meshes`. stage: of the progress, for the positions. angles: beyond the uniform ones; None: see
    `PitchRoots`. prepare: prepares gears that other calls share.

    Raises MeshError, TooMuchRelief, NotConverged, SearchError, BalanceError.
    """
    progress.stage(MESHING)
    problem = gear_problem(scene)
    one_sector = replace(problem, options=replace(problem.options, whole_gears=False))  # it has the roots
    gears = prepare(one_sector, comm, mesh, lambda: progress.stage(CONDENSING)).model
    pitch, frictions = pitch_of(scene), scene.contact.friction
    progress.stage(stage, len(pitch.angles))
    found = certified_roots(gears, problem, pitch, frictions, comm, progress.position, angles)
    run = as_run(scene, gears, found.solved, comm)
    edges = on_first(comm, lambda: "" if run is None else tip_edge_contact(run))
    return PitchRoots(found.further, found.roots, found.solved.deflected, edges)
