"""The tables of a run: summary.json, positions.csv, teeth.csv.

Values are in reporting units (N·m, µm, MPa, degrees). Files are written atomically, so that a reader never sees an
incomplete table.
"""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows, position_rows
from evolvent.results.tables.run_warnings import warnings_of
from evolvent.results.tables.summary_rows import SCHEMA_VERSION, ErrorBars, RunFacts, Summary

FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r", "'")
"""How cells begin that spreadsheets take for formulas, and the apostrophe that says they are none."""


def summary(run: RunData, facts: RunFacts) -> Summary:
    """The content of summary.json."""
    return Summary(
        **vars(facts),
        schema_version=SCHEMA_VERSION,
        scene=run.scene.model_dump(mode="json"),
        warnings=warnings_of(run, facts.mesh),
        estimated_error=ErrorBars(run.errors.method, run.errors.missing or None),
        frictions=tuple(friction_rows(run)),
        positions=tuple(position_rows(run)),
    )


def write_tables(folder: RunFolder, content: Summary) -> None:
    """Writes summary.json, positions.csv and teeth.csv. Raises WriteError, FolderError."""
    rows = content.positions
    folder.write_text("positions.csv", csv_text([_flat(asdict(row)) for row in rows]))
    teeth = [
        {"pinion_angle_deg": row.pinion_angle_deg, "friction": row.friction, **asdict(tooth)}
        for row in rows
        for tooth in row.teeth
    ]
    folder.write_text("teeth.csv", csv_text(teeth))
    write_summary(folder, content)


def write_summary(folder: RunFolder, content: Summary) -> None:
    """Writes summary.json. Raises WriteError, FolderError."""
    values = {"schema_version": content.schema_version, **asdict(content)}
    text = json.dumps(without_nan(values), ensure_ascii=False, indent=1, allow_nan=False)
    folder.write_text("summary.json", text + "\n")


def _flat(row: dict[str, object]) -> dict[str, object]:
    """A row of positions.csv: the number of teeth in place of their list."""
    teeth = row.pop("teeth")
    assert isinstance(teeth, (list, tuple))
    return row | {"teeth_in_contact": len(teeth)}


def csv_text(rows: Sequence[Mapping[str, object]]) -> str:
    """Text of a CSV file. rows: at least one, all with the same keys."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, fieldnames=list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: _cell(value) for key, value in row.items()} for row in rows)
    return stream.getvalue()


def _cell(value: object) -> object:
    """A number with nine digits, enough for reading and for comparing two runs; behind an apostrophe a text that a
    spreadsheet would compute, or that begins with an apostrophe itself."""
    if isinstance(value, float):
        return f"{value:.9g}"
    is_formula = isinstance(value, str) and value.startswith(FORMULA_STARTS) and not _is_number(value)
    return f"'{value}" if is_formula else value


def cell_text(cell: str) -> str:
    """The text of a cell that `csv_text` has written."""
    return cell[1:] if cell.startswith("'") and cell[1:].startswith(FORMULA_STARTS) else cell


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def without_nan(value: object) -> object:
    """The value with null in place of numbers that are not finite, which JSON does not have."""
    if isinstance(value, Mapping):
        return {str(key): without_nan(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
