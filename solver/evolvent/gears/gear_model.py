"""Model of a gear pair for all positions: condensed gears, load and window.

With several ranks each gear is condensed on one; the patches of flanks in levels are divided among all.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from mpi4py import MPI

from evolvent.fem.cache.cache import NOT_KEPT, Cache
from evolvent.fem.parallel.cores import Cores
from evolvent.fem.parallel.ranks import shared, together
from evolvent.gears.condensed_gear import GearBody
from evolvent.gears.gear_load import GearLoad, gear_load
from evolvent.gears.meshed_sector import MeshedSector, Mesher
from evolvent.gears.meshing.flank_levels import levelled_sector
from evolvent.gears.meshing.levelled_meshes import LevelledMesh, is_two_level, run_mesh
from evolvent.gears.position_start import PositionStart
from evolvent.gears.problem.flank_deviations import FlankCharts
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.two_level_pair import two_level_pair
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

Preparer = Callable[..., "Preparation"]
"""A function with the parameters of `prepare_model`."""
PositionStarts = Callable[["GearModel", float], PositionStart | None]
"""Function from gears under a load and a rotation of the pinion [rad] to the start of a position; None where it has
none."""


@dataclass(frozen=True)
class GearModel:
    """Condensed gears, load and search settings for all positions of a gear pair."""

    pair: GearPair
    """Both gears and the position of their axes."""
    bodies: tuple[GearBody, GearBody]
    """Condensed pinion and wheel."""
    teeth: tuple[int, ...]
    """Tooth pairs that are searched for contact."""
    load: GearLoad
    """Torque and the gear on which it acts."""
    half_width: float
    """Initial half-width of the contact window [mm of profile arc]; infinite: the whole flanks are searched."""
    friction_terms: bool = False
    """Whether tangential components and friction history are kept also at μ = 0."""
    deflected: bool = False
    """Whether contact is searched again on deflected flanks."""
    pitches: int = 1
    """Number of angular pitches of a sweep."""
    charts: FlankCharts = (None, None)
    """Deviations of the flanks of pinion and wheel, which `bodies` have at their nodes; None: as designed."""
    starts: PositionStarts | None = None
    """Makes starts of positions; None: positions start from those before."""

    @property
    def is_line(self) -> bool:
        """Whether the gears are condensed for line contact: neither has the pressure side of Nitsche's method."""
        return all(body.stabiliser is None for body in self.bodies)

    @property
    def base_radius(self) -> float:
        """Base radius of the gear with the torque [mm]."""
        return self.bodies[self.load.on].gear.base_radius

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
    """Gear model with the wall time of its meshing and condensation."""

    model: GearModel
    """Condensed gears, ready for positions."""
    mesh_seconds: float
    """Wall seconds of meshing."""
    seconds: float
    """Wall seconds of condensing."""

    @property
    def assemble_seconds(self) -> float:
        """Wall seconds of assembling both gears, summed."""
        return sum(body.assemble_seconds for body in self.model.bodies)

    @property
    def condense_seconds(self) -> float:
        """Wall seconds of condensing both gears, summed."""
        return sum(body.condense_seconds for body in self.model.bodies)

    def without_time(self) -> Preparation:
        """Preparation with zero wall times, where they count elsewhere."""
        pinion, wheel = (replace(body, assemble_seconds=0.0, condense_seconds=0.0) for body in self.model.bodies)
        return Preparation(replace(self.model, bodies=(pinion, wheel)), 0.0, 0.0)


@dataclass(frozen=True)
class CondensedGears:
    """Both gears, condensed for one torque or several."""

    finest: GearProblem
    """Problem under the lightest of the torques, which needs most levels."""
    bodies: tuple[Mapping[int, GearBody], Mapping[int, GearBody]]
    """Condensed pinion and wheel, by the number of omitted finest levels of their flanks."""
    mesh_seconds: float
    """Wall seconds of meshing."""
    seconds: float
    """Wall seconds of condensing."""

    def under(self, problem: GearProblem) -> Preparation:
        """The gears under the torque of a problem, which is one of those that they are condensed for."""
        pinion, wheel = (
            _with_flank(bodies[_omitted(problem, self.finest, member)], problem, member)
            for member, bodies in zip(Member, self.bodies)
        )
        model = GearModel(
            problem.pair, (pinion, wheel), problem.contact_teeth, gear_load(problem), problem.window_half_width,
            problem.options.friction_terms, problem.options.deflected_flanks, problem.pitches, problem.flanks,
        )
        return Preparation(model, self.mesh_seconds, self.seconds)


