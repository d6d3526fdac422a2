"""The scenes of a study: each validated, named by its content, and in a group with those that share its gears."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from evolvent.results.archive.archive import fingerprint
from evolvent.run.study.plan.parameters import axes, combinations
from evolvent.run.study.plan.shared_gears import gears_names, on_shared_meshes
from evolvent.run.study.plan.study_file import StudyFile
from evolvent.scene.load_cases import load_cases
from evolvent.scene.scene import Scene, SceneError, future_warning, scene_from_values
from evolvent.scene.scene_text import apply_overrides, nested_values, scene_text
from evolvent.scene.schema.errors import InputProblem, shown
from evolvent.scene.schema.old_names import Warn

NAME = 16
"""Number of digits of a scene's name."""
NOT_DRAWN = {"pictures": False, "animation": False, "fields": False}
"""Keys of [output] that scenes of a study leave out unless the study sets them."""
Values = dict[str, Any]


@dataclass(frozen=True)
class StudyScene:
    """A scene of a study, or the reason why there is none."""

    parameters: Mapping[str, Any]
    """Key of the scene -> value."""
    scene: Scene | None
    """Validated scene; None where the values are refused."""
    refusal: str
    """Why the values are refused; empty where they are not."""
    name: str
    """Hash of everything that the results of the scene depend on, and of the computation."""
    gears: str
    """Name of the condensed gears that the scene can share; empty where it has its own."""


def study_scenes(
    study: StudyFile, path: Path, overrides: Sequence[str], version: str, warn: Warn = future_warning
) -> list[StudyScene]:
    """All scenes of a study, in the order of its parameters.

    path: of the study file. overrides: "section.key=value" for all scenes, as `--set` takes them. version: of the
    program. warn: is given a sentence on each old name of a key. Raises SceneError where the base scene cannot be read,
    or the values of all scenes are refused.
    """
    base, found, first = base_values(study, path, overrides, warn), [], None
    for parameters in combinations(axes(study)):
        try:
            scene = scene_from_values(_with(base, parameters, path.parent))
        except SceneError as error:
            found.append(StudyScene(parameters, None, "; ".join(map(str, error.problems)), "", ""))
            first = first or error
        else:
            found.append(StudyScene(parameters, scene, "", "", ""))
    if first is not None and all(each.scene is None for each in found):
        raise SceneError(first.problems, f"{path}: {_counted(len(found))}")
    if study.share_gears:
        found = _sharing(found, study.compute)
    return [replace(each, name=_name(each, study, version)) for each in found]


def _counted(count: int) -> str:
    """Number of refused scenes in words, where all of a study are refused."""
    return "its scene" if count == 1 else f"all of its {count:,} scenes are refused, the first one for"


def _with(base: Values, parameters: Mapping[str, Any], folder: Path) -> Values:
    """The base scene's values with those of the parameters. Raises SceneError where a section has a value."""
    values = deepcopy(base)
    for name, value in parameters.items():
        _put(values, name, value, folder)
    return values


def base_values(study: StudyFile, path: Path, overrides: Sequence[str], warn: Warn) -> Values:
    """Nested values of the base scene with those that all scenes share. Raises SceneError."""
    base = path.parent / study.scene
    try:
        values = nested_values(scene_text(base), (), base.parent, warn)
    except SceneError as error:
        raise SceneError(error.problems, f"{path}: scene {base}") from error
    for name in study.leave_out:
        _take_out(values, name)
    for name, value in {**{f"output.{name}": drawn for name, drawn in NOT_DRAWN.items()}, **study.set}.items():
        _put(values, name, value, path.parent)
    apply_overrides(values, overrides, warn)
    return values


def _put(values: Values, name: str, value: Any, folder: Path) -> None:
    """Sets a dotted key. folder: to which the paths of flank charts are relative. Raises SceneError where a section has
    a value."""
    *sections, last = name.split(".")
    for section in sections:
        values = values.setdefault(section, {})
        if not isinstance(values, dict):
            raise SceneError([InputProblem(section, shown(values), "a section", f"write [{section}] above its keys")])
    values[last] = str(folder / value) if last == "flank_csv" and isinstance(value, str) else value


def _take_out(values: Values, name: str) -> None:
    """Removes a dotted key, if it is given."""
    *sections, last = name.split(".")
    for section in sections:
        values = values.get(section, {})
    values.pop(last, None)


def _sharing(scenes: Sequence[StudyScene], compute: str) -> list[StudyScene]:
    """The scenes with the names of the gears that several of them share, on meshes that serve the torques of all of
    these."""
    known = {number: each.scene for number, each in enumerate(scenes) if each.scene is not None}
    served = dict(zip(known, on_shared_meshes(list(known.values()), compute)))
    names = dict(zip(known, gears_names(list(served.values()), compute)))
    return [
        replace(each, scene=served[number], gears=names[number]) if number in known else each
        for number, each in enumerate(scenes)
    ]


def _name(each: StudyScene, study: StudyFile, version: str) -> str:
    """Name of a scene: digits of a SHA-256. Excitations may share the search of their positions, which is not exact."""
    content: list[Any]
    shared = study.compute == "excitation" and study.share_gears
    if each.scene is None:
        content = [sorted((name, repr(value)) for name, value in each.parameters.items())]
    else:
        content = [fingerprint(each.scene), each.scene.output.model_dump(mode="json"), each.scene.exact.parts]
        content += map(repr, load_cases(each.scene) if study.compute == "losses" else ())
    return hashlib.sha256(json.dumps([version, study.compute, shared, *content]).encode()).hexdigest()[:NAME]
