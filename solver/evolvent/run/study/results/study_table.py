"""Table of a study: a row for each scene, with its parameters, gathered figures and status."""

from __future__ import annotations

import importlib.util
import io
import json
import math
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.table import csv_text
from evolvent.run.study.plan.study_scenes import StudyScene
from evolvent.run.study.results.gathering import Figure, Gathering
from evolvent.run.study.results.scene_record import RECORD, SCENES, SceneRecord, scene_folder

TABLE, PARQUET = "study.csv", "study.parquet"
OWN = "status", "reason", "folder", "seconds", "warnings"
"""Columns behind the figures: status, reason, folder, time and number of warnings."""
WAITING, DONE = "waiting", "done"
WRITERS = "pandas", "pyarrow"
"""Packages that write Parquet; Debian has no pyarrow."""


@dataclass(frozen=True)
class TableRow:
    """A row of study.csv: first the parameters, each by its key, then the figures, then status, reason, folder, time
    and number of warnings."""

    parameters: Mapping[str, Any]
    """Key of the scene -> value."""
    figures: Mapping[str, float]
    """Figure -> value, NaN where the scene has none; with error bars in a column `..._error` behind it."""
    status: str
    """Status of the scene. done; failed: the computation ended with an error; refused: the values are no valid scene;
    waiting: not computed yet."""
    reason: str
    """Why a scene failed or was refused."""
    folder: str
    """Folder of the scene, below that of the study."""
    seconds: float | None
    """Wall time of the scene."""
    warnings: int | None = None
    """Number of warnings of the computation, which study_scene.json has: read them before the figures are compared."""

    def flat(self, figures: Sequence[str]) -> dict[str, object]:
        """The row as it is written. figures: columns of all rows."""
        values = {name: self.figures.get(name, float("nan")) for name in figures}
        own = dict(zip(OWN, (self.status, self.reason, self.folder, self.seconds, self.warnings)))
        return {**{name: written(value) for name, value in self.parameters.items()}, **values, **own}


def written(value: Any) -> object:
    """A parameter's value in the table: a list as TOML writes it."""
    return json.dumps(value, ensure_ascii=False) if isinstance(value, (list, tuple, dict)) else value


def table_row(scene: StudyScene, record: SceneRecord | None, out: Path, figures: Sequence[Figure]) -> TableRow:
    """Row of a scene in the study's table. record: None where it is not computed yet."""
    if record is None:
        return TableRow(scene.parameters, {}, WAITING, "", "", None)
    count = len(record.warnings)
    if record.status != DONE:
        where = f"{SCENES}/{record.name}" if scene_folder(out, record.name).exists() else ""
        return TableRow(scene.parameters, {}, record.status, record.reason, where, record.seconds, count)
    found = Gathering(scene_folder(out, record.name)).columns(figures)
    return TableRow(scene.parameters, found, DONE, "", f"{SCENES}/{record.name}", record.seconds, count)


def figure_columns(rows: Sequence[TableRow], figures: Sequence[Figure]) -> list[str]:
    """Columns of the figures, in the order in which they are gathered."""
    found = dict.fromkeys(name for row in rows for name in row.figures)
    return list(found) or [figure.name for figure in figures]


def missing_figures(rows: Sequence[TableRow], figures: Sequence[Figure], named: Container[str], out: Path) -> list[str]:
    """A sentence on each figure that some scenes that are done do not have, with the reason in the first of them.

    named: names of the figures that the study asks for; of others only a file that is not there, or cannot be read, is
    said, for some computations leave them out.
    """
    found, done = [], [row for row in rows if row.status == DONE]
    for figure in figures:
        without = [row for row in done if all(map(math.isnan, _values(row, figure.name)))]
        if not without:
            continue
        scene = Gathering(out / without[0].folder)
        reason = scene.why_missing(figure) if figure.name in named or not scene.has_rows(figure) else ""
        if reason:
            count = f"{len(without)} of {len(done)} scenes"
            found.append(f"figure {figure.name}: no number in {count}, in {without[0].folder} for instance: {reason}")
    return found


def warned_scenes(rows: Sequence[TableRow]) -> list[str]:
    """A sentence on scenes that are done, with warnings; none where there are no such scenes."""
    done = [row for row in rows if row.status == DONE]
    warned = [row for row in done if row.warnings]
    if not warned:
        return []
    return [
        f"{len(warned)} of {len(done)} scenes have warnings, by their number in the column warnings of {TABLE}; read "
        f"them before figures are compared, in {warned[0].folder}/{RECORD.name} for instance"
    ]


def _values(row: TableRow, name: str) -> list[float]:
    """Values of a figure, one for each friction coefficient."""
    return [value for column, value in row.figures.items() if column.partition(" (")[0] == name]


def write_table(folder: RunFolder, rows: Sequence[TableRow], columns: Sequence[str]) -> None:
    """Writes study.csv and, where pandas and pyarrow are installed, study.parquet. Raises WriteError, FolderError."""
    flat = [row.flat(columns) for row in rows]
    folder.write_text(TABLE, csv_text(flat))
    if all(importlib.util.find_spec(name) for name in WRITERS):
        folder.write(PARQUET, parquet(flat))


def parquet(rows: Sequence[Mapping[str, object]]) -> bytes:
    """Content of a Parquet file."""
    import pandas

    content = io.BytesIO()
    pandas.DataFrame(rows).to_parquet(content, index=False)
    return content.getvalue()
