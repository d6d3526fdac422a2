"""A flank refined in levels: the finest surface, and the correction of the compliance by each level."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.sparse as sp

from evolvent.contact.two_level.fine_surface import CoarseBody
from evolvent.contact.two_level.split_counts import split_counts
from evolvent.fem.material import Material
from evolvent.gears.meshing.flank_levels import FlankLevel
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent.gears.two_level.level_patches import Block, BlockResponse, LevelPatches, Response, reach_of
from evolvent.gears.two_level.refined_level import RefinedLevel
from evolvent_meshes.arrays import Ints
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.flank_points import on_flank

HELD = ("bore", "cut_low", "cut_high")
"""Facet groups of a sector at which patches are held: far from a flank, their displacement is the coarse body's."""


@dataclass(frozen=True)
class FlankRefinement:
    """The loaded flank of a sector in levels.

    gear: without modifications, which do not change the compliance.
    mesh: the coarse sector, its layers of one height.
    material: of the gear.
    levels: from the coarsest to the finest.
    """

    gear: GearParameters
    mesh: MeshData
    material: Material
    levels: Sequence[FlankLevel]

    def bodies(self) -> Iterator[CoarseBody]:
        """Coarse body of each level, whose cells are split to make the level. Below the first level, only cells within
        reach of the flank are split."""
        mesh = self.mesh
        for level in self.levels:
            body = coarse_body(self.gear, mesh, self.material, level)
            yield body
            reach = reach_of(FlankLattice.of(body.surface.points), self.gear.base_helix_angle)
            near = body.near(np.arange(len(body.facets)), reach)
            mesh = body.split_patch(near).mesh


def coarse_body(gear: GearParameters, mesh: MeshData, material: Material, level: FlankLevel) -> CoarseBody:
    """Coarse body from the mesh of a sector, or of the part near its flank, to be split."""
    along = np.full((len(mesh.cells), 3), level.rows)
    along[:, 2] = level.layers  # swept cells have their third axis along the face
    counts = split_counts(mesh, "flank", along, level.below)
    return CoarseBody(mesh, material, "flank", counts, partial(on_flank, gear))


def patches_of_levels(
    refinement: FlankRefinement, counts: Sequence[int], flux_safety: float | None
) -> list[LevelPatches]:
    """The patches of each level, from the coarsest to the finest.

    counts: after how many levels contact is computed: all, or on the same flank under heavier loads fewer.
    flux_safety: see `patch_response`; on the levels where contact is computed.
    """
    gear, result = refinement.gear, []
    for count, body in enumerate(refinement.bodies(), 1):
        safety, is_followed = flux_safety if count in counts else None, count < max(counts)
        result.append(LevelPatches(body, gear.base_radius, gear.twist, HELD, safety, is_followed))
    return result


@dataclass(frozen=True)
class RefinedFlank:
    """The levels of a flank, from the responses of the patches of each.

    patches: of each level.
    responses: of the patches of each.
    """

    patches: Sequence[LevelPatches]
    responses: Sequence[Mapping[Block, BlockResponse]]

    def levels(self, counts: Sequence[int]) -> dict[int, list[RefinedLevel]]:
        """First levels of the flank for each of the counts, the last one with the functionals of the contact. Common
        levels exist once."""
        inner = [self._level(number, lambda each: each.inner) for number in range(max(counts) - 1)]

        def last(number: int) -> RefinedLevel:
            has_inner = number < len(inner) and all(each.nitsche is None for each in self.responses[number].values())
            return inner[number] if has_inner else self._level(number, lambda each: each.contact)

        return {count: [*inner[: count - 1], last(count - 1)] for count in counts}

    def _level(self, number: int, part: Callable[[BlockResponse], Response]) -> RefinedLevel:
        """One of the levels. part: the response that it takes of each patch."""
        here = self.patches[number]
        transfer = here.surface.transfer
        if number > 0:
            before = self.patches[number - 1].surface
            transfer = transfer @ _reordered(before.numbers(here.coarse.points))
        correction = here.correction({block: part(each) for block, each in self.responses[number].items()})
        return RefinedLevel(transfer.tocsr(), correction, here.surface.surface.normals)


def _reordered(numbers: Ints) -> sp.csr_matrix:
    """Takes values of nodes in one order to another, in which node i has the number numbers[i]."""
    n = len(numbers)
    return sp.csr_matrix((np.ones(n), (np.arange(n), numbers)), (n, n))
