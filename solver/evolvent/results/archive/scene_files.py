"""The solved scene in the folder of its run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from evolvent.results.archive.run_folder import RunFolder
from evolvent.scene.scene import GEARS, Scene, SceneError, kept_scene

SCENE_FILES = ("flank_pinion.csv", "flank_wheel.csv", "scene.toml")
"""Files of the scene in OUT."""


def write_scene(scene: Scene, folder: RunFolder) -> None:
    """Writes OUT/scene.toml and the flank charts that it names. Raises WriteError, FolderError, OSError."""
    texts = scene_texts(scene)
    for name in SCENE_FILES:
        if name in texts:
            folder.write_text(name, texts[name])
        elif folder.is_written(folder.out / name):
            (folder.out / name).unlink()


def holds_scene(out: Path, scene: Scene) -> bool:
    """Whether the scene in OUT is this one, by whatever names its version had."""
    try:
        return scene_texts(kept_scene(out / "scene.toml")) == scene_texts(scene)
    except SceneError:
        return False


def scene_texts(scene: Scene) -> dict[str, str]:
    """The files that `write_scene` writes: name -> text."""
    local: dict[str, Any] = {}
    texts: dict[str, str] = {}
    for name in GEARS:
        if chart := scene.flank_chart(name):
            texts[f"flank_{name}.csv"] = chart.text()
            local[name] = getattr(scene, name).model_copy(update={"flank_csv": f"flank_{name}.csv"})
    return texts | {"scene.toml": scene.model_copy(update=local).resolved_toml()}
