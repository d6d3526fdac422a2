"""What is wrong with a scene, in sentences: the key, what was found, what is allowed, and a remedy."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails, PydanticCustomError

from meshes.errors import InputError

NOTHING = "nothing"


@dataclass(frozen=True)
class Problem:
    """One error of a scene. `key` is dotted, as `--set` takes it; the other three are phrases without a full stop."""

    key: str
    found: str
    allowed: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.key}: found {self.found}; allowed: {self.allowed}; remedy: {self.remedy}"


class SceneError(InputError):
    """A scene that cannot be computed. Its text has one line per problem; nothing has been written.

    problems: at least one; source: the file, if there is one.
    """

    def __init__(self, problems: Iterable[Problem], source: str = "") -> None:
        self.problems = tuple(problems)
        self.source = source
        super().__init__("\n".join(f"{source}: {problem}" if source else str(problem) for problem in self.problems))

    def __reduce__(self) -> tuple[type[SceneError], tuple[tuple[Problem, ...], str]]:
        return SceneError, (self.problems, self.source)


def scene_problem(problem: Problem) -> PydanticCustomError:
    """The exception that a validator of the scene raises; the problem's key is relative to what is validated."""
    return PydanticCustomError("scene", "scene", {"problem": problem})


def problems_of(error: ValidationError, model: type[BaseModel]) -> list[Problem]:
    """All problems of a failed validation, in the words of the schema `model`."""
    return [_problem(details, model) for details in error.errors(include_url=False)]


def shown(value: Any) -> str:
    """A value as it would stand in a scene file, shortened."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "a section with keys " + (", ".join(map(str, value)) or "(none)")
    if isinstance(value, (list, tuple)):
        return _short("[" + ", ".join(shown(item) for item in value) + "]")
    if isinstance(value, str):
        return _short(json.dumps(value, ensure_ascii=False))
    return _short(f"{value:.10g}" if isinstance(value, float) else str(value))


def _short(text: str, limit: int = 60) -> str:
    return text if len(text) <= limit else text[: limit - 3] + "..."


def _problem(details: ErrorDetails, model: type[BaseModel]) -> Problem:
    path = list(details["loc"])
    if details["type"] == "scene":
        problem: Problem = details["ctx"]["problem"]
        return replace(problem, key=dotted([*path, problem.key] if problem.key else path))
    if details["type"] == "extra_forbidden":
        return _unknown_key(path, details["input"], model)
    missing = details["type"] == "missing"
    field = _declaration([part for part in path if isinstance(part, str)], model)
    section = section_of(field)
    if section is not None:
        return _missing_section(path, section) if missing else _not_a_section(path, details["input"], section)
    extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
    found = NOTHING if missing else shown(details["input"])
    return Problem(dotted(path), found, str(extra["allowed"]), str(extra["remedy"]))


def dotted(path: Iterable[str | int]) -> str:
    """["contact", "friction", 2] -> "contact.friction[2]"."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def keys_of(model: type[BaseModel], prefix: str = "") -> dict[str, FieldInfo]:
    """All keys of a schema, dotted, with their declarations; sections come as their keys."""
    keys: dict[str, FieldInfo] = {}
    for name, field in model.model_fields.items():
        section = section_of(field)
        if section is None:
            keys[prefix + name] = field
        else:
            keys.update(keys_of(section, f"{prefix}{name}."))
    return keys


def _unknown_key(path: list[str | int], value: Any, model: type[BaseModel]) -> Problem:
    """An unknown key or section: what was meant is looked for in its own section first, then everywhere."""
    name, parents = str(path[-1]), [str(part) for part in path[:-1]]
    section = section_of(_declaration(parents, model)) if parents else model
    assert section is not None
    here, prefix = list(section.model_fields), f"{dotted(parents)}." if parents else ""
    similar = [prefix + match for match in difflib.get_close_matches(name, here, n=1, cutoff=0.7)]
    everywhere = {key.rsplit(".", 1)[-1]: key for key in [*keys_of(model), *model.model_fields]}
    similar += [everywhere[match] for match in difflib.get_close_matches(name, everywhere, n=1, cutoff=0.7)]
    remedy = f"did you mean {similar[0]}? Else delete it" if similar else "delete it, or see docs/scene.md"
    what = f"an unknown {'section' if isinstance(value, dict) else 'key'}, {shown(value)}"
    return Problem(dotted(path), what, ", ".join(prefix + key for key in here), remedy)


def _not_a_section(path: list[str | int], value: Any, section: type[BaseModel]) -> Problem:
    keys = ", ".join(section.model_fields)
    name = dotted(path)
    return Problem(name, shown(value), f"a section with the keys {keys}", f"write [{name}] above its keys")


def _missing_section(path: list[str | int], section: type[BaseModel]) -> Problem:
    required = ", ".join(name for name, field in section.model_fields.items() if field.is_required())
    return Problem(dotted(path), NOTHING, f"a section with at least {required}", f"add a section [{dotted(path)}]")


def _declaration(names: list[str], model: type[BaseModel]) -> FieldInfo:
    """The declaration of a key or section at the end of a path."""
    field = model.model_fields[names[0]]
    section = section_of(field)
    return field if len(names) == 1 or section is None else _declaration(names[1:], section)


def section_of(field: FieldInfo) -> type[BaseModel] | None:
    """The model of a field that is a section, also of `Section | None`."""
    candidates = [field.annotation, *getattr(field.annotation, "__args__", ())]
    return next((c for c in candidates if isinstance(c, type) and issubclass(c, BaseModel)), None)
