"""Old names of a scene's keys and values: read as the new ones, with a warning.

Archives of earlier versions stay valid: `first_names` gives a scene the names under which its fingerprint is made.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from evolvent.scene.schema.errors import InputProblem, SceneError, shown

Warn = Callable[[str], None]
"""Function that is given a warning, one sentence."""


@dataclass(frozen=True)
class Renamed:
    """A key of the scene that has been given another name."""

    old: str
    """First name of the key, dotted."""
    new: str
    """Present name of the key, dotted."""
    values: Mapping[str, str] = field(default_factory=dict)
    """Old value -> new value, of values that have been renamed too."""


RENAMED = (
    Renamed("dynamics.damped_apart", "dynamics.damping_in_separation"),
    Renamed("dynamics.coming", "dynamics.approach", {"up": "run_up", "down": "run_down"}),
    Renamed("skip.off", "exact.parts"),
)
"""All renamed keys. Nothing is removed from this table: fingerprints of archives rest on the old names."""


def unsaid(_: str) -> None:
    """Drops a warning."""


def new_names(given: Mapping[str, Any], warn: Warn) -> dict[str, Any]:
    """Values by dotted keys, under the present names of keys and values. warn: is given a sentence on each old one.

    A list of values, as a study has it, is renamed value by value. Raises SceneError where a key has both names.
    """
    renamed, entries = {}, {name: each for each in RENAMED for name in (each.old, each.new)}
    for name, value in given.items():
        if (entry := entries.get(name)) is None:
            renamed[name] = value
            continue
        if name != entry.new and entry.new in given:
            found, remedy = f"{entry.new}, the new name of the same key, beside it", f"delete {name}"
            raise SceneError([InputProblem(name, found, "one name of a key", remedy)])
        new_value = renamed[entry.new] = _exchanged(value, entry.values)
        if shown(new_value) != shown(value):  # as text: NaN is not equal to itself
            warn(f"{name} = {shown(value)} is the old spelling of {entry.new} = {shown(new_value)}.")
        elif name != entry.new:
            warn(f"{name} is the old name of {entry.new}.")
    return renamed


def new_sections(values: Mapping[str, Any], warn: Warn) -> dict[str, Any]:
    """Nested values of a scene under the present names; see `new_names`."""
    renamed = {section: dict(keys) if isinstance(keys, dict) else keys for section, keys in values.items()}
    for each in RENAMED:
        given = {}
        for name in (each.old, each.new):
            section, key = name.split(".")
            if isinstance(keys := renamed.get(section), dict) and key in keys:
                given[name] = keys.pop(key)
        section, key = each.new.split(".")
        for value in new_names(given, warn).values():
            if isinstance(keys := renamed.setdefault(section, {}), dict):
                keys[key] = value
        if not each.old.startswith(f"{section}.") and renamed.get(each.old.split(".")[0]) == {}:
            del renamed[each.old.split(".")[0]]  # the section itself has another name
    return renamed


def first_names(values: Mapping[str, Any]) -> dict[str, Any]:
    """All sections and keys of a scene, in their order, under the first names of keys and values."""
    first: dict[str, Any] = {}
    entries = {each.new: each for each in RENAMED}
    for section, keys in values.items():
        if not isinstance(keys, Mapping):
            first[section] = keys
            continue
        for key, value in keys.items():
            entry = entries.get(f"{section}.{key}", Renamed(f"{section}.{key}", ""))
            old_section, old_key = entry.old.split(".")
            old_values = {new: old for old, new in entry.values.items()}
            first.setdefault(old_section, {})[old_key] = _exchanged(value, old_values)
    return first


def _exchanged(value: Any, values: Mapping[str, str]) -> Any:
    """The value, or each one of a list, with the other name that a table has for it."""
    if isinstance(value, (list, tuple)):
        return type(value)(_exchanged(each, values) for each in value)
    return values.get(value, value) if isinstance(value, str) else value
