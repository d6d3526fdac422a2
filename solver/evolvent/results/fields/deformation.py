"""Displacement and stress inside the teeth in contact, recovered from the nodal forces on their flanks.

The results of a run hold flanks only, since condensation eliminates the interior of a sector. Both gears are condensed
once more. The displacements of the cut faces follow from the forces on all teeth, and one factorisation a gear gives
the displacement of each sector.

Where flanks have levels of their own, it is the coarse sector's displacement under the forces that its shape functions
make of those on the finest level: right but for a few coarse cells about the contact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from mpi4py import MPI

from evolvent.fem.condensation.schur_complement import SectorRecovery
from evolvent.fem.parallel.ranks import together
from evolvent.fem.stress import cell_stress
from evolvent.gears.condensed_gear import GearBody, sector_body, sector_parts
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.ring.ring_compliance import ChainedCompliance
from evolvent.gears.sweep.position_result import NodalForces, PositionResult, nodal_forces
from evolvent.gears.two_level.two_level_ring import TwoLevelRing
from evolvent.results.archive.archive import Archive
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.rotation import turn


@dataclass(frozen=True)
class DeformedTooth:
    """A loaded sector of a gear, in the sector's own frame."""

    gear: Member
    """Pinion or wheel."""
    tooth: int
    """Index of the tooth pair."""
    mesh: MeshData
    """Mesh of the sector."""
    displacement: Floats
    """(N, d), displacement of the nodes [mm]."""
    stress: Floats
    """(cells, 3, 3), stress at the centres of the cells [MPa]."""


class GearField:
    """Displacements of one gear under the contact forces of several positions.

    body: the condensed gear.
    loads: the forces on its flanks.
    """

    def __init__(self, body: GearBody, loads: NodalForces) -> None:
        self._rows, self._forces = loads.rows, loads.forces
        if isinstance(body.chain, TwoLevelRing):
            self._rows, self._forces = body.chain.on_coarse_nodes(loads.rows, loads.forces)
            body = body.coarse
        assert isinstance(body.chain, ChainedCompliance)
        self.body, self._pitch = body, 2.0 * np.pi / body.gear.z
        self._cuts = body.chain.cut_displacements(self._rows, self._forces)
        elastic = sector_body(body.condensed_mesh, body.material, body.member)
        parts = sector_parts(elastic, body.flank, body.traction, self._pitch)
        self._free, number = parts.free, np.full(parts.stiffness.shape[0], -1)
        number[self._free] = np.arange(len(self._free))
        K, P = parts.stiffness[self._free][:, self._free], parts.functionals[:, self._free]
        self._recovery = SectorRecovery(K, P, number[parts.low], number[parts.high])

    def teeth(self, k: int) -> list[int]:
        """Numbers of the gear's loaded teeth at position k."""
        return np.unique(self._rows[self._forces[k].any(axis=1), 0]).tolist()

    def displacement(self, k: int, number: int) -> Floats:
        """Displacement (N, d) [mm] of a tooth's sector at position k, in the sector's own frame."""
        d, here = self.body.d, self._rows[:, 0] == number
        forces = np.zeros((len(self.body.flank.points), d))
        forces[self._rows[here, 1]] = self._forces[k, here] @ turn(number * self._pitch, d)
        field = np.zeros(len(self.body.mesh.points) * d)
        field[self._free] = self._recovery.displacement(forces.ravel(), self._cuts[number][k])
        return field.reshape(-1, d)


@dataclass(frozen=True)
class Deformation:
    """Deformation of both gears at the positions of a pitch, at the first friction coefficient."""

    gears: tuple[GearField, GearField]
    """Displacements of pinion and wheel."""

    @staticmethod
    def of(bodies: tuple[GearBody, GearBody], results: Sequence[PositionResult]) -> Deformation:
        """The deformation of two condensed gears under the results of the positions."""
        pinion, wheel = (GearField(body, nodal_forces(results, body.member)) for body in bodies)
        return Deformation((pinion, wheel))

    def teeth(self, k: int) -> list[DeformedTooth]:
        """The loaded teeth of both gears at position k."""
        return [self._tooth(gear, k, number) for gear in Member for number in self.gears[gear].teeth(k)]

    def _tooth(self, gear: Member, k: int, number: int) -> DeformedTooth:
        body, u = self.gears[gear].body, self.gears[gear].displacement(k, number)
        return DeformedTooth(gear, body.member.sign * number, body.mesh, u, cell_stress(body.mesh, body.material, u))


def deformation_of(scene: Scene, archive: Archive, comm: MPI.Comm) -> Deformation | None:
    """Deformation of the run in the archive, on rank 0; None on other ranks. Collective. Raises ArchiveError and the
    errors of `prepare_model`."""
    problem = gear_problem(scene)
    one_sector = replace(problem, options=replace(problem.options, whole_gears=False))
    bodies = prepare_model(one_sector, comm).model.bodies

    def recovered() -> Deformation:
        positions = archive.read_positions(scene.gear_pair())
        return Deformation.of(bodies, [position.results[0] for position in positions])

    return together(comm, lambda: recovered() if comm.rank == 0 else None)
