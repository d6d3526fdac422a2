"""A pair at its operating speed on disk: its excitation, its motion over time, its figures."""

from __future__ import annotations

import json
from dataclasses import asdict

from evolvent.dynamics.operating_point import Operation
from evolvent.dynamics.operation_figures import OperationFigures
from evolvent.dynamics.results.histories import Motion, history_rows, write_histories
from evolvent.dynamics.results.tables import excitation_rows, harmonic_rows, write_tables
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.tables import without_nan

OPERATION, PICTURE = "operation.json", "30_mesh_force.png"


def write_operation(folder: RunFolder, operation: Operation, coming: str, radius: float) -> None:
    """Writes excitation.csv, harmonics.csv, histories.csv and operation.json. coming: up or down; radius: base radius
    of the gear with the torque [mm]. Raises WriteError, FolderError."""
    figures = OperationFigures.of(operation)
    write_tables(folder, excitation_rows(operation.excitation, radius), harmonic_rows(operation.excitation, radius))
    motion = Motion(figures.speed_rpm, coming, operation.period, operation.repeats, operation.paths)
    write_histories(folder, history_rows([motion]))
    folder.write_text(OPERATION, json.dumps(without_nan(asdict(figures)), indent=1, ensure_ascii=False) + "\n")
