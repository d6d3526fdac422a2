"""A scene written as TOML, with the meaning of each key."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel

from evolvent.scene.schema.errors import is_listed, section_of


def toml_lines(section: BaseModel, derived: Mapping[str, Any], name: str = "", header: str = "") -> Iterator[str]:
    """Lines of a section in TOML: its keys with their meaning, then its subsections, several where they are a list.

    derived: dotted key -> default that is derived from other keys, written as a comment. name: dotted, of the section;
    empty for the scene. header: line above its keys; empty for the scene.
    """
    if header:
        yield f"\n{header}"
    subsections = []
    for key_name, field in type(section).model_fields.items():
        value, dotted = getattr(section, key_name), f"{name}.{key_name}" if name else key_name
        if optional := section_of(field):
            subsections.append((dotted, f"[[{dotted}]]" if is_listed(field) else f"[{dotted}]", value, optional))
        elif value is not None:
            yield f"{key_name} = {_toml_value(value)}  # {field.description}"
        elif dotted in derived:
            yield f"# {key_name} = {_toml_value(derived[dotted])}  # {field.description}"
        else:
            yield f"# {key_name}: not given  # {field.description}"
    for subname, above, value, optional in subsections:
        for each in value if isinstance(value, tuple) else () if value is None else (value,):
            yield from toml_lines(each, derived, subname, above)
        if value in (None, ()):
            yield from _not_given(optional, subname, above)


def _not_given(section: type[BaseModel], name: str, header: str) -> Iterator[str]:
    """The lines of an optional section that the scene does not have."""
    yield f"\n# {header}: not given"
    for key_name, field in section.model_fields.items():
        if inner := section_of(field):
            yield from _not_given(inner, f"{name}.{key_name}", f"[{name}.{key_name}]")
        else:
            yield f"# {key_name}: not given  # {field.description}"


def _toml_value(value: object) -> str:
    """A text, number, truth value or tuple of them as TOML, which has the same escape sequences as JSON."""
    if isinstance(value, tuple):
        return "[" + ", ".join(map(_toml_value, value)) + "]"
    if isinstance(value, (str, bool)):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value)
