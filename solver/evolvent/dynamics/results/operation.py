"""Files of a pair at its operating speed: its excitation, its motion over time, its figures."""

from __future__ import annotations

from evolvent.dynamics.operating_point import Operation
from evolvent.dynamics.operation_figures import OperationFacts
from evolvent.dynamics.results.histories import HISTORIES, Motion, history_rows
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS, excitation_rows, harmonic_rows
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.table import Record

OPERATION = Record("operation.json", OperationFacts)


def write_operation(folder: RunFolder, operation: Operation, direction: str, radius: float) -> None:
    """Writes excitation.csv, harmonics.csv, histories.csv and operation.json.

    direction: up or down. radius: base radius of the gear with the torque [mm]. Raises WriteError, FolderError.
    """
    figures = OperationFacts.of(operation)
    EXCITATION.write(folder, excitation_rows(operation.excitation, radius))
    HARMONICS.write(folder, harmonic_rows(operation.excitation, radius))
    motion = Motion(figures.speed_rpm, direction, operation.period, operation.repeats, operation.paths)
    HISTORIES.write(folder, history_rows([motion]))
    OPERATION.write(folder, figures)
