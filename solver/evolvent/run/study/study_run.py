"""A study from start to finish. `evolvent study` calls only this."""

from __future__ import annotations

import contextlib
import hashlib
import json
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path

from evolvent.results.archive.run_folder import FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.drawing.picture_files import draw
from evolvent.run.folder_checks import STUDY
from evolvent.run.progress import OUTPUT, Progress
from evolvent.run.study.figures.all import study_pictures
from evolvent.run.study.figures.study_values import StudyValues
from evolvent.run.study.plan.parameters import axes
from evolvent.run.study.plan.study_file import StudyFile
from evolvent.run.study.plan.study_scenes import StudyScene
from evolvent.run.study.results.gathering import Figure
from evolvent.run.study.results.scene_record import SceneRecord, read_record, scene_folder
from evolvent.run.study.results.study_table import (
    PARQUET,
    TABLE,
    TableRow,
    figure_columns,
    missing_figures,
    table_row,
    warned_scenes,
    write_table,
)
from evolvent.run.study.scene_task import DONE, REFUSED, SceneTask
from evolvent.run.study.task_groups import SceneWorkers
from evolvent_meshes.errors import InputError, ResultError
from evolvent_meshes.text_files import UnreadableText, read_text

SCENES_STAGE = "scenes"
INTERVAL = 10.0
"""Time [s] between two writings of the table while scenes are computed."""
PICTURES = "pictures/*.png"
Workers = Callable[[], AbstractContextManager[SceneWorkers]]


class NothingComputed(ResultError):
    """Error of a study of which no scene could be computed."""


@dataclass(frozen=True)
class Study:
    """A study, ready to be computed."""

    file: StudyFile
    """Content of the study file."""
    scenes: Sequence[StudyScene]
    """Scenes in the order of the table."""
    figures: Sequence[Figure]
    """Figures that the table gathers."""

    @property
    def names(self) -> str:
        """SHA-256 of the scenes' names in their order."""
        return hashlib.sha256(" ".join(each.name for each in self.scenes).encode()).hexdigest()

    @property
    def content(self) -> str:
        """Identity of the study's table, as JSON: title, computation, number and `names` of its scenes."""
        known = {"title": self.file.title, "compute": self.file.compute, "scenes": len(self.scenes)}
        values = {**known, "names": self.names}
        return json.dumps(values, ensure_ascii=False, indent=1) + "\n"


def run_study(study: Study, out: Path, workers: Workers, at_once: int, overwrite: bool, quiet: bool) -> list[str]:
    """Computes those scenes of a study that are not in `out` yet, and writes its table and pictures. Returns a sentence
    on scenes that failed, and for each picture that could not be drawn.

    workers: context with the processes that compute. at_once: how many scenes a machine computes at once; 0: its memory
    is not checked. overwrite: replace the table of another study. quiet: no progress is displayed.

    Raises FolderError, InputError where workers cannot be had or all scenes are refused, NothingComputed, WriteError.
    """
    with locked(out):
        folder = RunFolder(out)
        folder.require_free([TABLE, PARQUET, STUDY])
        _require_no_other(folder)
        _require_same(study, folder, overwrite)
        records = {each.name: record for each in study.scenes if (record := _known(each, out)) is not None}
        table = _Table(study, out, records)
        with Progress(hidden=quiet) as progress:
            progress.stage(SCENES_STAGE, len(study.scenes), table.done)
            missing = table.missing(at_once)
            with workers() if missing else nullcontext() as computing:
                folder.write_text(STUDY, study.content)  # before the table: no other study replaces that unasked
                table.write(folder)
                for record in computing.finished(missing) if computing is not None else ():
                    table.add(record)
                    progress.reach(table.done)
                    table.write_now_and_then(folder)
            progress.stage(OUTPUT)
            folder.remove(str(path.relative_to(out)) for path in out.glob(PICTURES))
            rows, columns = table.write(folder)
            said = [*table.said(), *warned_scenes(rows), *missing_figures(rows, study.figures, _named(study), out)]
            drawn = draw(study_pictures(_values(study, rows, columns)), folder)
        return [*said, *drawn.failures]


def _require_no_other(folder: RunFolder) -> None:
    """Raises FolderError where the folder has results of a single scene."""
    if (folder.out / STUDY).exists():
        return
    names = [path.relative_to(folder.out).as_posix() for path in folder.written_files()]
    others = [name for name in names if name not in (TABLE, PARQUET) and not name.startswith("pictures/")]
    if others:
        raise FolderError(
            f"{folder.out}: found {others[0]}, which a command for a single scene has written; allowed: a new folder, "
            "or that of a study; remedy: --out names another folder"
        )


