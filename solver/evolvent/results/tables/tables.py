"""The tables of a run: summary.json, positions.csv, teeth.csv.

Values are in reporting units (N·m, µm, MPa, degrees). Files are written atomically, so that a reader never sees an
incomplete table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows, position_rows
from evolvent.results.tables.run_warnings import warnings_of
from evolvent.results.tables.summary_rows import SCHEMA_VERSION, ErrorBars, RunFacts, Summary
from evolvent.results.tables.table import csv_text, json_text


def summary(run: RunData, facts: RunFacts, said: Sequence[str] = ()) -> Summary:
    """The content of summary.json. said: warnings of how the positions were solved."""
    return Summary(
        **vars(facts),
        schema_version=SCHEMA_VERSION,
        scene=run.scene.model_dump(mode="json"),
        warnings=(*said, *warnings_of(run, facts.mesh)),
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
    folder.write_text("summary.json", json_text(values))


def _flat(row: dict[str, object]) -> dict[str, object]:
    """A row of positions.csv: the number of teeth in place of their list."""
    teeth = row.pop("teeth")
    assert isinstance(teeth, (list, tuple))
    return row | {"teeth_in_contact": len(teeth)}
