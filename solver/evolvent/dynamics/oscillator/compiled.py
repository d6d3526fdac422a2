"""Compiled functions, cached from run to run where a cache folder can be written."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import numba
from numba import njit

from evolvent.fem.backend.cache_folder import CacheError, cache_directory

F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """The function in compiled code, cached from run to run. Where no cache folder can be written it is compiled again
    in each run, for some seconds."""
    try:
        with _kept_in(str(cache_directory(f"numba-{numba.__version__}"))):
            kept: F = njit(cache=True, error_model="numpy")(function)
    except (CacheError, RuntimeError):  # RuntimeError of Numba's: no locator available
        kept = njit(error_model="numpy")(function)
    return kept


@contextmanager
def _kept_in(folder: str) -> Iterator[None]:
    """Context in which Numba keeps the code of what is decorated in a folder. Its own choice, ~/.cache/numba, may be
    written by other users, and what is read from it is a program."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = folder
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before
