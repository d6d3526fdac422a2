"""Warnings that point to the user's line."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

from evolvent_meshes import errors

PACKAGE_FOLDERS = f"{Path(__file__).resolve().parents[2]}/", f"{Path(errors.__file__).resolve().parent}/"


def warn_user(message: str, category: type[Warning]) -> None:
    """Warns at the line that called into the packages, however deep below it the warning is raised.

    Python shows a warning with the same text once a line; here each one is shown, as in a loop over meshes each is
    meant. Filters that an application has set still hold.
    """
    frame = sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(PACKAGE_FOLDERS):
        frame = frame.f_back
    name = frame.f_globals.get("__name__", "__main__")
    warnings.warn_explicit(message, category, frame.f_code.co_filename, frame.f_lineno, module=name)
