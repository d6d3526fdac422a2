"""A wear study of a gear pair, whose meshes follow or not, stopped and resumed."""

from __future__ import annotations

from dataclasses import astuple, replace
from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from evolvent.dynamics.operating_point import OperatingPoint
from evolvent.dynamics.pair_model import DriveSettings
from evolvent.wear.block_stepping import BlockSettings
from evolvent.wear.gears.gear_study import StudyCheckpoint, StudyState, checkpoint_of, study_states
from evolvent.wear.gears.gear_wear import GearWear
from tests.support.gear_wear_cases import wear_scene, wearing_gears

Study = tuple[GearWear, list[StudyState], StudyCheckpoint]


def watched(gears: GearWear, reports: tuple[float, ...], first_block: float, number: int) -> Study:
    """A study without a stop, and the checkpoint at one of its states."""
    states: list[StudyState] = []
    for state in study_states(gears, reports, BlockSettings(first_block)):
        states.append(state)
        if len(states) == number + 1:
            kept = checkpoint_of(gears, state)
    return gears, states, kept


@cache
def studied(refresh: float) -> Study:
    """A spur pair worn by 3 µm, with the checkpoint after the third block."""
    return watched(wearing_gears(wear_scene("spur"), 8, refresh), (2e5, 8e5), 4e4, 4)


def test_study_depths_do_not_depend_on_mesh_updates() -> None:
    """Problem: meshes that follow each 0.5 µm, or not at all. Exact: the same depths, within 1 % of the volume."""
    (never, fixed, _), (often, moved, _) = studied(np.inf), studied(5e-4)
    assert never.mesh_updates == 0 and often.mesh_updates >= 3
    one, other = fixed[-1].state.depth, moved[-1].state.depth
    assert never.areas @ np.abs(one - other) < 0.01 * never.areas @ one
    assert [stage.report for stage in moved].count(True) == 3


def test_resumed_study_takes_the_same_blocks() -> None:
    """Problem: a study resumed by other objects from a checkpoint after the third block, when the meshes had followed.
    Exact: the blocks and depths of the study without a stop, within 1e-9 of the largest depth."""
    _, whole, kept = studied(5e-4)
    assert kept.mesh_depth.any()
    second = wearing_gears(wear_scene("spur"), 8, 5e-4)
    rest = list(study_states(second, (2e5, 8e5), BlockSettings(4e4), kept))
    assert [s.state.cycles for s in rest] == pytest.approx([s.state.cycles for s in whole[4:]], rel=1e-9)
    deepest = whole[-1].state.depth.max()
    np.testing.assert_allclose(rest[-1].state.depth, whole[-1].state.depth, atol=1e-9 * deepest)


POINT = OperatingPoint(DriveSettings((7.65, 7.65), 0.03, 0.05), 3000.0, "up", (0.25, 1.0, 2.0), 8)


def vibrating(speed: float) -> GearWear:
    """A spur pair that wears under the mesh force at a speed [r/min]."""
    gears = wearing_gears(wear_scene("spur"), 4, 5e-4)
    point = replace(POINT, speed=speed)
    return GearWear(gears.model, gears.pitch, 0.0, gears.law, MPI.COMM_SELF, gears.mesh_motion, point)


def test_a_slow_pair_wears_as_under_its_torque() -> None:
    """At 2 r/min the mesh force is the constant one. Exact: the depths of a study under it, within the 1e-3 of the
    force that inertia takes."""
    still = wearing_gears(wear_scene("spur"), 4, 5e-4)
    one, other = (list(study_states(gears, (4e4,), BlockSettings(2e4)))[-1] for gears in (still, vibrating(2.0)))
    assert other.state.depth == pytest.approx(one.state.depth, rel=0, abs=2e-3 * one.state.depth.max())
    assert [row.cycles for row in other.vibrations] == [0.0, *(row.cycles for row in other.rows)]
    assert one.vibrations == ()


@pytest.mark.evidence
def test_wear_and_vibration_change_each_other_and_resume() -> None:
    """Problem: worn by some µm at 3000 r/min. Exact: the volume that wears off is not that under the constant torque;
    the unloaded transmission error grows; and a study resumed by other objects after the second block has the depths
    and the vibration of one without a stop, within 1e-9."""
    reports, settings = (1e5, 4e5), BlockSettings(5e4)
    first, whole, kept = watched(vibrating(3000.0), reports, settings.first, 2)
    errors = [row.unloaded_peak_to_peak_um for row in whole[-1].vibrations]
    assert errors[-1] > 2.0 * errors[0]
    still = list(study_states(wearing_gears(wear_scene("spur"), 4, 5e-4), reports, settings))
    volumes = [float(first.areas @ stage.state.depth) for stage in (still[-1], whole[-1])]
    assert abs(volumes[1] / volumes[0] - 1.0) > 1e-3
    rest = list(study_states(vibrating(3000.0), reports, settings, kept))
    deepest = whole[-1].state.depth.max()
    np.testing.assert_allclose(rest[-1].state.depth, whole[-1].state.depth, atol=1e-9 * deepest)
    for row, wanted in zip(rest[-1].vibrations, whole[-1].vibrations, strict=True):
        assert astuple(row) == pytest.approx(astuple(wanted), rel=1e-9, abs=1e-9)
