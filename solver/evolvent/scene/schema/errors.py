"""Errors of a scene, one line each: the key, the given value, the allowed ones, and a remedy."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails, PydanticCustomError

from evolvent.scene.schema.guesses.meant_key import meant_key, meant_section
from evolvent.scene.schema.guesses.meant_value import expected, meant_value
from evolvent.scene.schema.guesses.not_supported import not_supported
from evolvent.scene.schema.guesses.terms import Meant
from evolvent.scene.schema.guesses.units import unit_conversion
from evolvent.scene.schema.section import SceneSection
from evolvent_meshes.errors import InputError

NOTHING = "nothing"
"""Word for a missing value in a message."""
MOST = 20
"""Largest number of problems in one message."""
LONGEST_NUMBER = 40
"""Largest number of digits of a whole number that are shown."""
BEYOND = {"greater_than": "too_small", "greater_than_equal": "too_small", "less_than_equal": "too_large"}
"""Type of pydantic's error on a number beyond a limit -> the entry of the declaration that has its remedy."""
ASKED = re.compile(r"did you mean (\S+?)(?: or \S+)*(?: \(.*\))?\?")
"""Regular expression for the remedy of an unknown key or section that suggests a known one."""
LONGEST_TEXT = 60
"""Largest number of characters of a value or a key that are shown."""


@dataclass(frozen=True)
class InputProblem:
    """One error of an input; the fields but `key` are phrases without a full stop."""

    key: str
    """Dotted key of the scene, as `--set` takes it, or name of an option."""
    found: str
    """Given value, or a phrase on its error."""
    allowed: str
    """Allowed values."""
    remedy: str
    """Remedy: how to correct the input."""

    def __str__(self) -> str:
        return f"{self.key}: found {self.found}; allowed: {self.allowed}; remedy: {self.remedy}"


class SceneError(InputError):
    """A scene that cannot be computed. Its message has one line per problem; no file has been written.

    problems: at least one.
    source:   path of the scene file, empty where there is none.
    """

    def __init__(self, problems: Iterable[InputProblem], source: str = "") -> None:
        self.problems = tuple(problems)
        self.source = source
        super().__init__("\n".join(f"{source}: {problem}" if source else str(problem) for problem in self.problems))

    def __reduce__(self) -> tuple[type[SceneError], tuple[tuple[InputProblem, ...], str]]:
        return SceneError, (self.problems, self.source)


def validation_error(*problems: InputProblem) -> PydanticCustomError:
    """The exception to be raised by a validator of a scene section. The problems' keys are relative to this section."""
    return PydanticCustomError("scene", "scene", {"problems": problems})


def problems_of(error: ValidationError, model: type[SceneSection]) -> list[InputProblem]:
    """The problems of a failed validation, with the texts of the schema `model`: all, or the first `MOST`."""
    details = _without_emptied_lists(error.errors(include_url=False))
    problems = _without_consequences([problem for each in details[:MOST] for problem in _problems(each, model)])
    if len(details) > MOST:
        more, remedy = len(details) - MOST, f"mend these first; is this a {model.kind} file at all?"
        wanted = f"a {model.kind} ({model.page})"
        problems.append(InputProblem(f"{model.kind} file", f"{more} more errors", wanted, remedy))
    return problems


def _without_emptied_lists(details: list[ErrorDetails]) -> list[ErrorDetails]:
    """The errors without those on lists that are too short for pydantic once their wrong entries are left out."""
    wrong = {each["loc"][:-1] for each in details}
    return [each for each in details if each["type"] != "too_short" or each["loc"] not in wrong]


def _without_consequences(problems: list[InputProblem]) -> list[InputProblem]:
    """The problems without those on missing keys whose names are misspelled: the spelling is the remedy."""
    asked = [(problem.key, ASKED.match(problem.remedy)) for problem in problems]
    meant = {match[1] for key, match in asked if match and key.rpartition(".")[0] == match[1].rpartition(".")[0]}
    return [problem for problem in problems if problem.found != NOTHING or problem.key not in meant]


