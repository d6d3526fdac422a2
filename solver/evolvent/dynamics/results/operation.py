"""Files of a pair at its operating speed: its excitation, its motion over time, its figures."""

from __future__ import annotations

from evolvent.dynamics.operating_point import Operation
from evolvent.dynamics.operation_figures import OperationFacts
from evolvent.dynamics.results.histories import HISTORIES, Motion, history_rows
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS, excitation_rows, harmonic_rows
from evolvent.results.tables.table import Filled, Record

OPERATION = Record("operation.json", OperationFacts)
OPERATION_TABLES = tuple(table.name for table in (EXCITATION, HARMONICS, HISTORIES, OPERATION))


def operation_tables(operation: Operation, direction: str) -> list[Filled]:
    """excitation.csv, harmonics.csv, histories.csv and operation.json. direction: up or down."""
    motion = Motion(operation.speed, direction, operation.repeats, operation.paths)
    return [
        EXCITATION.of(excitation_rows(operation.excitation)),
        HARMONICS.of(harmonic_rows(operation.excitation)), HISTORIES.of(history_rows([motion])),
        OPERATION.of(OperationFacts.of(operation)),
    ]
