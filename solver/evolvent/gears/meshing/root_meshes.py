"""Sector meshes with finer roots, where the stress there is wanted: contact and deflection need less.

Displacements of the roots' nodes are condensed with the flank (`condensed_gear`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evolvent.gears.meshing.companion_meshes import coarser
from evolvent.gears.meshing.flank_levels import LevelledSector
from evolvent.gears.meshing.levelled_meshes import SectorMesh, is_two_level, levelled_mesh
from evolvent.gears.meshing.sector_meshes import Adaption, gear_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.section import SectorResolution

LOADED_ROOT = "fillet"
"""Facet group from the start of the loaded flank's mesh to the middle of the space."""
BACK_ROOT = "back_root"
"""Facet group of the back up to the same radius; only meshes for root stress have it."""
FINER = 2
"""Elements around a fillet over those of a run, which has six. Largest tension of Zhang's pair in plane strain, over
the limit of finer ones: 1.020 with six elements, 1.005 with twelve, 1.001 with 24."""

LEAST_RIM = 3
"""Least number of rows between the cells below the fillets and the bore. They grow from thin ones: of two the second is
most of the rim, and the tension of Zhang's pair in space was 12 % too low; three rows are 0.1 % off four."""


def finer_roots(sector: SectorResolution, times: int = FINER) -> SectorResolution:
    """Resolution with `times` as many elements around both fillets and across the tooth's core, and cells so much
    thinner below the fillets.

    With the run's two columns of core the compression of He's pair's back was 0.9 % too low, with four 0.2 %. With
    cells as deep as those of a run the tension of Zhang's tight fillets was 1.6 % too low, however many there were;
    with half the depth 0.1 %. Where the layers below the flank are thick, as in space, the cells below the fillets are
    not: with layers of twice the thickness they made the tension 2.9 % too low, else 0.8 %.
    """
    return replace(
        sector, fillet_elements=times * sector.fillet_elements, back_elements=times * sector.back_elements,
        neck_elements=times * sector.neck_elements, core_elements=times * sector.core_elements,
        band_depth=sector.band_depth / times, band_below_layers=False,
    )


@dataclass(frozen=True)
class RootMesh:
    """Makes the mesh of a run with finer roots, and with `BACK_ROOT`."""

    times: int = FINER
    """Factor on the number of elements around the fillets, see `finer_roots`."""
    coarse: bool = False
    """Whether elements have twice the size, for error bars; in the rim as far as `LEAST_RIM` allows."""

    def __call__(self, problem: GearProblem, member: Member) -> SectorMesh:
        """Mesh of the pinion's or the wheel's sector with finer roots. Raises MeshError, TooMuchRelief."""
        return adapted_root_mesh(problem, member, self._adapted)

    def _adapted(self, sector: SectorResolution) -> SectorResolution:
        fine = finer_roots(sector, self.times)
        if not self.coarse:
            return fine
        coarse = coarser(fine)
        return replace(coarse, rim_elements=max(coarse.rim_elements, LEAST_RIM))


def adapted_root_mesh(problem: GearProblem, member: Member, adapted: Adaption) -> SectorMesh:
    """The mesh of a run, its sector's resolution changed by `adapted`, with `BACK_ROOT`. Raises MeshError,
    TooMuchRelief."""
    if not is_two_level(problem):
        return with_back_root(gear_mesh(problem, member, adapted))

    def of_coarse(levels: LevelledSector) -> LevelledSector:
        return replace(levels, coarse=adapted(levels.coarse))

    levelled = levelled_mesh(problem, member, of_coarse)
    return replace(levelled, mesh=with_back_root(levelled.mesh))


def with_back_root(mesh: MeshData) -> MeshData:
    """A sector with the further group `BACK_ROOT`."""
    back, top = mesh.facets["back"], _radii(mesh, mesh.facets[LOADED_ROOT]).max()
    low = (_radii(mesh, back) <= top * (1.0 + 1e-9)).all(axis=1)
    return replace(mesh, facets=mesh.facets | {BACK_ROOT: back[low]})


def _radii(mesh: MeshData, facets: Ints) -> Floats:
    return np.asarray(np.hypot(*mesh.points[facets][..., :2].transpose(2, 0, 1)))


def root_nodes(mesh: MeshData) -> Ints:
    """Nodes (k,) of both roots, ascending; none where the mesh was not made for root stress."""
    if BACK_ROOT not in mesh.facets:
        return np.empty(0, dtype=np.int64)
    return np.unique(np.concatenate([mesh.facets[name].ravel() for name in (LOADED_ROOT, BACK_ROOT)]))
