"""The mesh of a sector as it is shown, and as it is condensed: without the modifications of its flank."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from evolvent.fem.cache.cache import Cache
from evolvent.fem.parallel.cores import Threads
from evolvent.fem.surface import surface_of
from evolvent.gears.condensed_gear import GearBody, condensed_gear
from evolvent.gears.meshing.levelled_meshes import SectorMesh
from evolvent.gears.meshing.sector_meshes import unmodified
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData

Mesher = Callable[[GearProblem, Member], SectorMesh]
"""Function that makes the sector mesh of the pinion or the wheel; with levels, the gear is condensed in levels."""


@dataclass(frozen=True)
class MeshedSector:
    """A sector of the pinion or the wheel.

    Reliefs of some micrometres change the compliance of a tooth by less than a thousandth (docs/cache.md), and the gap
    by all they are. So a sector is condensed without them: gears whose reliefs vary are condensed once.
    """

    mesh: SectorMesh
    """Mesh of the sector, the flank of one mesh with its modifications."""
    bare: MeshData | None
    """Cells of `mesh` on a flank without modifications, which are condensed; None: `mesh` is."""

    @staticmethod
    def as_meshed(problem: GearProblem, member: Member, mesh: Mesher) -> MeshedSector:
        """Meshes a sector that is condensed as it is. Raises MeshError, TooMuchRelief."""
        return MeshedSector(mesh(problem, member), None)

    @staticmethod
    def of(problem: GearProblem, member: Member, mesh: Mesher) -> MeshedSector:
        """Meshes a sector. Raises MeshError, TooMuchRelief."""
        made, gear = mesh(problem, member), problem.pair.gears[member]
        is_bare = gear.modifications.is_empty or problem.is_line or problem.options.whole_gears
        if is_bare or not isinstance(made, MeshData):
            return MeshedSector(made, None)
        gears = tuple(map(unmodified, problem.pair.gears))
        pair = replace(problem.pair, pinion=gears[Member.PINION], wheel=gears[Member.WHEEL])
        options = replace(problem.options, in_space=not problem.is_plane)  # also where crowning alone makes it so
        bare = mesh(replace(problem, pair=pair, options=options), member)
        if isinstance(bare, MeshData) and bare.points.shape == made.points.shape:
            return MeshedSector(made, bare)
        return MeshedSector(made, None)

    def condensed(self, problem: GearProblem, member: Member, threads: Threads, cache: Cache) -> GearBody:
        """The gear of a sector that is one mesh. Raises NotPositiveDefinite, OutOfMemory."""
        assert isinstance(self.mesh, MeshData)
        gear = problem.pair.gears[member]
        body = condensed_gear(
            gear, self.mesh if self.bare is None else self.bare, problem.materials[member], problem.contact_teeth,
            member, member is Member.PINION and not problem.is_line, whole=problem.options.whole_gears,
            threads=threads, cache=cache,
        )
        if self.bare is None:
            return body
        return replace(body, mesh=self.mesh, bare=self.bare, flank=surface_of(self.mesh, "flank"))
