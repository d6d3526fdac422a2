"""A Python program run in a process of its own, with the environment that a test gives it."""

from __future__ import annotations

import os
import subprocess
import sys

from tests.support.checkout import PYTHONPATH

NOWHERE = "/proc/nowhere"  # a home that nobody can write to, not even root

FORM = """
import numpy as np, ufl
from evolvent.fem.backend import dolfinx_compat
points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
mesh = dolfinx_compat.create_mesh(points, np.array([[0, 1, 2]]), "triangle", 1)
space = dolfinx_compat.vector_space(mesh, 1)
volume = dolfinx_compat.assemble_number(1.0 * ufl.dx(domain=mesh))
assert abs(volume - 0.5) < 1e-14
"""


def python(program: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """A program of its own; an empty value takes the variable away."""
    wanted = {**os.environ, "PYTHONPATH": PYTHONPATH, "OMP_NUM_THREADS": "1", **environment}
    clean = {name: value for name, value in wanted.items() if value}
    command = [sys.executable, "-c", program]
    return subprocess.run(command, env=clean, capture_output=True, text=True, timeout=120, check=False)
