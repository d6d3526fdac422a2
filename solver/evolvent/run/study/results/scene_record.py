"""Outcome of a scene of a study: a file in its folder, written last, as the completion marker."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from pydantic import TypeAdapter

from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.tables.table import Record
from evolvent_meshes.text_files import UnreadableText, read_text

SCENES = "scenes"
"""Folder of the scenes' folders, below that of the study."""
Status = Literal["done", "failed", "refused"]


@dataclass(frozen=True)
class SceneRecord:
    """study_scene.json: outcome of a scene."""

    name: str
    """Hash of the scene's content, and name of its folder."""
    compute: str
    """Computation, as `compute` of the study file names it."""
    status: Status
    """done, failed (the computation ended with an error), or refused (its values are no scene)."""
    reason: str
    """Why the scene failed or was refused; empty where it is done."""
    warnings: tuple[str, ...]
    """Warnings of the computation, a sentence each."""
    seconds: float
    """Wall time of the computation."""


RECORD, VALID = Record("study_scene.json", SceneRecord), TypeAdapter(SceneRecord)


def scene_folder(out: Path, name: str) -> Path:
    """Folder of a scene, below that of the study."""
    return out / SCENES / name


def write_record(folder: Path, record: SceneRecord) -> None:
    """Writes study_scene.json. Raises WriteError, FolderError."""
    RECORD.write(RunFolder(folder), record)


def read_record(folder: Path) -> SceneRecord | None:
    """The record of a scene; None where the scene was not computed to the end, or its record cannot be read."""
    try:
        record = VALID.validate_json(read_text(folder / RECORD.name, "JSON", 1))
    except (UnreadableText, ValueError):  # ValueError: pydantic's, of a record that was cut off, or is none
        return None
    return record if record.name == folder.name else None
