"""What all positions of a gear pair share: condensed gears, load and window.

With several ranks each gear is condensed on one; the patches of flanks in levels are divided among all.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from mpi4py import MPI

from evolvent.fem.parallel.cores import Cores
from evolvent.fem.parallel.ranks import shared, together
from evolvent.gears.condensed_gear import GearBody, condensed_gear
from evolvent.gears.meshing.levelled_meshes import LevelledMesh, SectorMesh, run_mesh
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.two_level_pair import two_level_pair
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

Mesher = Callable[[GearProblem, Member], SectorMesh]
"""Makes the sector mesh of the pinion or the wheel; with levels, the gear is condensed in levels."""


@dataclass(frozen=True)
class GearLoad:
    """A constant torque on one gear; the other one is driven."""

    torque: float
    """[N·mm; per mm of face width in 2D]."""
    on: Member = Member.PINION
    """The gear with the torque."""


@dataclass(frozen=True)
class GearModel:
    """All that positions share."""

    pair: GearPair
    """Both gears and the position of their axes."""
    bodies: tuple[GearBody, GearBody]
    """Condensed pinion and wheel."""
    teeth: tuple[int, ...]
    """Tooth pairs that are searched."""
    load: GearLoad
    """The torque."""
    half_width: float
    """Of the contact window to begin with [mm of profile arc]; infinite: the whole flanks are searched."""
    friction_terms: bool = False
    """Keep tangential components and friction history also at μ = 0."""
    deflected: bool = False
    """Search contact again on deflected flanks."""
    pitches: int = 1
    """Base pitches that a sweep has."""

    @property
    def width_factor(self) -> float:
        """Factor from forces, torques and volumes of the model to those of the gears: the face width [mm] of plane
        gears, else 1."""
        return self.pair.face_width if self.bodies[0].d == 2 else 1.0

    def has_friction_terms(self, friction: float) -> bool:
        """Whether tangential components and friction history are kept at this μ."""
        return friction > 0.0 or self.friction_terms


@dataclass(frozen=True)
class Preparation:
    """A gear model and what it took."""

    model: GearModel
    """Condensed gears, ready for positions."""
    mesh_seconds: float
    """Wall seconds of meshing."""
    seconds: float
    """Wall seconds of condensing."""

    @property
    def assemble_seconds(self) -> float:
        """Summed over both gears."""
        return sum(body.assemble_seconds for body in self.model.bodies)

    @property
    def condense_seconds(self) -> float:
        """Summed over both gears."""
        return sum(body.condense_seconds for body in self.model.bodies)


def prepare_model(
    problem: GearProblem,
    comm: MPI.Comm = MPI.COMM_WORLD,
    mesh: Mesher = run_mesh,
    meshed: Callable[[], None] = lambda: None,
) -> Preparation:
    """Meshes and condenses both gears; all ranks of `comm` call it.

    mesh: makes a sector's mesh, by default that of the problem; meshed: called when both gears are meshed.

    Raises MeshError, TooMuchRelief, NotPositiveDefinite, OutOfMemory.
    """
    begin = time.perf_counter()
    # eliminating the pinion, which carries Nitsche's constant term, takes most memory: first, while that is free
    own = [member for member in Member if member % comm.size == comm.rank]
    meshes = together(comm, lambda: {member: mesh(problem, member) for member in own})
    after_meshing, cores = time.perf_counter(), Cores(comm)
    meshed()

    levelled = {member: each for member, each in meshes.items() if isinstance(each, LevelledMesh)}
    plain = {member: each for member, each in meshes.items() if not isinstance(each, LevelledMesh)}

    def condensed(member: Member) -> GearBody:
        return condensed_gear(
            problem.pair.gears[member], plain[member], problem.materials[member], problem.contact_teeth, member,
            member is Member.PINION, whole=problem.options.whole_gears, threads=cores.used,
        )  # fmt: skip

    built = together(comm, lambda: {member: condensed(member) for member in plain}, cores.lent)
    if comm.allreduce(len(levelled)):
        built |= two_level_pair(problem, levelled, comm, cores)
    bodies = [shared(comm, built.pop(member, None), member % comm.size) for member in Member]
    pinion, wheel = (_charted(body, chart) for body, chart in zip(bodies, problem.flanks))
    model = GearModel(
        problem.pair, (pinion, wheel), problem.contact_teeth, gear_load(problem), problem.window_half_width,
        problem.options.friction_terms, problem.options.deflected_flanks, problem.pitches,
    )  # fmt: skip
    return Preparation(model, after_meshing - begin, time.perf_counter() - after_meshing)


def gear_load(problem: GearProblem) -> GearLoad:
    """The torque, per mm of face width where the problem is plane."""
    return GearLoad(problem.torque / (problem.pair.face_width if problem.is_plane else 1.0), problem.torque_on)


def _charted(body: GearBody, chart: FlankChart | None) -> GearBody:
    """The gear with its flank as charted."""
    return body if chart is None else replace(body, worn=chart.at(body.gear, body.roll_length, body.z))