def _require_same(study: Study, folder: RunFolder, overwrite: bool) -> None:
    """Raises FolderError where the folder has the table of another study, unless that is to be replaced."""
    path = folder.out / STUDY
    if path.exists() and _kept_names(path) != study.names and not overwrite:
        raise FolderError(
            f"{folder.out}: found the table of another study, or of other values ({STUDY}); allowed: a folder "
            "without, or the same study; remedy: --overwrite replaces table and pictures, and computes no scene again "
            "that both have; --out names another folder"
        )


def _kept_names(path: Path) -> object:
    """`Study.names` in a study's file; None where it cannot be read."""
    with contextlib.suppress(UnreadableText, ValueError, TypeError, KeyError, RecursionError):
        return json.loads(read_text(path, "JSON", 1))["names"]
    return None


def _named(study: Study) -> set[str]:
    """Names of the figures that the study asks for, unlike those by default."""
    return {each.name for each in study.file.figure} | set(study.file.figures or ())


def _values(study: Study, rows: Sequence[TableRow], columns: Sequence[str]) -> StudyValues:
    """Data for the pictures: each key of a Latin hypercube is an axis."""
    points = axes(study.file)
    keys = [(key,) for axis in points for key in axis.keys] if study.file.latin_hypercube else [a.keys for a in points]
    return StudyValues(study.file.title, keys, rows, columns, study.file.latin_hypercube is not None)


def _known(scene: StudyScene, out: Path) -> SceneRecord | None:
    """The record of a scene that was computed before, or whose values are refused."""
    if scene.scene is None:
        return SceneRecord(scene.name, "", REFUSED, scene.refusal, (), 0.0)
    return read_record(scene_folder(out, scene.name))


class _Table:
    """Table of a study while its scenes are computed. records: by the name of their scene."""

    def __init__(self, study: Study, out: Path, records: Mapping[str, SceneRecord]) -> None:
        self.study, self.out, self.records = study, out, dict(records)
        self.written = time.monotonic()
        self.rows: dict[str, TableRow] = {}
        self._counts = Counter(each.name for each in study.scenes)
        self.done = sum(self._counts[name] for name in records)
        """Number of scenes that are done, failed or refused."""

    def missing(self, at_once: int) -> dict[SceneTask, str]:
        """Tasks that are still to be computed, each once, with the name of the gears that they share."""
        compute = self.study.file.compute
        return {
            SceneTask(each.name, scene_folder(self.out, each.name), compute, each.scene, at_once): each.gears
            for each in {each.name: each for each in self.study.scenes}.values()
            if each.scene is not None and each.name not in self.records
        }

    def add(self, record: SceneRecord) -> None:
        """Adds the record of a computed scene."""
        self.records[record.name] = record
        self.done += self._counts[record.name]

    def write_now_and_then(self, folder: RunFolder) -> None:
        """Writes the table if `INTERVAL` has passed since it was last written."""
        if time.monotonic() - self.written > INTERVAL:
            self.write(folder)
            self.written = time.monotonic()

    def write(self, folder: RunFolder) -> tuple[list[TableRow], list[str]]:
        """Writes the table of all scenes, waiting ones too; returns its rows and the columns of its figures. Raises
        WriteError, FolderError."""
        rows = self.all_rows()
        columns = figure_columns(rows, self.study.figures)
        write_table(folder, rows, columns)
        return rows, columns

    def all_rows(self) -> list[TableRow]:
        """Rows of all scenes in the order of the study. The figures of each scene are read once."""
        return [self._row(each) for each in self.study.scenes]

    def _row(self, scene: StudyScene) -> TableRow:
        record = self.records.get(scene.name)
        if record is None or scene.name not in self.rows:
            row = table_row(scene, record, self.out, self.study.figures)
            if record is None:
                return row
            self.rows[scene.name] = row
        return self.rows[scene.name]

    def said(self) -> list[str]:
        """Sentence on failed and refused scenes; empty list where there are none. Raises NothingComputed where no scene
        is done, InputError where the values of all of them are refused."""
        rows = self.all_rows()
        failed = [row for row in rows if row.status != DONE]
        if not failed:
            return []
        count = f"{len(failed)} of {len(rows)} scenes are not done"
        sentence = f"{count} ({TABLE} says why), the first one: {failed[0].reason}"
        if len(failed) == len(rows):
            refused = all(row.status == REFUSED for row in rows)
            raise (InputError if refused else NothingComputed)(f"{self.out}: {sentence}")
        return [sentence]
