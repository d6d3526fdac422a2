"""A wear study of a gear pair: blocks of cycles up to each report, and the checkpoint from which it resumes.

The checkpoint is plain data: depths, the block before, the next block's length, and where each position was searched. A
resumed study takes the same blocks as one that was never stopped.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.operation_figures import VibrationRow
from evolvent.gears.sweep.position_search import SearchedAt
from evolvent.wear.block_stepping import (
    Block,
    BlockSettings,
    PreviousBlock,
    WearState,
    initial_wear_state,
    next_block,
)
from evolvent.wear.gears.gear_wear import GearWear
from evolvent.wear.gears.pitch_state import PitchState, Vibration
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member

ROUNDING = 1e-12  # of the number of cycles


@dataclass(frozen=True)
class BlockRow:
    """An accepted block of cycles, a line of wear.csv."""

    cycles: float
    """Revolutions of the pinion at the end of the block."""
    block_cycles: float
    """Revolutions of the pinion in the block."""
    error: float
    """Estimated volume that the block wears off in the wrong place, over its whole worn volume."""
    refused: int
    """Longer blocks that were tried before and rejected."""
    searched: int
    """Positions whose contact was searched anew."""
    refreshed: int
    """Number of mesh updates so far."""
    deepest_pinion_um: float
    """Largest worn depth of the pinion so far, between the edge margins (0.1 m_n)."""
    deepest_wheel_um: float
    """Largest worn depth of the wheel so far, between the edge margins (0.1 m_n)."""
    volume_pinion_mm3: float
    """Volume worn off a tooth of the pinion so far."""
    volume_wheel_mm3: float
    """Volume worn off a tooth of the wheel so far."""


@dataclass(frozen=True)
class StudyCheckpoint:
    """State from which a wear study is resumed.

    cycles: revolutions of the pinion done.
    depth: (n,) worn depths [mm].
    mesh_depth: (n,) depths that the meshes include [mm].
    previous: the block before; None at the beginning.
    next_length: length of the next block [cycles].
    searches: where the contact was searched, of all positions.
    rows: of all blocks so far.
    vibrations: of the beginning and of all blocks; empty under a constant torque.
    vibration: of the present operation; None under a constant torque.
    """

    cycles: float
    depth: Floats
    mesh_depth: Floats
    previous: PreviousBlock | None
    next_length: float
    searches: tuple[SearchedAt, ...]
    rows: tuple[BlockRow, ...]
    vibrations: tuple[VibrationRow, ...] = ()
    vibration: Vibration | None = None


@dataclass(frozen=True)
class StudyState:
    """State of a study between two blocks.

    state: of the wear.
    rows: of all blocks so far.
    report: whether the pair is to be written out.
    vibrations: of the beginning and of all blocks; empty under a constant torque.
    """

    state: WearState[PitchState]
    rows: tuple[BlockRow, ...]
    report: bool
    vibrations: tuple[VibrationRow, ...] = ()


def study_states(
    gears: GearWear, reports: Sequence[float], settings: BlockSettings, checkpoint: StudyCheckpoint | None = None
) -> Iterator[StudyState]:
    """The state at the beginning, or at the checkpoint, and after each block.

    reports: ascending numbers of cycles at which blocks end; the last one ends the study.

    Raises WearStopped, VolumeLost, NotConverged.
    """
    rows: tuple[BlockRow, ...]
    if checkpoint is None:
        state, rows = initial_wear_state(gears, gears.begin, settings), ()
        vibrations = _vibration(state)
    else:
        state, rows, vibrations = _resumed(gears, checkpoint), checkpoint.rows, checkpoint.vibrations
    yield StudyState(state, rows, checkpoint is None, vibrations)
    while state.cycles < reports[-1] * (1.0 - ROUNDING):
        end = next(float(report) for report in reports if report > state.cycles * (1.0 + ROUNDING))
        block = next_block(gears, state, end, settings)
        state = block.state
        rows, vibrations = (*rows, _row(gears, block)), (*vibrations, *_vibration(state))
        yield StudyState(state, rows, state.cycles >= end * (1.0 - ROUNDING), vibrations)


def checkpoint_of(gears: GearWear, study: StudyState) -> StudyCheckpoint:
    """The checkpoint of a state. All ranks call it."""
    state = study.state
    searches, vibration = tuple(gears.searches(state.evaluation)), gears.vibration(state.evaluation)
    return StudyCheckpoint(
        state.cycles, state.depth, gears.mesh_depth, state.previous, state.next_length, searches, study.rows,
        study.vibrations, vibration,
    )


def _resumed(gears: GearWear, checkpoint: StudyCheckpoint) -> WearState[PitchState]:
    """The state of a checkpoint, on the same meshes and from the same searches."""
    if checkpoint.mesh_depth.any():
        gears.update_meshes(checkpoint.mesh_depth)
    evaluation = gears.resumed(checkpoint.depth, checkpoint.searches, checkpoint.vibration)
    return WearState(checkpoint.cycles, checkpoint.depth, evaluation, checkpoint.previous, checkpoint.next_length)


def _vibration(state: WearState[PitchState]) -> tuple[VibrationRow, ...]:
    """The row of a state; none under a constant torque."""
    operation = state.evaluation.operation
    return () if operation is None else (VibrationRow.after(state.cycles, operation),)


def _row(gears: GearWear, block: Block[PitchState]) -> BlockRow:
    state = block.state
    depths = gears.by_gear(state.depth - gears.begin)
    inner = [grid.inner_nodes(gears.model.pair, gear) for gear, grid in zip(Member, gears.grids)]
    deepest = [1e3 * float(np.max(depth[nodes])) for depth, nodes in zip(depths, inner)]
    width = gears.model.width_factor
    volumes = [width * float(areas @ depth) for areas, depth in zip(gears.by_gear(gears.areas), depths)]
    return BlockRow(
        cycles=state.cycles, block_cycles=block.length, error=block.error, refused=block.refused,
        searched=state.evaluation.searched, refreshed=gears.mesh_updates, deepest_pinion_um=deepest[Member.PINION],
        deepest_wheel_um=deepest[Member.WHEEL], volume_pinion_mm3=volumes[Member.PINION],
        volume_wheel_mm3=volumes[Member.WHEEL],
    )
