"""The base of all sections of a scene file, and the declaration of their keys."""

from __future__ import annotations

from typing import Any, ClassVar, Self

from pydantic import BaseModel, ConfigDict, Field, JsonValue


def key(
    meaning: str,
    allowed: str,
    remedy: str = "",
    *,
    too_small: str = "",
    too_large: str = "",
    needs: tuple[str, ...] = (),
    holding: JsonValue = None,
    default: Any = ...,
    **limits: Any,
) -> Any:
    """Declares a key of the scene.

    meaning: what the key stands for. allowed: which values it takes. remedy: what to do about another value, by default
    to give an allowed one. too_small, too_large: what to do about a value beyond the limits, by default `remedy`.
    needs: the main keys without all of which this one has no effect (`evolvent.scene.schema.dependence`): of the same
    section, or dotted. holding: what the list of a main key must hold for that. default: its value where it is not
    given; a key without a default is required. limits: as for pydantic.Field.
    """
    remedy = remedy or f"give {allowed}"
    words: dict[str, JsonValue] = {
        "allowed": allowed, "remedy": remedy, "too_small": too_small or remedy, "too_large": too_large or remedy,
        "needs": list(needs), "holding": holding,
    }
    return Field(default, description=meaning, json_schema_extra=words, **limits)


class SceneSection(BaseModel):
    """A table of an input file, of a scene by default: frozen, without unknown keys, conversion between types, NaN and
    infinity."""

    kind: ClassVar[str] = "scene"
    """Kind of the input file."""
    page: ClassVar[str] = "docs/scene.md"
    """The page that lists its keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    def changed(self, section: str, **values: Any) -> Self:
        """This with other values of keys in one of its sections. They are not checked."""
        return self.model_copy(update={section: getattr(self, section).model_copy(update=values)})


def listed(value: Any) -> Any:
    """A list as a tuple, other values as they are."""
    return tuple(value) if isinstance(value, list) else value


def as_tuple(value: Any) -> Any:
    """A list as a tuple, a single value as a tuple of one."""
    return tuple(value) if isinstance(value, (list, tuple)) else (value,)