def prepare_model(
    problem: GearProblem,
    comm: MPI.Comm = MPI.COMM_WORLD,
    mesh: Mesher = run_mesh,
    meshed: Callable[[], None] = lambda: None,
    as_meshed: bool = False,
) -> Preparation:
    """Meshes and condenses both gears; all ranks of `comm` call it.

    mesh: makes a sector's mesh, by default that of the problem; meshed: called when both gears are meshed; as_meshed:
    whether sectors are condensed as `mesh` makes them, and not kept, for flanks that wear; else without modifications,
    and from the cache where they are there.

    Raises MeshError, TooMuchRelief, NotPositiveDefinite, OutOfMemory.
    """
    return condensed_gears([problem], comm, mesh, meshed, as_meshed).under(problem)


def condensed_gears(
    problems: Sequence[GearProblem],
    comm: MPI.Comm = MPI.COMM_WORLD,
    mesh: Mesher = run_mesh,
    meshed: Callable[[], None] = lambda: None,
    as_meshed: bool = False,
) -> CondensedGears:
    """The gears of problems of one `shared_gears_name`, condensed once; see `prepare_model`."""
    begin = time.perf_counter()
    # eliminating the pinion, which carries Nitsche's constant term, takes most memory: first, while that is free
    own = [member for member in Member if member % comm.size == comm.rank]
    finest = min(problems, key=lambda problem: problem.torque)
    sector = MeshedSector.as_meshed if as_meshed else MeshedSector.of
    meshes = together(comm, lambda: {member: sector(finest, member, mesh) for member in own})
    after_meshing = time.perf_counter()
    meshed()
    omitted = {member: {_omitted(problem, finest, member) for problem in problems} for member in Member}
    built = _condensed(finest, meshes, omitted, comm, NOT_KEPT if as_meshed else Cache.of_environment())
    pinion, wheel = (shared(comm, built.pop(member, None), member % comm.size) for member in Member)
    seconds = after_meshing - begin, time.perf_counter() - after_meshing
    return CondensedGears(finest, (pinion, wheel), *seconds)


def _omitted(problem: GearProblem, finest: GearProblem, member: Member) -> int:
    """Number of levels of the finest problem's flank that are too fine for this problem."""
    if not is_two_level(finest):
        return 0
    most, own = (len(levelled_sector(each, member).levels) for each in (finest, problem))
    return most - own


def _condensed(
    problem: GearProblem, sectors: Mapping[Member, MeshedSector], omitted: Mapping[Member, Collection[int]],
    comm: MPI.Comm, cache: Cache,
) -> dict[Member, dict[int, GearBody]]:
    """The gears whose meshes this rank has, by how many of the finest levels are omitted. Collective."""
    cores = Cores(comm)
    levelled = {m: each.mesh for m, each in sectors.items() if isinstance(each.mesh, LevelledMesh)}
    plain = {m: each for m, each in sectors.items() if m not in levelled}

    def condensed(member: Member) -> GearBody:
        return plain[member].condensed(problem, member, cores.used, cache)

    built = together(comm, lambda: {member: {0: condensed(member)} for member in plain}, cores.lent)
    if comm.allreduce(len(levelled)):
        counts = {m: sorted(len(each.levels) - number for number in omitted[m]) for m, each in levelled.items()}
        for member, bodies in two_level_pair(problem, levelled, counts, comm, cores, cache).items():
            built[member] = {max(bodies) - count: body for count, body in bodies.items()}
    return built


def _with_flank(body: GearBody, problem: GearProblem, member: Member) -> GearBody:
    """The gear with the modifications of a problem, and its flank as charted there."""
    chart, gear = problem.flanks[member], problem.pair.gears[member]
    worn = None if chart is None else chart.at(gear, body.roll_length, body.z)
    return replace(body, gear=gear, worn=worn)
