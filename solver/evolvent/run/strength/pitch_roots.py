"""Root stress of both gears over a pitch of a scene, on meshes with finer roots."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from evolvent.gears.meshing.root_meshes import RootMesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.pitch_sweep import SweptPosition
from evolvent.results.archive.archive import COARSE
from evolvent.results.archive.run_cost import Timings
from evolvent.results.tables.run_warnings import tip_edge_contact
from evolvent.run.call import Call
from evolvent.run.kept_pitch import Meshes, kept_pitch
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
    scene: Scene
    """Scene as it was solved, on deflected flanks where its pitch needs them."""
    timings: Timings
    """Wall time of the uniform positions [s]."""
    tip_edges: str
    """Beginning of a sentence on contact on tip edges, see `tip_edge_contact`; empty where none bears."""


def root_meshes(scene: Scene) -> tuple[Meshes, Meshes]:
    """Meshes with finer roots: those of the results, and the coarse ones of the error bars."""
    times = root_refinement(scene)
    return (
        Meshes(RootMesh(times), problem=one_sector),
        Meshes(RootMesh(times, coarse=True), COARSE, one_sector),
    )


def root_refinement(scene: Scene) -> int:
    """How many times finer the roots are than those of a run."""
    return (scene.strength or StrengthSection()).root_refinement


def one_sector(scene: Scene) -> GearProblem:
    """The gear problem of a scene on one sector of each gear, which has the roots."""
    problem = gear_problem(scene)
    return replace(problem, options=replace(problem.options, whole_gears=False))


def pitch_roots(call: Call, scene: Scene, meshes: Meshes, angles: Sequence[float] | None = None) -> PitchRoots:
    """Root stresses of both gears over a pitch at each friction coefficient; solved positions are stored. Collective.

    meshes: of `root_meshes`.
    angles: pinion rotations [rad] beyond the uniform ones; None: see `PitchRoots`.

    Raises MeshError, TooMuchRelief, NotConverged, SearchError, BalanceError, ArchiveError, WriteError.
    """
    pitch = kept_pitch(call, scene, meshes)
    problem = meshes.problem(pitch.scene)
    gears = pitch.gears or call.gears(problem, meshes.mesh, shown=not meshes.part)

    def stored(angle: float, solve: Callable[[], SweptPosition]) -> SweptPosition:
        known = pitch.archive.read_between(angle, problem.pair) if call.resume else None
        if known is None:
            known = solve()
            pitch.archive.write_between(known)
        return known

    found = certified_roots(gears.model, problem, pitch.solved, scene.contact.friction, call.comm, angles, stored)
    edges = call.on_first(lambda: tip_edge_contact(pitch.run_data()))
    return PitchRoots(found.further, found.roots, pitch.scene, pitch.timings, edges)
