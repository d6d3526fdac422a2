"""`python -m evidence.robustness.study_map [--out docs]`: what a map of misalignment and torque costs over one sweep.

Yang's pair at quick, 8 misalignments under 8 torques, with error bars: processor time of condensing, and of some
positions in both ways, from which that of all follows. Five minutes of a core of its own.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evidence.checkout import DOCS, ROOT
from evidence.robustness.studies import Measured
from evidence.tables import write_rows
from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh
from evolvent.dynamics.excitation.misaligned_mesh import misaligned_figures
from evolvent.gears.gear_model import GearModel, Mesher
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.shared_gears import SharedGears
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.run.study.plan.study_file import load_study
from evolvent.run.study.plan.study_scenes import study_scenes
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.arrays import Floats

STUDY = ROOT / "demos/studies/yang2022_misalignment.toml"
SOLVED = 3
"""Positions that are solved, of those of a pitch."""


def processor_time(work: Callable[[], object]) -> float:
    """Of a call [s]."""
    begin = time.process_time()
    work()
    return time.process_time() - begin


def measured() -> list[Measured]:
    """Processor time of condensing, of a position in a sweep and in the map, and of the whole."""
    scenes = [each.scene for each in study_scenes(load_study(STUDY), STUDY, (), "") if each.scene is not None]
    gears, condensing, sweep, of_map = SharedGears([gear_problem(scene) for scene in scenes]), 0.0, 0.0, 0.0
    positions = scenes[0].sweep.positions
    angles = np.array(uniform_pitch(scenes[0].pinion.teeth, positions).angles)[:SOLVED]
    for mesh in (run_mesh, companion_mesh):
        condensing += processor_time(lambda: _model(gears, scenes[0], mesh))  # noqa: B023  called at once
        sweep += processor_time(lambda: _swept(gears, scenes, mesh, angles)) / SOLVED  # noqa: B023
        of_map += processor_time(lambda: _mapped(gears, scenes, mesh, angles)) / SOLVED  # noqa: B023
    ratio = (condensing + positions * of_map) / (condensing + positions * sweep)
    return [
        Measured("Yang's pair at quick: condensing, processor time [s]", condensing, "", ""),
        Measured("a position under 8 torques [s]", sweep, "", ""),
        Measured("a position under 8 torques at 8 misalignments [s]", of_map, "", ""),
        Measured(f"the map over one sweep, {positions} positions, from {SOLVED} of them", ratio, "at most 3",
                 "yes" if ratio <= 3.0 else "no"),
    ]


def _model(gears: SharedGears, scene: Scene, mesh: Mesher) -> GearModel:
    return gears.prepare(gear_problem(scene), MPI.COMM_SELF, mesh).model


def _swept(gears: SharedGears, scenes: Sequence[Scene], mesh: Mesher, angles: Floats) -> None:
    """The gears without misalignment under all torques, as `evolvent excitation` sweeps them."""
    straight = max((each for each in scenes if not each.pair.misalignment_um), key=lambda each: each.load.torque_Nm)
    loaded_mesh(_model(gears, straight, mesh), _torques(scenes), angles, MPI.COMM_SELF)


def _mapped(gears: SharedGears, scenes: Sequence[Scene], mesh: Mesher, angles: Floats) -> None:
    """All misalignments under each torque, as a study solves them."""
    for torque in _torques(scenes):
        line = [each for each in scenes if 1e3 * each.load.torque_Nm == torque]
        list(misaligned_figures([_model(gears, scene, mesh) for scene in line], angles))


def _torques(scenes: Sequence[Scene]) -> list[float]:
    return sorted({1e3 * scene.load.torque_Nm for scene in scenes})


def main() -> None:
    """Measures, and writes the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=DOCS)
    out = parser.parse_args().out / "studies"
    found = measured()
    for each in found:
        print(f"{each.what}: {each.found:.4g} (wanted: {each.wanted}) {each.holds}", flush=True)
    write_rows(out / "map.csv", found)


if __name__ == "__main__":
    main()
