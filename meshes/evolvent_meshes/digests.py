"""A digest of a value's content, to tell whether two inputs are the same."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from numbers import Real

import numpy as np


def digest(value: object) -> str:
    """SHA-256 of dataclasses, dictionaries, tuples, lists and arrays of numbers and strings. Numbers outside of arrays
    count by their value, whether they are written 1 or 1.0.

    >>> digest((1, "a")) == digest([1.0, "a"]), digest(("ab", "c")) == digest(("a", "bc"))
    (True, False)
    """
    result = hashlib.sha256()
    for piece in _pieces(value):
        result.update(len(piece).to_bytes(8, "little"))
        result.update(piece)
    return result.hexdigest()


def _pieces(value: object) -> Iterator[bytes]:
    """A value as bytes, piece by piece."""
    if isinstance(value, np.ndarray):
        yield f"{value.dtype} {value.shape}".encode()
        yield np.ascontiguousarray(value).tobytes()
    elif is_dataclass(value):
        yield type(value).__name__.encode()
        for field in fields(value):
            yield field.name.encode()
            yield from _pieces(getattr(value, field.name))
    elif isinstance(value, dict):
        yield f"{len(value)} by name".encode()
        for key in sorted(value):
            yield str(key).encode()
            yield from _pieces(value[key])
    elif isinstance(value, tuple | list):
        yield f"{len(value)} in order".encode()
        for each in value:
            yield from _pieces(each)
    else:
        yield repr(float(value) if isinstance(value, Real) else value).encode()
