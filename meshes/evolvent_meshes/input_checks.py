"""Checks of values given by a user; their errors say what was wanted, what was found and what to do.

Parameters that the functions share: `what`, the name of the input; `value`, what was given; `wanted`, `remedy`, words
for the message.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum
from numbers import Integral, Real
from typing import Any, NoReturn, TypeVar

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError

T = TypeVar("T")
SHOWN_LENGTH = 80  # characters of a value in a message
LARGEST = 1e30  # numbers beyond have no physical meaning in any unit, and their squares overflow


def refuse(what: str, wanted: str, found: object, remedy: str) -> NoReturn:
    """Raises InputError.

    what: name of the input.
    wanted: what is allowed.
    found: the value that was given, or `Words` that describe it.
    remedy: what to do.
    """
    raise InputError(f"{what}: wanted {wanted}, found {found if isinstance(found, Words) else shown(found)}; {remedy}")


class Words(str):
    """Text that a message shows without quotes, not as the value of a string."""

    __slots__ = ()


def shown(value: object) -> str:
    """A value as a message shows it: shortened, a large array by its shape and type, an Enum by its name."""
    if isinstance(value, np.ndarray) and value.size > 6:
        return f"an array of shape {value.shape} and type {value.dtype}"
    if isinstance(value, Enum):
        return f"{type(value).__name__}.{value.name}"
    text = " ".join(repr(value).split())
    text = text if len(text) <= SHOWN_LENGTH else text[: SHOWN_LENGTH - 3] + "..."
    return text if isinstance(value, str | Real | None | list | tuple | np.ndarray) else f"{kind_of(value)} {text}"


def kind_of(value: object) -> str:
    """The name of a value's type, with an article."""
    name = type(value).__name__
    return f"{_article(name)} {name}"


def _article(name: str) -> str:
    return "an" if name[0] in "AEIOUaeiou" else "a"


def is_number(value: object) -> bool:
    """Whether the value is a finite real number; booleans are not."""
    return isinstance(value, Real) and not isinstance(value, bool | np.bool_) and bool(np.isfinite(float(value)))


def is_index(value: object) -> bool:
    """Whether the value is an integer; booleans are not."""
    return isinstance(value, Integral) and not isinstance(value, bool | np.bool_)


def number(
    what: str, value: Any, wanted: str = "a finite number", remedy: str = "give a number",
    allowed: Callable[[float], bool] = lambda x: True,
) -> float:
    """The value as a finite number for which `allowed` holds. Raises InputError."""
    if not (is_number(value) and allowed(float(value))):
        refuse(what, wanted, value, remedy)
    refuse_huge(what, value)
    return float(value)


def refuse_huge(what: str, value: Any) -> None:
    """Raises InputError for finite numbers beyond LARGEST."""
    if np.max(np.abs(np.asarray(value, dtype=np.float64)), initial=0.0) > LARGEST:
        refuse(what, f"numbers up to {LARGEST:g}", value, "check the unit: mm, N, MPa")


def numbers(what: str, value: object) -> None:
    """Raises InputError unless the value is a sequence, as which a single number is often given."""
    if not _is_flat(value):
        refuse(what, "a sequence of numbers", value, f"write {what}=({value},)" if is_number(value) else "give a tuple")


def _is_flat(value: object) -> bool:
    """Whether the value is a tuple, list or array of one dimension."""
    return isinstance(value, list | tuple | np.ndarray) and np.ndim(np.asarray(value, dtype=object)) == 1


def vector(what: str, value: Any, lengths: tuple[int, ...], wanted: str, remedy: str) -> tuple[float, ...]:
    """The value as a tuple of finite numbers, of one of these lengths. Raises InputError."""
    if not _is_flat(value):
        refuse(what, wanted, value, remedy)
    if len(value) not in lengths:
        refuse(what, wanted, value, remedy)
    _refuse_no_number(what, wanted, value, remedy)
    refuse_huge(what, value)
    return tuple(float(x) for x in value)


def array(what: str, value: Any, shapes: tuple[tuple[int, ...], ...], remedy: str) -> Floats:
    """The value as an array of finite numbers, of one of these shapes. Raises InputError."""
    wanted = f"finite numbers of shape {' or '.join(str(s) for s in shapes)}"
    try:
        entries = np.array(value, dtype=object)
    except ValueError:  # rows of different lengths
        refuse(what, wanted, value, remedy)
    if entries.shape not in shapes:
        refuse(what, wanted, value, remedy)
    _refuse_no_number(what, wanted, entries.ravel(), remedy)
    refuse_huge(what, value)
    return entries.astype(np.float64)


def _refuse_no_number(what: str, wanted: str, values: Iterable[Any], remedy: str) -> None:
    """Raises InputError that shows the first of some values that is no finite number."""
    for value in values:
        if not is_number(value):
            refuse(what, wanted, Words(f"{shown(value)} in it"), remedy)


def text(what: str, value: Any, remedy: str) -> str:
    """The value as a string that is not empty. Raises InputError."""
    if not isinstance(value, str) or not value:
        refuse(what, "a name", value, remedy)
    return value


def members(what: str, value: Any, kinds: tuple[type[T], ...], example: str) -> tuple[T, ...]:
    """The value as a tuple of objects of these types; it may be any iterable. Raises InputError."""
    names = " or ".join(kind.__name__ for kind in kinds)
    if isinstance(value, str | bytes | dict) or not isinstance(value, Iterable):
        refuse(what, f"a tuple of {names}", value, f"write {example}")
    objects = tuple(value)
    for each in objects:
        if not isinstance(each, kinds):
            refuse(what, f"a tuple of {names}", Words(f"{shown(each)} in it"), f"write {example}")
    return objects


def instance(what: str, value: object, kinds: type | tuple[type, ...], remedy: str) -> None:
    """Raises InputError unless the value is of one of these types."""
    if not isinstance(value, kinds):
        names = [kind.__name__ for kind in (kinds if isinstance(kinds, tuple) else (kinds,))]
        refuse(what, " or ".join(f"{_article(name)} {name}" for name in names), value, remedy)


def both_gears(what: str, value: object, kind: type, optional: bool = False) -> None:
    """Raises InputError unless the value is a tuple of two objects of this type, of pinion and wheel.

    optional: each may be None instead.
    """
    kinds = (kind, type(None)) if optional else (kind,)
    names = f"{kind.__name__} or None" if optional else kind.__name__
    if not (isinstance(value, tuple | list) and len(value) == 2 and all(isinstance(each, kinds) for each in value)):
        refuse(what, f"two of {names}", value, f"write {what}=(pinion, wheel)")


def one_of(what: str, value: object, allowed: tuple[object, ...]) -> None:
    """Raises InputError for any other value; True is not 1."""
    if not any(type(value) is type(each) and value == each for each in allowed):
        refuse(what, " or ".join(map(shown, allowed)), value, "take one of them")