def shown(value: Any) -> str:
    """A value as it would be written in a scene file, shortened."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return _short("a section with keys " + (", ".join(map(dotted_part, value)) or "(none)"))
    if isinstance(value, (list, tuple)):
        return _short("[" + ", ".join(shown(item) for item in value[:MOST]) + "]")
    if isinstance(value, str):
        return _short(json.dumps(value[:LONGEST_TEXT], ensure_ascii=False))
    if isinstance(value, int) and value.bit_length() > LONGEST_NUMBER * 3:  # Python refuses to write 5000 digits
        return f"a whole number of about {int(value.bit_length() * math.log10(2)) + 1:,} digits"
    return _short(f"{value:.10g}" if isinstance(value, float) else str(value))


def _short(text: str) -> str:
    """The text, cut off at `LONGEST_TEXT` characters."""
    return text if len(text) <= LONGEST_TEXT else text[: LONGEST_TEXT - 3] + "..."


def _problems(details: ErrorDetails, model: type[SceneSection]) -> list[InputProblem]:
    """The problems that one of pydantic's errors reports."""
    path = list(details["loc"])
    if details["type"] == "scene":
        problems: tuple[InputProblem, ...] = details["ctx"]["problems"]
        return [replace(each, key=dotted([*path, each.key] if each.key else path)) for each in problems]
    return [_problem(path, details, model)]


def _problem(path: list[str | int], details: ErrorDetails, model: type[SceneSection]) -> InputProblem:
    """The problem that an error of pydantic's own reports, of the key at the end of a path."""
    if details["type"] == "extra_forbidden":
        return _unknown_key(path, details["input"], model)
    missing = details["type"] == "missing"
    field = _declaration([part for part in path if isinstance(part, str)], model)
    section = section_of(field)
    if section is not None:
        return _missing_section(path, section) if missing else _not_a_section(path, details["input"], field, section)
    extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
    allowed, remedy = str(extra["allowed"]), str(extra[BEYOND.get(details["type"], "remedy")])
    if missing:
        return InputProblem(dotted(path), NOTHING, allowed, remedy)
    value, meant = details["input"], meant_value(details["input"], field)
    with_point = isinstance(value, float) and (meant is not None or details["type"] == "int_type")
    found = repr(value) if with_point else shown(value)  # where 20 is allowed, 20.0 must show its point
    fitting = f"write {shown(meant)}" if meant is not None else expected(details["type"], value)
    if isinstance(meant, dict):
        fitting = f"write [{dotted(path)}] in place of [[{dotted(path)}]]"
    return InputProblem(dotted(path), found, allowed, fitting or remedy)


def dotted(path: Iterable[str | int]) -> str:
    """A path of keys and indices as text: ["contact", "friction", 2] -> "contact.friction[2]"."""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{dotted_part(part)}" if text else dotted_part(part)
    return text


def dotted_part(name: str) -> str:
    """A key as TOML writes it: bare, dotted, or in quotes; shortened."""
    return _short(name if re.fullmatch(r"[A-Za-z0-9_.\[\]-]+", name) else json.dumps(name, ensure_ascii=False))


def keys_of(model: type[BaseModel], prefix: str = "") -> dict[str, FieldInfo]:
    """Dotted key -> declaration, of all keys of a schema and its sections."""
    keys: dict[str, FieldInfo] = {}
    for name, field in model.model_fields.items():
        section = section_of(field)
        if section is None:
            keys[prefix + name] = field
        else:
            keys.update(keys_of(section, f"{prefix}{name}."))
    return keys


def key_problem(name: str, value: Any, model: type[SceneSection]) -> InputProblem | None:
    """The problem where a dotted name is not that of a key of a schema, None where it is. value: given for it."""
    keys, path = keys_of(model), name.split(".")
    if name in keys:
        return _of_a_list(name, value) if len(path) > 1 and is_listed(model.model_fields[path[0]]) else None
    for depth in range(1, len(path)):
        if not any(each.startswith(".".join([*path[:depth], ""])) for each in keys):
            return _unknown_key(list(path[:depth]), {".".join(path[depth:]): value}, model)
    field = _declaration(path, model) if any(each.startswith(f"{name}.") for each in keys) else None
    section = None if field is None else section_of(field)
    if field is None or section is None:
        return _unknown_key(list(path), value, model)
    return _not_a_section(list(path), value, field, section)


