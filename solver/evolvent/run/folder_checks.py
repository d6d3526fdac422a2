"""Checks of the output folder before a run writes to it: no foreign file is replaced, and no result is lost without
--overwrite."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TypeVar

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first
from evolvent.results.archive.run_folder import LOG, FolderError, RunFolder
from evolvent.results.archive.run_lock import locked
from evolvent.results.archive.scene_files import SCENE_FILES, scene_texts
from evolvent.scene.scene import GEARS, Scene, kept_scene

COMPUTED = ("results/state.npz", "results/wear.npz", "summary.json")
"""Files with results: one of them exists as soon as anything has been computed."""
WRITTEN = (
    str(LOG), *SCENE_FILES, "summary.json", "positions.csv", "teeth.csv", "wear.csv", "wear.json",
    "results/gears.npz", "results/position_*.npz", "results/state.npz", "results/errors.npz", "results/wear.npz",
    "results/cost.json",
)
"""Files that a run writes for every scene. Fields and pictures are checked one by one when they are written."""
OTHERS = (
    "strength.csv", "fatigue.csv", "excitation.json", "results/excitation.npz", "transient.csv",
    "results/transient_*.npz", "loads.csv",
)
"""Files that tell of another command's results, which a run that begins anew would remove or write over."""
STUDY = "study.json"
"""File in the folder of a study with the identity of its table."""
NAMED = 10
"""Largest number of foreign files that a message names."""


T = TypeVar("T")


@contextmanager
def writing_to(out: Path, comm: MPI.Comm, checked: Callable[[], T]) -> Iterator[T]:
    """Context in which no other run writes to the folder. Gives what `checked` returns, which looks at the folder on
    rank 0 once it is this run's. Collective.

    Raises FolderError where another run writes there or the folder is that of a study, and what `checked` raises.
    """
    with ExitStack() as lock:
        on_first(comm, lambda: lock.enter_context(locked(out)))
        on_first(comm, lambda: require_no_study(out))
        yield on_first(comm, checked)


def require_no_study(out: Path) -> None:
    """Raises FolderError where the folder is that of a study: results of one scene would stand beside its table."""
    if (out / STUDY).exists():
        raise FolderError(
            f"{out}: found a study ({STUDY}); allowed: a folder without; remedy: --out names another folder; each "
            "scene of the study has a folder below scenes"
        )


def require_new(out: Path, written: Sequence[str], table: str, overwrite: bool) -> None:
    """Checks the folder of a command that archives nothing before its end. written: names of all its files. table: the
    file by which an earlier call is recognised. Raises FolderError where files of others would be lost, or results
    without --overwrite."""
    RunFolder(out).require_free(written)
    if (out / table).exists() and not overwrite:
        raise FolderError(
            f"{out}: found {table} of an earlier call; allowed: a folder without; remedy: --overwrite computes it "
            "anew, --out names another folder"
        )


def require_unfinished(
    out: Path, written: Sequence[str], kept: tuple[str, str], what: str, resume: bool, overwrite: bool
) -> list[str]:
    """Checks the folder of a command that archives results while it computes. Returns a sentence where there is nothing
    to resume.

    written: names of all that it writes. kept: the file that is there first, and the table that is written in the end.
    what: it goes on from.

    Raises FolderError where files of others would be lost, or results unasked.
    """
    RunFolder(out).require_free(written)
    there = [name for name in kept if (out / name).exists()]
    if there and not (resume or overwrite):
        raise FolderError(
            f"{out}: found {there[-1]} of an earlier call; allowed: a folder without; remedy: --resume goes on from "
            f"its {what}, --overwrite computes them anew, --out names another folder"
        )
    if resume and not there:
        return [f"--resume found nothing to continue in {out} (no {kept[0]}); the call begins from the start."]
    return []


def check_folder(scene: Scene, out: Path, resume: bool, overwrite: bool, source: Path | None) -> None:
    """Raises FolderError where a run would lose results or overwrite foreign files.

    source: file that `scene` was read from, None where there is none.
    """
    folder = RunFolder(out)
    require_no_study(out)
    _keep_sources(scene, folder, source)
    folder.require_free(WRITTEN)
    if not (resume and any((out / name).exists() for name in COMPUTED[:2])):
        _require_no_others(out)
    results = [name for name in COMPUTED if (out / name).exists()]
    if results and not (resume or overwrite):
        raise FolderError(
            f"{out}: found the results of a run ({results[0]}); allowed: a folder without; remedy: --resume continues "
            "after them, --overwrite removes them and computes anew, --out names another folder"
        )


def _require_no_others(out: Path) -> None:
    """Raises FolderError where the folder has the results of another command: `run` keeps a list of its files with
    theirs, and removes all that it lists when it begins anew."""
    others = [path.relative_to(out).as_posix() for name in OTHERS for path in sorted(out.glob(name))]
    if others:
        raise FolderError(
            f"{out}: found {others[0]}, of another command; allowed: a folder without, as a run that begins anew "
            "removes what is there; remedy: --out names another folder"
        )


def _keep_sources(scene: Scene, folder: RunFolder, source: Path | None) -> None:
    """Raises FolderError where the run would change a file that the scene is read from."""
    charts = [getattr(scene, name).flank_csv for name in GEARS]
    sources = [path for path in (source, *(Path(chart) for chart in charts if chart)) if path is not None]
    texts, kept = scene_texts(scene), folder.out / "scene.toml"
    if kept in sources and folder.is_written(kept) and scene_texts(kept_scene(kept)) == texts:
        return  # this scene as a run has written it, perhaps with the names of an earlier version
    for name in SCENE_FILES:
        path = folder.out / name
        same = [source for source in sources if path.exists() and source.exists() and os.path.samefile(path, source)]
        if same and path.read_bytes() != texts.get(name, "").encode("utf-8"):
            raise FolderError(
                f"{folder.out}: found the scene's own file {same[0]}, over which a run writes its {name} with all "
                "defaults; allowed: another folder; remedy: --out names one"
            )


def changed_files(out: Path) -> str:
    """A sentence on the files of a run that have been changed since, empty where there are none."""
    files = ", ".join(map(str, RunFolder(out).changed_files(WRITTEN)))
    remedy = "move or remove that, and `evolvent run ... --resume` writes it anew"
    return f"changed, or cut off, since a run has written it: {files}; {remedy}" if files else ""


def foreign_files(out: Path) -> str:
    """A sentence on the foreign files in the folder, empty where there are none."""
    foreign = RunFolder(out).foreign_files()
    named = ", ".join(path.relative_to(out).as_posix() for path in foreign[:NAMED])
    more = f" and {len(foreign) - NAMED} more" if len(foreign) > NAMED else ""
    return f"left alone, as no run has written them: {named}{more}" if foreign else ""
