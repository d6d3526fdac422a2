"""Warnings that point to the user's line."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

OURS = tuple(str(Path(__file__).resolve().parents[1] / package) + "/" for package in ("meshes", "solver", "wear"))


def warn_user(message: str, category: type[Warning]) -> None:
    """A warning at the line that called into the packages, however deep it is raised."""
    frame, level = sys._getframe(), 1
    while frame.f_back is not None and frame.f_code.co_filename.startswith(OURS):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, category, stacklevel=level)
