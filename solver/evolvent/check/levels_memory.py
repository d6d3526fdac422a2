"""Memory of gears whose flanks have levels of their own, estimated from the numbers of cells.

Three times of a run want most: a coarse sector is eliminated, a patch is condensed, a position is solved. Fitted to
runs of Yang's pair and of 23/81 teeth at 50 and 10 N·m, see *Whole runs* in docs/benchmark.md.
"""

from __future__ import annotations

from collections.abc import Sequence

from evolvent.gears.meshing.flank_levels import LevelledSector
from evolvent.gears.meshing.sector_sizes import LevelledSize
from evolvent_meshes.gears.member import Member

POSITION_PER_DOF, POSITION_PER_LEVEL = 2.0e-3, 700.0
"""Memory [MB] of corrections and of a position on two ranks: per degree of freedom of both finest flanks, and for each
level after the first."""
OWN = 0.5
"""Part of the memory of positions on two ranks that each rank has."""
PATCH_PER_NODE = {False: 0.88, True: 1.21}
"""Memory [MB] of condensing a patch per node of its flank, without and with the functionals of Nitsche's method, which
the finest level of the pinion has."""
PATCH_LAYERS, PATCH_ROWS, WHOLE_PROFILE = 5, 9, 17
"""Coarse layers and rows of a level that the largest patch has, but all rows where there are no more than the last of
these (`evolvent.gears.two_level.coarse_axis.Axis`)."""


def levels_megabytes(sectors: Sequence[LevelledSector], ranks: int) -> float:
    """Memory [MB] beside the elimination of the sectors of pinion and wheel, on so many ranks of one machine: both
    compliances with the largest patch, of both gears on several ranks, or with the memory of positions."""
    sizes = [LevelledSize.of(sector) for sector in sectors]
    pinion, wheel = (_patch_megabytes(sector, member) for sector, member in zip(sectors, Member))
    patches = max(pinion, wheel) if ranks == 1 else pinion + wheel
    later = max(len(sector.levels) for sector in sectors) - 1
    positions = POSITION_PER_DOF * sum(size.flank for size in sizes) + POSITION_PER_LEVEL * later
    compliances = sum(8e-6 * size.sector.flank**2 for size in sizes)
    return compliances + max(patches, OWN * ranks * positions)


def _patch_megabytes(sector: LevelledSector, member: Member) -> float:
    """Memory [MB] of the largest patch of a gear."""
    last = len(sector.levels) - 1
    return max(
        PATCH_PER_NODE[member is Member.PINION and number == last] * nodes
        for number, nodes in enumerate(_patch_nodes(sector))
    )


def _patch_nodes(sector: LevelledSector) -> list[int]:
    """Number of flank nodes of the largest patch of each level."""
    rows, layers, found = sector.coarse.profile_elements, sector.coarse.face_elements, []
    for level in sector.levels:
        here = rows if rows <= WHOLE_PROFILE else PATCH_ROWS
        found.append((2 * level.rows * here + 1) * (2 * level.layers * min(layers, PATCH_LAYERS) + 1))
        rows, layers = level.rows * rows, level.layers * layers
    return found