def _of_a_list(name: str, value: Any) -> InputProblem:
    """The problem with a key of a list of sections, where it does not say which of them."""
    found = f"{shown(value)} for a key that each section [[{name.partition('.')[0]}]] has"
    return InputProblem(name, found, "keys of sections that there is one of", "give it in the base scene")


def _unknown_key(path: list[str | int], value: Any, model: type[SceneSection]) -> InputProblem:
    """Problem with an unknown key or section, with a suggestion, or the note that it is not supported."""
    name, parents = str(path[-1]), [part for part in path[:-1] if isinstance(part, str)]
    found = f"an unknown {'section' if _is_section(value) else 'key'}, {shown(value)}"
    place = f"a key of [{dotted(parents)}]" if parents else "a section or key"
    allowed = f"{place} that {model.page} lists"
    meant = _meant(name, parents, model, value)
    if meant is None:
        return InputProblem(dotted(path), found, allowed, f"delete it, or see {model.page}")
    if not meant.keys:
        return InputProblem(dotted(path), found, allowed, f"delete it: {meant.note}")
    then, note = unit_conversion(name, meant.keys[0]), f" ({meant.note})" if meant.note else ""
    remedy = f"did you mean {' or '.join(meant.keys)}{note}? {f'Then {then}; else' if then else 'Else'} delete it"
    return InputProblem(dotted(path), found, allowed, remedy)


def _meant(name: str, parents: list[str], model: type[SceneSection], value: Any) -> Meant | None:
    """Probable meaning of an unknown key or section with a value; None where there is none."""
    parent = dotted(parents)
    inside = section_of(_declaration(parents, model)) if parents else model
    assert inside is not None
    here = [f"{parent}.{key}" if parent else key for key in inside.model_fields]
    sections = [key for key, field in zip(here, inside.model_fields.values()) if section_of(field)]
    if _is_section(value):
        among = sections if model.kind == "scene" else here
        found = meant_section(name, parent, among, model.kind, isinstance(value, list))
    else:
        found = meant_key(name, parent, [key for key in here if key not in sections], keys_of(model), model.kind)
    if found is None and model.kind == "scene" and (words := not_supported(name, parent)):
        return Meant((), words)
    return found


def _not_a_section(path: list[str | int], value: Any, field: FieldInfo, section: type[BaseModel]) -> InputProblem:
    """The problem with a value in place of a section, or of a list of sections."""
    keys, name = ", ".join(section.model_fields), dotted(path)
    if len(path) == 1 and is_listed(field):
        allowed = f"one or more sections [[{name}]], each with the keys {keys}"
        return InputProblem(name, shown(value), allowed, f"write [[{name}]] in place of [{name}]")
    is_list = isinstance(value, list) and _is_section(value)
    remedy = f"write [{name}] in place of [[{name}]]" if is_list else f"write [{name}] above its keys"
    remedy = remedy if isinstance(path[-1], str) else f"write [[{dotted(path[:-1])}]] above its keys"
    return InputProblem(name, shown(value), f"a section with the keys {keys}", remedy)


def _missing_section(path: list[str | int], section: type[BaseModel]) -> InputProblem:
    """The problem with a required section that is missing."""
    required = ", ".join(name for name, field in section.model_fields.items() if field.is_required())
    return InputProblem(dotted(path), NOTHING, f"a section with at least {required}", f"add a section [{dotted(path)}]")


def _declaration(names: list[str], model: type[BaseModel]) -> FieldInfo:
    """The declaration of a key or section at the end of a path."""
    field = model.model_fields[names[0]]
    section = section_of(field)
    return field if len(names) == 1 or section is None else _declaration(names[1:], section)


def is_listed(field: FieldInfo) -> bool:
    """Whether a field holds a list."""
    return get_origin(field.annotation) is tuple


def _is_section(value: Any) -> bool:
    """Whether a value is a section, or a list of sections."""
    return isinstance(value[0] if isinstance(value, list) and value else value, dict)


def section_of(field: FieldInfo) -> type[BaseModel] | None:
    """The model of a field that is a section or an optional section, None of other fields."""
    candidates = [field.annotation, *getattr(field.annotation, "__args__", ())]
    return next((c for c in candidates if isinstance(c, type) and issubclass(c, BaseModel)), None)
