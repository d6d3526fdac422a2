"""A gear pair's wear study: blocks of cycles up to each report, one row of facts a block, and what is kept of it.

What is kept is a value that a file can hold: depths, the rate before, the next block's length, and where each position
was searched, so that a study that goes on from it takes the same blocks as one that was never stopped.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.gears.sweep.position import SearchedAt
from evolvent.wear.block_stepping import Block, BlockSettings, WearState, next_block, unworn
from evolvent.wear.gears.gear_wear import GearWear, PitchState
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

ROUNDING = 1e-12  # of the number of cycles


@dataclass(frozen=True)
class BlockRow:
    """A finished block of cycles."""

    cycles: float
    """Revolutions of the pinion at its end."""
    block_cycles: float
    """Revolutions in it."""
    error: float
    """Share of its worn volume that may be taken off in the wrong place."""
    refused: int
    """Longer blocks that were tried before and refused."""
    searched: int
    """Positions that were searched anew."""
    refreshed: int
    """How often the meshes have followed the wear so far."""
    deepest_pinion_um: float
    """Deepest wear so far between the tip-edge zones, pinion."""
    deepest_wheel_um: float
    """The same of the wheel."""
    volume_pinion_mm3: float
    """Worn off a tooth so far, pinion."""
    volume_wheel_mm3: float
    """The same of the wheel."""


@dataclass(frozen=True)
class Kept:
    """What a study goes on from: see WearState; known: depths (n,) that the meshes have; searches: of all angles; rows:
    of the blocks so far."""

    cycles: float
    depth: Floats
    known: Floats
    last: tuple[Floats, float] | None
    length: float
    searches: tuple[SearchedAt, ...]
    rows: tuple[BlockRow, ...]


@dataclass(frozen=True)
class Stage:
    """A state of the study. rows: of all blocks so far. report: whether it is to be written out."""

    state: WearState[PitchState]
    rows: tuple[BlockRow, ...]
    report: bool


def stages(
    gears: GearWear, reports: Sequence[float], settings: BlockSettings, kept: Kept | None = None
) -> Iterator[Stage]:
    """The state at the beginning (or that was kept) and after each block; blocks end at the reports, the last of which
    ends the study. Raises WearStopped, VolumeLost, NotConverged."""
    rows: tuple[BlockRow, ...]
    if kept is None:
        state, rows = unworn(gears, gears.begin, settings), ()
    else:
        if kept.known.any():
            gears.follow(kept.known)
        now = gears.resumed(kept.depth, kept.searches)
        state, rows = WearState(kept.cycles, kept.depth, now, kept.last, kept.length), kept.rows
    yield Stage(state, rows, kept is None)
    while state.cycles < reports[-1] * (1.0 - ROUNDING):
        end = next(float(report) for report in reports if report > state.cycles * (1.0 + ROUNDING))
        block = next_block(gears, state, end, settings)
        state = block.state
        rows = (*rows, _row(gears, block))
        yield Stage(state, rows, state.cycles >= end * (1.0 - ROUNDING))


def kept_of(gears: GearWear, stage: Stage) -> Kept:
    """All ranks must call it."""
    state = stage.state
    searches = tuple(gears.searches(state.now))
    return Kept(state.cycles, state.depth, gears.known, state.last, state.length, searches, stage.rows)


def _row(gears: GearWear, block: Block[PitchState]) -> BlockRow:
    state = block.state
    depths = gears.by_gear(state.depth - gears.begin)
    width = gears.model.pair.face_width if gears.model.bodies[0].d == 2 else 1.0
    inner = [grid.inner(gears.model.pair, gear) for gear, grid in zip(Member, gears.grids)]
    deepest = [1e3 * float(np.max(depth[own])) for depth, own in zip(depths, inner)]
    volumes = [width * float(areas @ depth) for areas, depth in zip(gears.by_gear(gears.areas), depths)]
    return BlockRow(
        state.cycles, block.length, block.error, block.refused, state.now.searched, gears.refreshed, *deepest, *volumes
    )
