"""Suggestions for a value of the wrong type or spelling: 20 for 20.0 or "20", "quick" for "Quick"."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Iterator
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import ConfigDict, TypeAdapter, ValidationError
from pydantic.fields import FieldInfo

from evolvent.scene.schema.guesses.value_words import values_meant

ALIKE = 0.75
"""Least similarity of a misspelled word to one that is allowed (difflib's ratio)."""
LONGEST = 60
"""Longest text for which a value is suggested [characters]."""
STRICT = ConfigDict(strict=True, allow_inf_nan=False)


def meant_value(value: Any, field: FieldInfo) -> Any | None:
    """The first value similar to `value` that is valid for `field`; None where there is none."""
    wanted: Any = field.annotation
    for part in field.metadata:
        wanted = Annotated[wanted, part]
    adapter: TypeAdapter[Any] = TypeAdapter(wanted, config=STRICT)
    candidates = [*_near(value), *_words_like(value, field.annotation)]
    return next((near for near in candidates if _fits(near, adapter)), None)


def expected(kind: str, value: Any) -> str:
    """Remedy for a value of the wrong type.

    kind: type of pydantic's error. Empty where the remedy of the key says it.
    """
    whole = {"int_type": "whole number", "float_type": "number"}.get(kind)
    if whole is None or type(value) is int:  # one of thousands of digits
        return ""
    return f"write the {whole} alone, in digits, without quotes" if isinstance(value, str) else f"write a {whole}"


def _fits(value: Any, adapter: TypeAdapter[Any]) -> bool:
    """Whether a value is valid."""
    try:
        adapter.validate_python(value)
    except ValidationError:
        return False
    return True


def _words_like(value: Any, annotation: Any) -> list[Any]:
    """Values that a word may stand for, and allowed words of similar spelling."""
    if not isinstance(value, str) or len(value) > LONGEST:
        return []
    return [*values_meant(value), *difflib.get_close_matches(value.lower(), _choices(annotation), 1, ALIKE)]


def _choices(annotation: Any) -> list[str]:
    """The words that a type allows."""
    if get_origin(annotation) is Literal:
        return [each for each in get_args(annotation) if isinstance(each, str)]
    return [choice for each in get_args(annotation) for choice in _choices(each)]


def _near(value: Any) -> Iterator[Any]:
    """Values that may be meant by a given value."""
    if isinstance(value, float) and value.is_integer():
        yield int(value)
    elif isinstance(value, list) and len(value) == 1:
        yield from (value[0], *_near(value[0]))
    elif isinstance(value, str) and len(value) <= LONGEST:
        for text in dict.fromkeys((value.strip(), value.strip().lower())):
            yield text
            yield from _read(text)


def _read(text: str) -> Iterator[Any]:
    """The number or truth value that a text holds."""
    try:
        parsed = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return
    if list(parsed) == ["value"] and isinstance(parsed["value"], (int, float)):
        yield from (parsed["value"], *_near(parsed["value"]))
