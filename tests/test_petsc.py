"""PETSc runs with options of our own: those of other programs, in files and in the environment, change nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOREIGN = "-evolvent_snes_max_it 1 -snes_rtol 0.5 -foreign 7"


def options(folder: Path, **environment: str) -> str:
    """PETSc's options in a process that starts in `folder`."""
    code = "import solver.compat; from solver.petsc import PETSc; print(sorted(PETSc.Options().getAll().items()))"
    variables = {**os.environ, "PYTHONPATH": str(ROOT), "HOME": str(folder), **environment}
    return subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env=variables, capture_output=True, text=True, check=True, timeout=60
    ).stdout


@pytest.mark.parametrize("place", ["file", "environment"])
def test_options_of_others_are_not_read(place: str, tmp_path: Path) -> None:
    """A .petscrc in the current folder, which is also home, and PETSC_OPTIONS: none of them gets in."""
    (tmp_path / ".petscrc").write_text(FOREIGN if place == "file" else "", encoding="utf-8")
    found = options(tmp_path, **({"PETSC_OPTIONS": FOREIGN} if place == "environment" else {}))
    assert "skip_petscrc" in found
    assert "foreign" not in found and "snes" not in found


def test_options_on_purpose(tmp_path: Path) -> None:
    """EVOLVENT_PETSC_OPTIONS, which --petsc-options sets, is read."""
    found = options(tmp_path, EVOLVENT_PETSC_OPTIONS="-mat_view :a.txt")
    assert "('mat_view', ':a.txt')" in found
