"""Files of a pair at its operating speed: its excitation, its motion over time, its figures."""

from __future__ import annotations

from evolvent.dynamics.operating_point import Operation
from evolvent.dynamics.operation_figures import OperationFacts
from evolvent.dynamics.results.histories import HISTORIES, Motion, history_rows
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS, excitation_rows, harmonic_rows
from evolvent.results.tables.table import Filled, Record

OPERATION = Record("operation.json", OperationFacts)
OPERATION_TABLES = tuple(table.name for table in (EXCITATION, HARMONICS, HISTORIES, OPERATION))


def operation_tables(operation: Operation, direction: str, radius: float) -> list[Filled]:
    """excitation.csv, harmonics.csv, histories.csv and operation.json. direction: up or down; radius: base radius of
    the gear with the torque [mm]."""
    figures = OperationFacts.of(operation)
    motion = Motion(figures.speed_rpm, direction, operation.period, operation.repeats, operation.paths)
    return [
        EXCITATION.of(excitation_rows(operation.excitation, radius)),
        HARMONICS.of(harmonic_rows(operation.excitation, radius)), HISTORIES.of(history_rows([motion])),
        OPERATION.of(figures),
    ]
