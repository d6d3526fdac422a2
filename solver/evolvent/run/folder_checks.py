"""Checks of the output folder before a run writes to it: no foreign file is replaced, and no result is lost without
--overwrite."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from evolvent.results.archive.run_cost import FILE as COST
from evolvent.results.archive.run_cost import read_cost
from evolvent.results.archive.run_folder import LOG, FolderError, RunFolder
from evolvent.results.archive.scene_files import SCENE_FILES, holds_scene, scene_texts
from evolvent.run.call import Options
from evolvent.run.computation import Computation
from evolvent.scene.scene import GEARS, Scene

COMMON = (str(LOG), *SCENE_FILES, str(COST))
"""Files that every computation writes."""
MARKS = {
    "loads.csv": "loads", "fatigue.csv": "fatigue", "strength.csv": "strength", "transient.csv": "transient",
    "results/transient_*.npz": "transient", "response.csv": "dynamics", "excitation.json": "excitation",
    "results/excitation*.npz": "excitation", "summary.json": "run", "results/state.npz": "run",
}
"""Files of earlier versions, which did not write their command down, and the command that they tell of."""
STUDY = "study.json"
"""File in the folder of a study with the identity of its table."""
NAMED = 10
"""Largest number of foreign files that a message names."""


def check_folder(what: Computation[Any], out: Path, options: Options) -> None:
    """Raises FolderError where a computation would lose results or overwrite foreign files."""
    folder = RunFolder(out)
    require_no_study(out)
    _keep_sources(what.scene, folder, options.source)
    own = [name for name in what.outputs.results if not name.startswith("pictures/")]  # those are left undrawn
    folder.require_free([*COMMON, *own, *what.outputs.stored])
    _require_no_other(what, out)
    found = begun_results(what, out)
    if found and not (options.resume or options.overwrite):
        raise FolderError(
            f"{out}: found the results of an earlier call ({found[0]}); allowed: a folder without; remedy: --resume "
            "goes on from them, --overwrite removes them and computes anew, --out names another folder"
        )


def require_no_study(out: Path) -> None:
    """Raises FolderError where the folder is that of a study: results of one scene would stand beside its table."""
    if (out / STUDY).exists():
        raise FolderError(
            f"{out}: found a study ({STUDY}); allowed: a folder without; remedy: --out names another folder; each "
            "scene of the study has a folder below scenes"
        )


def begun_command(out: Path) -> str:
    """The command that has begun to write to a folder; empty where there is none. Raises ArchiveError where the file
    of its cost cannot be read."""
    if (out / STUDY).exists():
        return "study"
    marked = (command for pattern, command in MARKS.items() if any(out.glob(pattern)))
    return read_cost(RunFolder(out)).command or next(marked, "")


def nothing_to_resume(what: Computation[Any], out: Path) -> str:
    """A sentence where there is nothing to resume, empty where there is.

    This is no error: a call that was stopped early has left no results.
    """
    if begun_results(what, out):
        return ""
    return (
        f"--resume found nothing to continue in {out} (no {what.outputs.stored[0]}); `evolvent {what.command}` begins "
        "from the start."
    )


def begun_results(what: Computation[Any], out: Path) -> list[str]:
    """Names of the files in the folder that tell of results: one is there as soon as anything was computed."""
    return [name for name in (*what.outputs.stored[:1], *what.outputs.tables) if (out / name).exists()]


def _require_no_other(what: Computation[Any], out: Path) -> None:
    """Raises FolderError where another command has written to the folder: the scene of a folder repeats all that lies
    in it."""
    if (other := begun_command(out)) and other != what.command:
        raise FolderError(
            f"{out}: found results of `evolvent {other}`; allowed: a folder without, or with those of `evolvent "
            f"{what.command}`; remedy: --out names another folder"
        )


def _keep_sources(scene: Scene, folder: RunFolder, source: Path | None) -> None:
    """Raises FolderError where the run would change a file that the scene is read from."""
    charts = [getattr(scene, name).flank_csv for name in GEARS]
    sources = [path for path in (source, *(Path(chart) for chart in charts if chart)) if path is not None]
    texts, kept = scene_texts(scene), folder.out / "scene.toml"
    if kept in sources and folder.is_written(kept) and holds_scene(folder.out, scene):
        return  # this scene as a run has written it, perhaps with the names of an earlier version
    for name in SCENE_FILES:
        path = folder.out / name
        same = [source for source in sources if path.exists() and source.exists() and os.path.samefile(path, source)]
        if same and path.read_bytes() != texts.get(name, "").encode("utf-8"):
            raise FolderError(
                f"{folder.out}: found the scene's own file {same[0]}, over which a run writes its {name} with all "
                "defaults; allowed: another folder; remedy: --out names one"
            )


def changed_files(what: Computation[Any], out: Path) -> str:
    """A sentence on the files of a computation that have been changed since, empty where there are none."""
    files = ", ".join(map(str, RunFolder(out).changed_files([*COMMON, *what.outputs.results, *what.outputs.stored])))
    remedy = f"move or remove that, and `evolvent {what.command} ... --resume` writes it anew"
    return f"changed, or cut off, since a run has written it: {files}; {remedy}" if files else ""


def foreign_files(out: Path) -> str:
    """A sentence on the foreign files in the folder, empty where there are none."""
    foreign = RunFolder(out).foreign_files()
    named = ", ".join(path.relative_to(out).as_posix() for path in foreign[:NAMED])
    more = f" and {len(foreign) - NAMED} more" if len(foreign) > NAMED else ""
    return f"left alone, as no run has written them: {named}{more}" if foreign else ""
