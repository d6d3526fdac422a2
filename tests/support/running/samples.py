"""Cases of one kind: the first with every `make test`, the others with `make test-evidence`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def sampled(cases: Iterable[Any], every: int = 1) -> list[Any]:
    """The cases for `pytest.mark.parametrize`, of which all but the first `every` are marked `evidence`. A case is a
    value, a tuple of values, or a `pytest.param`."""
    return [case if number < every else _marked(case) for number, case in enumerate(cases)]


def _marked(case: Any) -> Any:
    values = case if isinstance(case, tuple) else (case,)
    return pytest.param(*values, marks=pytest.mark.evidence)
