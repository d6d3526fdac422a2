"""Frozen dataclasses of arrays as JSON and a list of arrays, and back. Nothing that is read can run code."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any, TypeVar, get_origin

import numpy as np
import scipy.sparse as sp
from cattrs import Converter

T = TypeVar("T")


@dataclass(frozen=True)
class CodedValue:
    """A value in a form that can be written."""

    text: str
    """JSON of the value, with the number of each array in `arrays`."""
    arrays: list[Any] = field(default_factory=list)
    """Arrays of the value, each one once even where several fields hold it."""


def coded(value: T, kind: type[T]) -> CodedValue:
    """A value as JSON and arrays.

    kind: its type: a dataclass, tuple, list or dictionary of such, of numbers, texts, NumPy arrays and sparse matrices.
    """
    arrays: list[Any] = []
    numbers: dict[int, int] = {}

    def number(array: Any) -> int:
        if id(array) not in numbers:
            numbers[id(array)] = len(arrays)
            arrays.append(array)
        return numbers[id(array)]

    converter = Converter()
    converter.register_unstructure_hook_func(_is_array, number)
    converter.register_unstructure_hook(sp.csr_matrix, lambda m: [*map(number, (m.data, m.indices, m.indptr)), m.shape])
    converter.register_unstructure_hook(range, lambda r: (r.start, r.stop, r.step))
    plain = converter.unstructure(value, unstructure_as=kind)
    return CodedValue(json.dumps(plain, default=lambda scalar: scalar.item()), arrays)


def decoded(value: CodedValue, kind: type[T]) -> T:
    """The value of a type from its coded form. Raises ValueError, KeyError, TypeError, IndexError or an error of cattrs
    where it is none of this type."""
    arrays = value.arrays

    def sparse(parts: Any, _: object) -> sp.csr_matrix:
        *numbers, shape = parts
        return sp.csr_matrix(tuple(arrays[i] for i in numbers), shape=shape, copy=False)

    converter = Converter()
    converter.register_structure_hook_func(_is_array, lambda number, _: arrays[number])
    converter.register_structure_hook(sp.csr_matrix, sparse)
    converter.register_structure_hook(range, lambda ends, _: range(*ends))
    return converter.structure(json.loads(value.text), kind)


def _is_array(kind: Any) -> bool:
    return kind is np.ndarray or get_origin(kind) is np.ndarray
