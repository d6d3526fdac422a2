"""PETSc and the form compiler run with options of our own: those of other programs, in files and in the environment,
change nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.checkout import PYTHONPATH

FOREIGN = "-evolvent_snes_max_it 1\n-snes_rtol 0.5\n-foreign 7\n"  # a line each: a file that PETSc could read


def options(folder: Path, **environment: str) -> str:
    """PETSc's options in a process that starts in `folder`."""
    code = """import evolvent.fem.backend.dolfinx_compat
from evolvent.fem.backend.petsc import PETSc
print(sorted(PETSc.Options().getAll().items()))
"""
    variables = {**os.environ, "PYTHONPATH": PYTHONPATH, "HOME": str(folder), **environment}
    return subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env=variables, capture_output=True, text=True, check=True, timeout=60
    ).stdout


@pytest.mark.parametrize("place", ["file", "environment"])
def test_petsc_options_of_others_are_not_read(place: str, tmp_path: Path) -> None:
    """A .petscrc in the current folder, which is also home, and PETSC_OPTIONS: none of them gets in."""
    (tmp_path / ".petscrc").write_text(FOREIGN if place == "file" else "", encoding="utf-8")
    listed = options(tmp_path, **({"PETSC_OPTIONS": FOREIGN} if place == "environment" else {}))
    assert "foreign" not in listed and "snes" not in listed
    assert "skip_petscrc" in listed


def test_petsc_options_of_evolvent_are_read(tmp_path: Path) -> None:
    """EVOLVENT_PETSC_OPTIONS, which --petsc-options sets, is read."""
    listed = options(tmp_path, EVOLVENT_PETSC_OPTIONS="-mat_view :a.txt")
    assert "('mat_view', ':a.txt')" in listed


FORM = """
import numpy as np
from evolvent_meshes.shapes.blocks import rectangle
from evolvent.fem.backend import dolfinx_compat
from evolvent.fem.body import Body, assemble
print(repr(float(abs(assemble(Body(rectangle(1.0, 1.0, 2, 2))).stiffness).sum())))
"""


def test_ffcx_options_of_others_are_not_read(tmp_path: Path) -> None:
    """Files that tell FFCx to drop table values below 0.3 and the compiler to stop at an error, in the current folder
    and in the home's .config: a stiffness is what it is without, to 1e-12 for the sums of three processes."""
    ffcx, jit = '{"epsilon": 0.3, "table_atol": 0.3}', '{"cffi_extra_compile_args": ["-Dnonsense(", "-Werror"]}'
    sums = []
    for kind in ("none", "options", "parameters"):
        home = tmp_path / kind
        for folder in (home, home / ".config" / "ffcx", home / ".config" / "dolfinx"):
            folder.mkdir(parents=True, exist_ok=True)
            (folder / f"ffcx_{kind}.json").write_text(ffcx, encoding="utf-8")
            (folder / f"dolfinx_jit_{kind}.json").write_text(jit, encoding="utf-8")
        variables = {**os.environ, "PYTHONPATH": PYTHONPATH, "HOME": str(home), "XDG_CACHE_HOME": str(home / "cache")}
        variables.pop("XDG_CONFIG_HOME", None)
        done = subprocess.run(
            [sys.executable, "-c", FORM], cwd=home, env=variables, capture_output=True, text=True, timeout=120
        )
        assert done.returncode == 0, done.stderr
        sums.append(float(done.stdout))
    assert sums[1:] == pytest.approx(sums[:1] * 2, rel=1e-12)
