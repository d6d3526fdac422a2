"""A sector in levels: a coarse mesh for the body, and finer and finer cells on the loaded flank for the contact."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from evolvent.gears.meshing.element_sizes import (
    LEAST_LAYERS,
    LEAST_ROWS,
    FlankNeeds,
    deepest_layers,
    flank_needs,
    sector_resolution,
)
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.axial_layers import fewest_layers
from evolvent_meshes.sector.section import SectorResolution

BODY_ROWS = 13
"""Approximate number of coarse rows of a flank; each level halves them."""
BODY_LAYER = 0.45
"""Largest height of a coarse layer along the face, in normal modules."""
LONGEST = 3.5
"""Length along the face over that along the profile of the cells that the finest level divides, up to which levels are
used by default. Patches reach over so many of the longer edges; a crowned spur pair with cells five times as long,
380,000 degrees of freedom in one mesh, had all rows in each patch, of 108,000 degrees of freedom."""
LENGTHENED = 2.0
"""How many times as many layers as the contact wants a flank gets, at most, so that its cells are no longer than that:
one mesh in place of levels takes several times as much memory."""
ROUNDED_UP = 1.5
"""Number of coarse layers over the fewest ones from which on a level halves the layers, where there is one that may.
Cells of finer levels are what patches cost: those of Yang's pair at standard take 64 s with two levels that halve, 34 s
with one."""
SHEAR = {"quick": 0.85, "standard": 0.9, "fine": 0.85}
"""Elements of the finest level by which a layer may shear the pressure ridge, on average along the profile. Cells of
the contact follow its lines (`gears.contact.contact_lattice`), those of the body need not. Nine in ten peak pressures
of eight positions of Yang's pair at standard against Hertz with 0.55, 0.82, 0.91, 1.03: 1.26, 1.36, 1.38, 1.61 %."""


@dataclass(frozen=True)
class FlankLevel:
    """Division of the cells below the flank that makes a finer level."""

    rows: int
    """Number of parts along the profile."""
    layers: int
    """Number of parts along the face."""
    below: tuple[int, ...]
    """Numbers of parts in depth: of the first cell below the flank, the second, ..."""


@dataclass(frozen=True)
class LevelledSector:
    """The coarse sector and the levels of its flank."""

    coarse: SectorResolution
    """Resolution of the coarse sector."""
    levels: tuple[FlankLevel, ...]
    """Levels of the flank from the coarsest to the finest, which resolves the contact."""


def levelled_sector(problem: GearProblem, member: Member) -> LevelledSector:
    """The levels of the pinion's or the wheel's flank: on the finest one the elements are as long as the contact needs
    them, and the ridge is sheared by `SHEAR` elements in a layer. Problems whose meshes serve the same torques have the
    same coarse sector, and as many of the same levels as each needs."""
    needs, gear, level = flank_needs(problem, member, levels=True), problem.pair.gears[member], problem.mesh.level
    count = max(1, round(math.log2(needs.rows / BODY_ROWS)))
    rows = 3 * max(LEAST_ROWS, math.ceil(needs.rows / 2**count / 3))
    wanted = max(LEAST_LAYERS[level], math.ceil(needs.shear / SHEAR[level]))
    resolution = sector_resolution(problem, member)
    shortest = math.ceil(length_over_height(gear, resolution, rows * 2 ** (count - 1), 1) / LONGEST)
    shortest = shortest if shortest <= LENGTHENED * wanted else 0
    coarsest = math.ceil(gear.face_width / (BODY_LAYER * gear.normal_module))
    factors = _layer_factors(count, max(wanted, shortest) / coarsest)
    # a companion has half of them
    fewest = max(coarsest, 2 * fewest_layers(gear), math.ceil(shortest / math.prod(factors[:-1])))
    layers = max(fewest, math.ceil(wanted / math.prod(factors)))
    depths = deepest_layers(gear)
    coarse = replace(
        resolution, profile_elements=rows, face_elements=layers, end_size_ratio=1.0,
        graded_middles=True,
        layer_depths=(float(depths[0]), float(depths[1]), float(depths[2])),
    )
    levels = _levels(factors, float(depths[0]), needs)
    wanted_rows = needs.rows * math.sqrt(problem.lightest.torque / problem.torque)  # 2b_H grows with √torque
    return LevelledSector(coarse, tuple(levels[: max(1, math.ceil(math.log2(wanted_rows / rows) - 1e-9))]))


def length_over_height(gear: GearParameters, resolution: SectorResolution, rows: int, layers: int) -> float:
    """Length of a flank's cells along the face over that along the profile, on average, of a number of each.

    resolution: of the gear's sector, which says where the flank starts.
    """
    lowest = resolution.flank_start_diameter or gear.root_form_diameter
    start, tip = gear.roll_length(lowest), gear.roll_length(gear.tip_diameter)
    arc = (tip**2 - start**2) / (2.0 * gear.base_radius)
    along_face = gear.face_width / np.cos(np.radians(gear.helix_angle_deg)) / layers
    return float(along_face / (arc / rows))


def _layer_factors(count: int, refined: float) -> list[int]:
    """Numbers of parts into which `count` levels divide the layers, larger ones first. refined: number of the finest
    layers over the fewest coarse ones."""
    halved = max(0, math.ceil(math.log2(refined / ROUNDED_UP) - 1e-9))
    if halved > count:
        return [round(refined ** (1 / count))] * count
    return [2] * halved + [1] * (count - halved)


def _levels(factors: list[int], depth: float, needs: FlankNeeds) -> list[FlankLevel]:
    """Divisions of a flank's levels. factors: parts along the face on each; depth: of the first cell below the coarse
    flank [mm]; on the finest level it is that of the first thin layer."""
    result = []
    for left, factor in zip(range(len(factors) - 1, -1, -1), factors):
        split = int(np.clip(round(depth / (float(needs.depths[0]) * 2**left)), 1, 3))
        depth /= split
        result.append(FlankLevel(2, factor, (split, 1, 1)))
    return result
