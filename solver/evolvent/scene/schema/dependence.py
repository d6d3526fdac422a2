"""Keys that have an effect only beside a main key, as the start of a tip relief beside its amount.

`evolvent.scene.schema.section.key` declares it (`needs`). A dependent key whose main key is not given is refused. Where
the main key is given with a value that switches it off, as tip_relief_um = 0 of a study, a sentence says that the
dependent one has no effect.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from pydantic import BaseModel

from evolvent.scene.schema.errors import InputProblem, keys_of, shown

OTHER_GEAR = {"pinion": "wheel", "wheel": "pinion"}


@dataclass(frozen=True)
class Dependent:
    """A key that needs a main key."""

    key: str
    """Dotted key that needs a main key."""
    default: Any
    """Value with which the key has no effect of its own."""
    mains: tuple[str, ...]
    """Dotted main keys; one of them is enough."""
    holding: Any
    """Value that the list of a main key must hold; None where any value but none, 0, false and the empty list will do.
    """

    @property
    def wanted(self) -> str:
        """The main keys in words."""
        names = " or ".join(filter(None, [", ".join(self.mains[:-1]), self.mains[-1]]))
        return names if self.holding is None else f"{shown(self.holding)} in {names}"

    def is_used(self, scene: BaseModel) -> bool:
        """Whether one of the main keys has a value with which the key has an effect."""
        values = [value_at(scene, name) for name in self.mains]
        return any(bool(each) if self.holding is None else self.holding in (each or ()) for each in values)


@cache
def dependents(model: type[BaseModel]) -> tuple[Dependent, ...]:
    """All keys of a schema that need a main key."""
    found = []
    for name, field in keys_of(model).items():
        words = field.json_schema_extra
        assert isinstance(words, dict)
        needs, section = words["needs"], name.rpartition(".")[0]
        assert isinstance(needs, list)
        mains = tuple(str(each) if "." in str(each) else f"{section}.{each}" for each in needs)
        if mains:
            found.append(Dependent(name, field.default, mains, words["holding"]))
    return tuple(found)


def without_main_key(scene: BaseModel) -> list[InputProblem]:
    """The problems with the keys of a scene whose main key is not given."""
    return [
        _problem(each, scene) for each in _without_effect(scene)
        if not any(is_given(scene, name) for name in each.mains)
    ]


def effectless_keys(scene: BaseModel) -> list[str]:
    """A sentence on each key of a scene whose main key is given with a value that switches it off."""
    return [
        f"{each.key} = {shown(value_at(scene, each.key))} has no effect: "
        + "; ".join(f"{name} is {shown(value_at(scene, name))}" for name in each.mains if is_given(scene, name)) + "."
        for each in _without_effect(scene) if any(is_given(scene, name) for name in each.mains)
    ]


def value_at(scene: BaseModel, key: str) -> Any:
    """The value of a dotted key; None where the scene does not have its section."""
    value: Any = scene
    for name in key.split("."):
        value = None if value is None else getattr(value, name)
    return value


def is_given(scene: BaseModel, key: str) -> bool:
    """Whether the input file gives a dotted key, with whatever value."""
    section, _, name = key.rpartition(".")
    holder = value_at(scene, section) if section else scene
    return holder is not None and name in holder.model_fields_set and getattr(holder, name) is not None


def _without_effect(scene: BaseModel) -> Iterator[Dependent]:
    """Dependent keys with a value of their own, none of whose main keys uses it."""
    for each in dependents(type(scene)):
        value = value_at(scene, each.key)
        if value is not None and value != each.default and not each.is_used(scene):
            yield each


def _problem(dependent: Dependent, scene: BaseModel) -> InputProblem:
    """Problem with a dependent key: key, main key and remedy, and the other gear where that has the main key."""
    remedy = f"give {dependent.wanted}, or delete the key"
    section, _, name = dependent.key.rpartition(".")
    if (other := OTHER_GEAR.get(section)) and any(is_given(scene, f"{other}.{main.rpartition('.')[2]}")
                                                  for main in dependent.mains):
        has = f"{other} has {', '.join(main.rpartition('.')[2] for main in dependent.mains)}"
        remedy = f"the {has}: write it as {other}.{name} where that is meant; else {remedy}"
    allowed = f"only with {dependent.wanted}, without which it has no effect"
    return InputProblem(dependent.key, shown(value_at(scene, dependent.key)), allowed, remedy)
