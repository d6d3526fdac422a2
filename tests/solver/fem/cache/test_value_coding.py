"""Values as JSON and arrays. Oracle: the value itself, number by number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pytest
import scipy.sparse as sp

from evolvent.fem.cache.value_coding import CodedValue, coded, decoded
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True, eq=False)
class Inner:
    """Arrays of any order and kind, and a sparse matrix."""

    matrix: Floats
    numbers: Ints
    sparse: sp.csr_matrix
    teeth: range


@dataclass(frozen=True, eq=False)
class Outer:
    """Values in values."""

    inner: tuple[Inner, ...]
    by_name: Mapping[str, Ints]
    size: float
    other: Inner | None = None


def inner(random: np.random.Generator) -> Inner:
    """Some numbers."""
    sparse = sp.random(7, 5, 0.3, format="csr", random_state=1)
    return Inner(random.normal(size=(4, 3)), random.integers(9, size=6), sparse, range(-2, 3))


def test_values_come_back() -> None:
    """A dataclass with tuples, dictionaries, optional parts, sparse matrices and ranges; numbers of NumPy among plain
    ones come back as plain ones of the same value."""
    random = np.random.default_rng(0)
    one, two = inner(random), inner(random)
    value = Outer((one, two), {"a": np.arange(3)}, float(np.float64(0.1)) / 3.0, two)
    found = decoded(coded(value, Outer), Outer)
    assert found.size == value.size and found.other is not None
    for own, other in zip((*found.inner, found.other), (one, two, two)):
        assert np.array_equal(own.matrix, other.matrix) and np.array_equal(own.numbers, other.numbers)
        assert (own.sparse != other.sparse).nnz == 0 and own.teeth == other.teeth
    assert np.array_equal(found.by_name["a"], np.arange(3))
    assert decoded(coded({2: value}, dict[int, Outer]), dict[int, Outer])[2].size == value.size


def test_an_array_that_several_fields_hold_is_kept_once() -> None:
    """Problem: the same part twice. Exact: its five arrays once, and one object when it is read."""
    part = inner(np.random.default_rng(0))
    code = coded(Outer((part, part), {}, 1.0), Outer)
    assert len(code.arrays) == 5
    found = decoded(code, Outer)
    assert found.inner[0].matrix is found.inner[1].matrix


@pytest.mark.parametrize("text", ['{"inner": 3}', "[]", '{"inner": [], "by_name": {"a": 7}, "size": 1.0}', "no JSON"])
def test_another_value_is_an_error(text: str) -> None:
    """A text that is no value of this type: an error, never a value."""
    with pytest.raises(Exception):  # noqa: B017, PT011  cattrs, JSON and lists raise errors of their own
        decoded(CodedValue(text), Outer)
