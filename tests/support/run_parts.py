"""What stands around a run's numbers: facts about the program and the mesh, its archive, its files."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np

from evolvent.gears.sweep.pitch_sweep import SweepState, SweptPosition
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.run_cost import Cost, Timings, write_cost
from evolvent.results.archive.run_folder import MANIFEST
from evolvent.results.mesh_facts import MeshFacts
from evolvent.results.run_data import RunData
from evolvent.results.tables.summary_rows import RunFacts
from evolvent.scene.skips import Skipped

GOOD = MeshFacts(0.3, 3.1, 2.0)
"""A mesh that gives no reason for a warning."""
FACTS = RunFacts(
    {"numpy": np.__version__}, 2, 123, 0, 45, MeshFacts(0.31, 2.1, 1.4),
    (Skipped("one-pitch", "One pitch is solved."),), Timings(1.0, 2.0), 99.5,
)


def store(run: RunData, folder: Path) -> None:
    """Archives a run as a real one would be."""
    archive = Archive(folder, run.scene)
    archive.write_gears(run.shapes)
    write_cost(archive.files, Cost(command=archive.command))
    (folder / "scene.toml").write_text(run.scene.resolved_toml(), encoding="utf-8")
    results = [tuple(solved.result for solved in each) for each in run.positions]
    state = SweepState((0.0, 0.0), tuple(None for _ in run.frictions))
    for k, each in enumerate(results):
        archive.write_position(k, SweptPosition(each[0].stand.angle, each, state))


def hashes(folder: Path) -> dict[str, str]:
    """SHA-256 of every file below a folder but Evolvent's own list."""
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*")) if path.is_file() and path != folder / MANIFEST
    }
