"""From the text of a scene file and the overrides of the command line to nested values, not yet checked."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from evolvent.scene.schema.errors import Problem, SceneError, dotted_part, shown
from evolvent.scene.text_files import UnreadableText, read_text

EXAMPLE = "demos/yang2022.toml is a complete example"
LARGEST = 1
"""Megabytes of a scene file."""
DEEPEST = 8
"""Tables and lists within one another; a scene needs three."""
UNDECODABLE = (tomllib.TOMLDecodeError, ValueError, RecursionError)
"""ValueError: Python reads no number of more than 4300 digits. RecursionError: brackets within brackets."""


def scene_text(path: Path) -> str:
    """The text of a scene file. Raises SceneError."""
    try:
        return read_text(path, "TOML", LARGEST)
    except UnreadableText as error:
        remedy = f"{error.remedy}; {EXAMPLE}"
        raise SceneError([Problem("scene file", error.found, error.allowed, remedy)], str(path)) from error


def nested_values(text: str, overrides: Sequence[str], folder: Path) -> dict[str, Any]:
    """Sections and keys of a scene. folder: where the files that the text names are looked for; those of overrides are
    looked for where the program runs. Raises SceneError."""
    try:
        values = tomllib.loads(text)
    except UNDECODABLE as error:
        raise SceneError([_no_toml(error)]) from error
    for section in (values.get("pinion"), values.get("wheel")):
        if isinstance(section, dict) and isinstance(section.get("flank_csv"), str):
            section["flank_csv"] = str(folder / section["flank_csv"]) if section["flank_csv"] else ""
    for override in overrides:
        _apply(values, override)
    _require_shallow(values)
    return values


def _no_toml(error: Exception) -> Problem:
    """What keeps a text from being TOML."""
    remedy = f'mend that line; texts stand in "quotes", every key only once; {EXAMPLE}'
    if isinstance(error, tomllib.TOMLDecodeError):
        return Problem("scene file", f"no TOML: {error}", "valid TOML 1.0", remedy)
    if isinstance(error, RecursionError):
        return Problem("scene file", "brackets nested too deep", f"tables and lists up to {DEEPEST} deep", remedy)
    return Problem("scene file", "a number of thousands of digits", "numbers of up to 4300 digits", remedy)


def _require_shallow(values: dict[str, Any]) -> None:
    """Raises SceneError where tables and lists lie too deep within one another for what reads them."""
    waiting: list[tuple[str, Any, int]] = [(name, value, 1) for name, value in values.items()]
    while waiting:
        name, value, depth = waiting.pop()
        if depth > DEEPEST:
            allowed, remedy = f"tables and lists up to {DEEPEST} deep", "see docs/scene.md for the keys"
            raise SceneError([Problem(dotted_part(name), f"values nested more than {DEEPEST} deep", allowed, remedy)])
        inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
        waiting += [(name, each, depth + 1) for each in inner if isinstance(each, (dict, list))]


def _apply(values: dict[str, Any], override: str) -> None:
    """Put one "section.key=value" into the nested values."""
    name, equals, text = override.partition("=")
    names = [part.strip() for part in name.split(".")]
    if not equals or not all(names) or len(names) > DEEPEST:
        remedy = "write for example --set load.torque_Nm=300"
        raise SceneError([Problem("--set", shown(override), "section.key=value", remedy)])
    table = values
    for depth, part in enumerate(names[:-1]):
        inner = table.setdefault(part, {})
        if not isinstance(inner, dict):
            found = f"a key below {'.'.join(names[: depth + 1])}, which has the value {shown(inner)}"
            raise SceneError([Problem(name, found, "section.key=value", "see docs/scene.md for the keys")])
        table = inner
    table[names[-1]] = _parsed(name, text.strip())


def _parsed(name: str, text: str) -> Any:
    try:
        parsed = tomllib.loads(f"value = {text}")
    except UNDECODABLE:
        parsed = {}
    if list(parsed) == ["value"]:
        return parsed["value"]
    if re.fullmatch(r"[A-Za-z][\w -]*|[^\"'\[]+\.csv", text):  # shells take the quotes away: --set mesh.level=quick
        return text
    remedy = f"""write for example --set '{name}=1.5' or --set '{name}=[0.1, 0.2]', in quotes for the shell"""
    raise SceneError([Problem(name, shown(text) if text else "nothing after the =", "one TOML value", remedy)])
