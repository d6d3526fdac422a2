"""The cost of a pair's excitation and of its vibration over the speed: CPU seconds of one process with one thread.

Without the start of Python and without error bars, whose coarse companion is solved in addition. What the
ratio of the blocks divides is measured twice in turn, and the lesser seconds count; the helical pair, which takes
minutes, once.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import nan
from pathlib import Path

from mpi4py import MPI

from evidence.benchmarks.accuracy.error_bars import SCENES
from evidence.benchmarks.motion.motion_row import MotionRow
from evidence.calls import temporary_call
from evidence.checkout import DEMOS
from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.of_scene import drive_settings, operating_point
from evolvent.dynamics.pair_model import drive
from evolvent.fem.backend import dolfinx_compat
from evolvent.run.dynamics.excitation import solved_excitation
from evolvent.run.dynamics.scene_torques import scene_torques
from evolvent.run.dynamics.speeds import sweep_at, sweep_list
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene
from evolvent.scene.schema.output import OutputSection
from evolvent.wear.archard import Archard
from evolvent.wear.block_stepping import BlockSettings
from evolvent.wear.gears.solver import wear_study, wearing_pair

PERCENTS = 5.0, 15.0, 30.0, 50.0, 75.0, 100.0, 150.0, 200.0
"""Torques of an excitation, in percent of the scene's, as `evolvent excitation` takes them."""
EXCITATION_BAR, SPEEDS_BAR, TORQUES_BAR, LOOP_BAR = 15.0, 10.0, 2.0, 3.0
"""[s], [s], seconds over seconds: docs/dynamics.md."""
LAST_CYCLES = 4e5
"""Of the wear of He's pair, which is divided evenly into blocks."""
TURNS = 2
LOOSE = 0.5
"""Error that is allowed in a block: the number of blocks is given."""


@dataclass(frozen=True)
class DynamicsSizes:
    """What is run."""

    level: str
    """Of both pairs' meshes."""
    positions: int
    """Of the spur pair's pitch."""
    helical_positions: int
    percents: tuple[float, ...]
    """Torques; 100 among them."""
    speeds: int
    blocks: int
    """Of cycles that wear."""


FULL = DynamicsSizes("standard", 40, 20, PERCENTS, 400, 20)
SMALL = DynamicsSizes("quick", 6, 3, (50.0, 100.0, 200.0), 10, 2)


def rows(sizes: DynamicsSizes) -> Iterator[MotionRow]:
    """He's pair, its speeds, and the narrow helical pair at all torques over the same at one."""
    dolfinx_compat.silence_logs()
    count = len(sizes.percents)
    plane = _scene(DEMOS / "he2022.toml", sizes.level, sizes.positions)
    _, seconds = _excitation(plane, sizes.percents)
    yield MotionRow(f"excitation of He's pair, {sizes.positions} positions, {count} torques", seconds, nan,
                      EXCITATION_BAR)
    yield _speeds(sizes)
    helical = _scene(SCENES / "narrow_helical.toml", "quick", sizes.helical_positions)
    whole, one = (_excitation(helical, percents)[1] for percents in (sizes.percents, (100.0,)))
    yield MotionRow(
        f"excitation of a helical pair, {sizes.helical_positions} positions, {count} torques over one", whole, one,
        TORQUES_BAR,
    )
    loop = [[_blocks(sizes, vibrates) for vibrates in (True, False)] for _ in range(TURNS)]
    whole, one = (min(each) for each in zip(*loop))
    yield MotionRow(f"{sizes.blocks} blocks of wear with vibration over as many without", whole, one, LOOP_BAR)


def _blocks(sizes: DynamicsSizes, vibrates: bool) -> float:
    """CPU seconds of blocks of wear of He's pair at quick, half as many positions as for the excitation; the unworn
    pair, which both have, not counted."""
    percents = ", ".join(f"{percent:g}" for percent in sizes.percents)
    settings = f"dynamics.torque_percents=[{percents}]"
    scene = _scene(DEMOS / "he2022_wear.toml", "quick", max(sizes.positions // 2, 2), settings)
    wear, point = scene.wear, operating_point(scene) if vibrates else None
    assert wear is not None
    law = Archard(wear.pinion_mm2_per_N, wear.wheel_mm2_per_N)
    pair = wearing_pair(gear_problem(scene), law, 0.0, scene.sweep.positions, comm=MPI.COMM_SELF, operating=point)
    reports = [LAST_CYCLES * (k + 1) / sizes.blocks for k in range(sizes.blocks)]
    states = wear_study(pair, reports, BlockSettings(reports[0], LOOSE))
    next(states)
    begin = time.process_time()
    rows = [state.rows for state in states][-1]
    assert len(rows) == sizes.blocks
    return time.process_time() - begin


def _scene(path: Path, level: str, positions: int, *settings: str) -> Scene:
    return load_scene(path, [f"mesh.level={level}", f"sweep.positions={positions}", "contact.friction=0", *settings])


def _excitation(scene: Scene, percents: Sequence[float]) -> tuple[MeshExcitation, float]:
    """And its CPU seconds, from meshing on."""
    loads = scene_torques(scene.model_copy(update={"output": OutputSection(error_bars=False)}), percents)
    begin = time.process_time()
    with temporary_call() as call:
        excitation = solved_excitation(call, loads).excitation
    return excitation, time.process_time() - begin


def _speeds(sizes: DynamicsSizes) -> MotionRow:
    """Steady states at all speeds, running up and down, on the force surface of He's pair; its code compiled before."""
    scene = _scene(DEMOS / "he2022_dynamics.toml", sizes.level, sizes.positions, f"dynamics.speeds={sizes.speeds}")
    section = scene.dynamics
    assert section is not None
    percents = sorted(section.torque_percents)
    excitation, _ = _excitation(scene, percents)
    pair = scene.gear_pair()
    load = float(excitation.loaded.forces[percents.index(100.0)])
    vibrating = drive(pair, excitation, load, drive_settings(pair, section))
    sweep_at(vibrating, sweep_list(vibrating.natural_speed, section.model_copy(update={"speeds": 2})))
    begin = time.process_time()
    sweep_at(vibrating, sweep_list(vibrating.natural_speed, section))
    what = f"{sizes.speeds} speeds both ways, with folds"
    return MotionRow(what, time.process_time() - begin, nan, SPEEDS_BAR)
