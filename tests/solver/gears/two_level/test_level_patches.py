"""Corrections of a flank: which cells have patches, and what congruence and interpolation change.

Yang's pinion, 2.5 mm wide, 18 × 5 coarse cells on the flank, longer along the face than along the profile, that are
split in depth; Nitsche's functionals on the fine cells.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.fem.material import STEEL
from evolvent.gears.meshing.flank_levels import FlankLevel
from evolvent.gears.two_level import level_patches
from evolvent.gears.two_level.coarse_axis import Axis
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent.gears.two_level.flank_refinement import HELD, coarse_body
from evolvent.gears.two_level.level_patches import REACH, STEEP_REACH, Block, LevelPatches, reach_of
from evolvent.gears.two_level.strips import StripCorrection
from evolvent_meshes.arrays import Floats
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.meshes.sector_cases import gear_and_start


def patches_of(face_width: float, layers: int, flux_safety: float | None) -> LevelPatches:
    """Patches of Yang's pinion with another face width [mm], 18 rows and so many layers of coarse cells."""
    gear, start = gear_and_start("yang pinion")
    gear = replace(gear, face_width=face_width)
    resolution = SectorResolution(
        profile_elements=18, face_elements=layers, end_size_ratio=1.0, flank_start_diameter=start,
        layer_depths=(0.2, 0.25, 0.285),
    )
    body = coarse_body(gear, sector_mesh(gear, resolution), STEEL, FlankLevel(1, 1, (2, 1, 1)))
    return LevelPatches(body, gear.base_radius, gear.twist, HELD, flux_safety)


def correction() -> StripCorrection:
    """Correction from all patches of a flank that carries the pressure."""
    flank = patches_of(2.5, 5, 2.0)
    return flank.correction({patch.block: flank.response(patch).contact for patch in flank.patches()})


@pytest.mark.evidence
@pytest.mark.slow
def test_shared_and_interpolated_responses_are_those_of_one_large_patch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Against one patch that is all of the tooth: the largest difference is below 1.5 % of the largest correction.
    Patches near the edges, shared along the face and interpolated along the profile all take part."""
    found = correction()
    monkeypatch.setattr(level_patches, "REACH", 50.0)
    exact = correction()
    D, C = matrix(found), matrix(exact)
    assert len({strip.moved for strip in found.strips}) > 5
    assert np.abs(D - C).max() < 0.015 * np.abs(C).max()


def test_rows_loaded_with_a_block_are_those_loaded_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Yang's pinion, 1.2 mm wide, 18 × 2 cells of which those at row 3 and 14 are sampled with the blocks at the ends:
    their responses, from those of the blocks, are those to loads on these rows alone in the same patches. Exact, to
    single precision."""
    monkeypatch.setattr(level_patches, "REACH", 0.5)
    flank = patches_of(1.2, 2, None)
    together = flank.patches()
    found = flank.correction({patch.block: flank.response(patch).contact for patch in together})
    rows, _ = flank.axes
    assert len(rows.own) == 2 and {*rows.loaded}.isdisjoint(rows.own) and len(rows.sampled) == 4
    monkeypatch.setattr(Axis, "loaded", property(lambda axis: [*axis.own, *(range(i, i + 1) for i in axis.sampled)]))
    apart = [replace(patch, patch=next(each.patch for each in together if covers(each.block, patch.block)))
             for patch in flank.patches()]
    exact = matrix(flank.correction({patch.block: flank.response(patch).contact for patch in apart}))
    assert np.abs(matrix(found) - exact).max() < 1e-6 * np.abs(exact).max()


def covers(large: Block, small: Block) -> bool:
    """Whether all cells of a block are in another one."""
    return all({*few} <= {*many} for few, many in zip(small, large))


def matrix(correction: StripCorrection) -> Floats:
    """Columns under unit forces."""
    whole = correction.among([np.arange(correction.size)])
    return np.array([whole.times(f.reshape(-1, 3)).ravel() for f in np.eye(3 * correction.size)])


@pytest.mark.parametrize("hand", [1.0, -1.0])
def test_patches_of_steep_helices_reach_further(hand: float) -> None:
    """Base helix angles of 29° and 31°, either hand: half as far again, in edges and on the flank of Yang's pinion."""
    gear, start = gear_and_start("yang pinion")
    resolution = SectorResolution(
        profile_elements=6, face_elements=2, end_size_ratio=1.0, flank_start_diameter=start,
        layer_depths=(0.3, 0.3, 0.3),
    )
    body = coarse_body(gear, sector_mesh(gear, resolution), STEEL, FlankLevel(1, 1, (1,)))
    flank = FlankLattice.of(body.surface.points)
    less, more = (reach_of(flank, hand * float(np.radians(angle))) for angle in (29.0, 31.0))
    assert more / less == pytest.approx(STEEP_REACH / REACH)
    assert less == pytest.approx(REACH * flank.edges().max())
