"""Parses the text of a scene file and the overrides of the command line into nested values, not yet validated."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from evolvent.scene.schema.errors import LONGEST_TEXT, InputProblem, SceneError, dotted_part, shown
from evolvent.scene.schema.guesses.meant_toml import value_written_otherwise, written_otherwise
from evolvent.scene.schema.old_names import Warn, new_names, new_sections
from evolvent_meshes.text_files import UnreadableText, read_text


@dataclass(frozen=True)
class FileKind:
    """A kind of TOML file, for messages."""

    name: str
    """Name of the kind of file."""
    example: str
    """Sentence that names an example."""


SCENE = FileKind("scene file", "demos/yang2022.toml is a complete example")
STUDY_FILE = FileKind("study file", "demos/studies/yang2022_misalignment.toml is a complete example")
OF_STUDIES = frozenset({"compute", "set", "grid", "list", "latin_hypercube"})
"""Keys and sections of study files that scenes do not have."""
LARGEST = 1
"""Largest size of a scene file [MB]."""
DEEPEST = 8
"""Largest nesting depth of tables and lists; a scene needs three."""
DEEPEST_KEY = 1000
"""Largest number of dots in a key: tomllib takes hours over a key of half a million parts."""
TEXT, PATH = r"[A-Za-z][\w -]*|[^\"'\[]+\.csv", r"[^\"'\[{]+"
"""Regular expressions for texts, and for paths and names of materials, that may stand in an override without quotes."""
UNDECODABLE = (tomllib.TOMLDecodeError, ValueError, RecursionError)
"""Exceptions of tomllib: ValueError for integers of more than 4300 digits, RecursionError for deep nesting."""


def scene_text(path: Path, kind: FileKind = SCENE) -> str:
    """Reads a scene file, or another kind of TOML file. Raises SceneError where it cannot be read as text."""
    try:
        return read_text(path, "TOML", LARGEST)
    except UnreadableText as error:
        remedy = f"{error.remedy}; {kind.example}"
        raise SceneError([InputProblem(kind.name, error.found, error.allowed, remedy)], str(path)) from error


def nested_values(text: str, overrides: Sequence[str], folder: Path, warn: Warn) -> dict[str, Any]:
    """Sections and keys of a scene as nested dictionaries.

    overrides: "section.key=value", as `--set` takes them. folder: to which paths in `text` are relative; paths in
    overrides are relative to the current folder. warn: is given a sentence on each old name. Raises SceneError.
    """
    values = toml_values(text)
    require_kind(values, SCENE)
    values = new_sections(values, warn)
    for section in (values.get("pinion"), values.get("wheel")):
        if isinstance(section, dict) and isinstance(section.get("flank_csv"), str):
            section["flank_csv"] = str(folder / section["flank_csv"]) if section["flank_csv"] else ""
    apply_overrides(values, overrides, warn)
    require_shallow(values)
    return values


def toml_values(text: str, kind: FileKind = SCENE) -> dict[str, Any]:
    """Nested dictionaries of a TOML text. Raises SceneError."""
    _require_short_keys(text, kind)
    try:
        return tomllib.loads(text)
    except UNDECODABLE as error:
        raise SceneError([_no_toml(text, error, kind)]) from error


def _require_short_keys(text: str, kind: FileKind) -> None:
    """Raises SceneError where the text has a dotted key, or name of a section, of more parts than any TOML parser is
    made for."""
    *parts, _ = re.split(r"([\n={,\]])", text)
    for part, end in zip(parts[::2], parts[1::2]):
        if end in "=]" and part.count(".") > DEEPEST_KEY:
            found, allowed = f"a key of {part.count('.') + 1:,} parts", f"keys of up to {DEEPEST} parts"
            raise SceneError([InputProblem(kind.name, found, allowed, f"see docs for the keys; {kind.example}")])


def _no_toml(text: str, error: Exception, kind: FileKind) -> InputProblem:
    """Reason why a text cannot be parsed as TOML, with the line of the error."""
    number, line = _named_line(text, str(error))
    remedy = f'mend that line; texts stand in "quotes", every key only once; {kind.example}'
    if known := written_otherwise(line):
        found = f"no TOML in line {number}, {_printable(line)}: {_printable(known.found)}"
        return InputProblem(kind.name, found, "valid TOML 1.0", _printable(known.remedy))
    if isinstance(error, tomllib.TOMLDecodeError):
        found = f"no TOML: {error}{line and ': '}{_printable(line)}"
        return InputProblem(kind.name, found, "valid TOML 1.0", remedy)
    if isinstance(error, RecursionError):
        return InputProblem(kind.name, "brackets nested too deep", f"tables and lists up to {DEEPEST} deep", remedy)
    return InputProblem(kind.name, "a number of thousands of digits", "numbers of up to 4300 digits", remedy)


def _named_line(text: str, message: str) -> tuple[int, str]:
    """Number and text of the line that a message of tomllib names; 0 and empty where it names none."""
    number = re.search(r"\(at line (\d+), ", message)
    lines = text.replace("\r\n", "\n").split("\n")
    if number is None or int(number[1]) > len(lines):
        return 0, ""
    return int(number[1]), lines[int(number[1]) - 1].strip()


def _printable(text: str) -> str:
    """The text shortened, with a question mark for what cannot be printed."""
    return "".join(c if c.isprintable() else "?" for c in text[:LONGEST_TEXT]) + "..." * (len(text) > LONGEST_TEXT)


def require_kind(values: Mapping[str, Any], kind: FileKind) -> None:
    """Raises SceneError where the values of a scene file are those of a study, or the other way round."""
    names = sorted(OF_STUDIES & values.keys())
    if kind is SCENE and isinstance(values.get("scene"), str) and names and "pair" not in values:
        found, remedy = f"a study, with scene and {names[0]}", "use `evolvent study` for it, or give the scene it names"
        raise SceneError([InputProblem(kind.name, found, "a scene (docs/scene.md)", remedy)])
    if kind is STUDY_FILE and isinstance(values.get("pair"), dict) and "scene" not in values and not names:
        remedy = 'use `evolvent check` or `evolvent run` for it; a study names it with scene = "..."'
        problem = InputProblem(kind.name, "a scene, with a section [pair]", "a study (docs/studies.md)", remedy)
        raise SceneError([problem])


def require_shallow(values: dict[str, Any]) -> None:
    """Raises SceneError where tables and lists are nested deeper than `DEEPEST`: validation is recursive."""
    waiting: list[tuple[str, Any, int]] = [(name, value, 1) for name, value in values.items()]
    while waiting:
        name, value, depth = waiting.pop()
        if depth > DEEPEST:
            allowed, remedy = f"tables and lists up to {DEEPEST} deep", "see docs/scene.md for the keys"
            found = f"values nested more than {DEEPEST} deep"
            raise SceneError([InputProblem(dotted_part(name), found, allowed, remedy)])
        inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
        waiting += [(name, each, depth + 1) for each in inner if isinstance(each, (dict, list))]


def apply_overrides(values: dict[str, Any], overrides: Sequence[str], warn: Warn) -> None:
    """Sets each "section.key=value" in the nested values, the last one of a key. warn: is given a sentence on each old
    name. Raises SceneError."""
    for name, value in new_names(dict(map(_override, overrides)), warn).items():
        _put(values, name, value)


def _override(override: str) -> tuple[str, Any]:
    """Dotted key and value of one override. Raises SceneError."""
    name, equals, text = override.partition("=")
    names = [part.strip() for part in name.split(".")]
    if not name.isprintable():  # bytes that are no UTF-8, control characters
        found, allowed = f"a key with {name!a}", "a key of letters, digits and underscores"
        raise SceneError([InputProblem("--set", found, allowed, "write for example --set load.torque_Nm=300")])
    if not equals or not all(names) or len(names) > DEEPEST:
        remedy = "write for example --set load.torque_Nm=300"
        raise SceneError([InputProblem("--set", shown(override), "section.key=value", remedy)])
    return ".".join(names), _parsed(name, text.strip())


def _put(values: dict[str, Any], name: str, value: Any) -> None:
    """Sets a dotted key in the nested values. Raises SceneError where it lies below a value."""
    table, names = values, name.split(".")
    for depth, part in enumerate(names[:-1]):
        inner = table.setdefault(part, {})
        if not isinstance(inner, dict):
            found = f"a key below {'.'.join(names[: depth + 1])}, which has the value {shown(inner)}"
            raise SceneError([InputProblem(name, found, "section.key=value", "see docs/scene.md for the keys")])
        table = inner
    table[names[-1]] = value


def flat_keys(values: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested tables as one with dotted keys, {"load": {"torque_Nm": 1}} -> {"load.torque_Nm": 1}; an empty table is a
    value."""
    flat: dict[str, Any] = {}
    for name, value in values.items():
        inner = isinstance(value, Mapping) and value
        flat |= flat_keys(value, f"{prefix}{name}.") if inner else {f"{prefix}{name}": value}
    return flat


def _parsed(name: str, text: str) -> Any:
    """The value of an override, TOML or text without quotes. Raises SceneError."""
    try:
        parsed = tomllib.loads(f"value = {text}")
    except UNDECODABLE:
        parsed = {}
    if list(parsed) == ["value"]:
        return parsed["value"]
    unquoted = PATH if name.endswith(("_csv", "material")) else TEXT
    if re.fullmatch(unquoted, text):  # shells take the quotes away: --set mesh.level=quick
        return text
    known = value_written_otherwise(text)
    example = f"""write for example --set '{name}=1.5' or --set '{name}=[0.1, 0.2]', in quotes for the shell"""
    found = shown(text) if text else "nothing after the ="
    remedy = example if known is None else f"{_printable(known.remedy)}, as --set '{name}=...' in quotes for the shell"
    raise SceneError([InputProblem(name, found, "one TOML value", remedy)])
