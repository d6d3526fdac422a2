"""What must hold of OUT before a run touches it: nothing of somebody else's is in the way, nothing is lost unasked."""

from __future__ import annotations

import os
from pathlib import Path

from evolvent.results.archive.run_folder import LOG, FolderError, RunFolder
from evolvent.results.archive.scene_files import SCENE_FILES, scene_texts
from evolvent.scene.scene import GEARS, Scene

COMPUTED = ("results/state.npz", "results/wear.npz", "summary.json")
"""One of these is there as soon as something is that took time."""
WRITTEN = (
    str(LOG), *SCENE_FILES, "summary.json", "positions.csv", "teeth.csv", "wear.csv", "wear.json",
    "results/gears.npz", "results/position_*.npz", "results/state.npz", "results/errors.npz", "results/wear.npz",
    "results/cost.json",
)  # fmt: skip
"""What a run needs to write, whatever its scene. Fields and pictures come last and are looked at one by one."""
NAMED = 10  # files of somebody else's, at most


def check_folder(scene: Scene, out: Path, resume: bool, overwrite: bool, source: Path | None) -> None:
    """Raises FolderError where computing `scene`, read from the file `source`, would lose or overwrite something."""
    folder = RunFolder(out)
    _keep_sources(scene, folder, source)
    folder.require_free(WRITTEN)
    found = [name for name in COMPUTED if (out / name).exists()]
    if found and not (resume or overwrite):
        raise FolderError(
            f"{out}: found the results of a run ({found[0]}); allowed: a folder without; remedy: --resume goes on "
            "after them, --overwrite removes them and computes anew, --out names another folder"
        )


def _keep_sources(scene: Scene, folder: RunFolder, source: Path | None) -> None:
    """A scene's own files may lie in OUT only where a run leaves them just as they are."""
    charts = [getattr(scene, name).flank_csv for name in GEARS]
    sources = [path for path in (source, *(Path(chart) for chart in charts if chart)) if path is not None]
    texts = scene_texts(scene)
    for name in SCENE_FILES:
        path = folder.out / name
        mine = [own for own in sources if path.exists() and own.exists() and os.path.samefile(path, own)]
        if mine and path.read_bytes() != texts.get(name, "").encode("utf-8"):
            raise FolderError(
                f"{folder.out}: found the scene's own file {mine[0]}, over which a run writes its {name} with all "
                "defaults; allowed: another folder; remedy: --out names one"
            )


def changed(out: Path) -> str:
    """A sentence on the files of a run that somebody has changed since, empty where there are none."""
    found = ", ".join(map(str, RunFolder(out).changed(WRITTEN)))
    remedy = "move or remove that, and `evolvent run ... --resume` writes it anew"
    return f"changed, or cut off, since a run has written it: {found}; {remedy}" if found else ""


def others(out: Path) -> str:
    """A sentence on the files that no run has made, empty where there are none."""
    theirs = RunFolder(out).theirs()
    named = ", ".join(path.relative_to(out).as_posix() for path in theirs[:NAMED])
    more = f" and {len(theirs) - NAMED} more" if len(theirs) > NAMED else ""
    return f"left alone, as no run has made them: {named}{more}" if theirs else ""
