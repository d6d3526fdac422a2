"""A sector in levels: a coarse mesh for the body, and finer and finer cells on the loaded flank for the contact."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from evolvent.gears.meshing.element_sizes import (
    DEEPEST,
    LAYER_DEPTHS,
    LEAST_LAYERS,
    LEAST_ROWS,
    FlankNeeds,
    flank_needs,
    sector_resolution,
)
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.axial_layers import fewest_layers
from evolvent_meshes.sector.section import SectorResolution

BODY_ROWS = 13
"""Approximate number of coarse rows of a flank; each level halves them."""
BODY_LAYER = 0.45
"""Largest height of a coarse layer along the face, in normal modules."""
SHEAR = {"quick": 0.425, "standard": 0.55, "fine": 0.425}
"""Elements of the finest level by which a layer may shear the pressure ridge, on average along the profile."""


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
    coarsest = math.ceil(gear.face_width / (BODY_LAYER * gear.normal_module))
    factor = max(1, round((wanted / coarsest) ** (1 / count)))
    layers = max(coarsest, math.ceil(wanted / factor**count), 2 * fewest_layers(gear))  # a companion has half of them
    depths = LAYER_DEPTHS * DEEPEST * gear.normal_module / float(LAYER_DEPTHS.sum())
    coarse = replace(
        sector_resolution(problem, member), profile_elements=rows, face_elements=layers, end_size_ratio=1.0,
        graded_middles=True,
        layer_depths=(float(depths[0]), float(depths[1]), float(depths[2])),
    )
    levels = _levels(count, factor, float(depths[0]), needs)
    wanted_rows = needs.rows * math.sqrt(problem.lightest.torque / problem.torque)  # 2b_H grows with √torque
    return LevelledSector(coarse, tuple(levels[: max(1, math.ceil(math.log2(wanted_rows / rows) - 1e-9))]))


def _levels(count: int, factor: int, depth: float, needs: FlankNeeds) -> list[FlankLevel]:
    """Divisions of a flank's levels. depth: of the first cell below the coarse flank [mm]; on the finest level it is
    that of the first thin layer."""
    result = []
    for left in range(count - 1, -1, -1):
        split = int(np.clip(round(depth / (float(needs.depths[0]) * 2**left)), 1, 3))
        depth /= split
        result.append(FlankLevel(2, factor, (split, 1, 1)))
    return result
