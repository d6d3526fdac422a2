"""Functions in compiled code, kept from run to run where there is a place for that."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from numba import njit

F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """The function in compiled code. In an installation and with a home that cannot be written to, nothing is kept: it
    is compiled again in each run, for some seconds."""
    try:
        kept: F = njit(cache=True, error_model="numpy")(function)
    except RuntimeError:  # of Numba's: no locator available
        kept = njit(error_model="numpy")(function)
    return kept
