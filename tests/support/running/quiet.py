"""Computations without a display of their progress."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from evolvent.gears.gear_model import Preparer, prepare_model
from evolvent.run.call import Options
from evolvent.run.computation import Computation
from evolvent.run.compute import compute


def quietly(
    what: Computation[Any], out: Path, resume: bool = False, overwrite: bool = False, prepare: Preparer = prepare_model
) -> list[str]:
    """See `compute`."""
    return compute(what, out, Options(resume, overwrite, quiet=True, prepare=prepare))
