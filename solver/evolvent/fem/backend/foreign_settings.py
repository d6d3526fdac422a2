"""Keeps dolfinx, FFCx and distutils from the user's environment: options files, words of the command line, a home
directory.

An options file in ~/.config or in the current folder belongs to other programs, and one that cannot be read, as in the
home of another user, would end a run.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

READERS = ("dolfinx.jit", "ffcx.parameters", "ffcx.options")
"""Modules that read options files: those of FFCx until 2022, and since."""
Reader = tuple[Any, str, Callable[..., Any]]
"""Module or class, its function that reads files, and the replacement of the function."""
FUNCTIONS = ("_load_parameters", "_load_options")
"""Functions of dolfinx and FFCx that read options files, from the home directory and the current folder."""


@contextmanager
def importing() -> Iterator[None]:
    """Context in which dolfinx is imported: it hands the command line, in which a file name may hold bytes that are no
    UTF-8, to C++, and asks for a home directory, which a user without an entry in the system's list has not."""
    words, homeless = sys.argv, not _has_home()
    sys.argv = ["evolvent"]
    if homeless:
        os.environ["HOME"] = "/"
    try:
        yield
    finally:
        sys.argv = words
        if homeless:
            del os.environ["HOME"]


def _has_home() -> bool:
    try:
        Path.home()
        return True
    except RuntimeError:
        return False


@contextmanager
def no_options_files() -> Iterator[None]:
    """Context in which forms are compiled with the options that are given, and no others. Afterwards the libraries read
    files again, for other programs in this process."""
    readers: list[Reader] = [*_option_readers(), (_distribution(), "find_config_files", lambda self: [])]
    originals = [getattr(owner, name) for owner, name, _ in readers]
    for owner, name, instead in readers:
        setattr(owner, name, instead)
    try:
        yield
    finally:
        for (owner, name, _), original in zip(readers, originals):
            setattr(owner, name, original)


def _option_readers() -> Iterator[Reader]:
    """The functions of dolfinx and FFCx that read options files, in the installed versions. Raises RuntimeError where a
    library has none."""
    for module in (import_module(name) for name in READERS if find_spec(name)):
        names = [name for name in FUNCTIONS if hasattr(module, name)]
        if not names:
            raise RuntimeError(
                f"{module.__name__}: wanted one of {', '.join(FUNCTIONS)}, found none; "
                "evolvent.fem.backend.foreign_settings has to be adapted to this version"
            )
        yield module, names[0], lambda: ({}, {})


def _distribution() -> Any:
    """The class by which libraries are compiled: it looks for setup.cfg in the current folder and for a file in the
    home. Python has it until 3.11, setuptools since."""
    if "distutils" not in sys.modules:
        import_module("setuptools")
    return import_module("distutils.dist").Distribution
