"""Options of the C compiler that the user's environment gives, and that it refuses."""

from __future__ import annotations

import os
import shlex
import subprocess
import sysconfig
import tempfile
from pathlib import Path

VARIABLES = ("CFLAGS", "CPPFLAGS", "LDFLAGS")
"""Environment variables whose words stand in every command of the compiler."""
PROGRAM = "int evolvent;\n"
PATIENCE = 60.0
"""Longest time to compile the smallest program [s]."""


def refused_options() -> str:
    """The options with which the compiler does not compile even the smallest program, its words on them, and a remedy.

    Empty where no options are set, where it compiles it, and where there is no compiler.
    """
    given = {name: os.environ[name] for name in VARIABLES if os.environ.get(name)}
    compiler = shlex.split(os.environ.get("CC") or sysconfig.get_config_var("CC") or "cc")
    words = _complaint(compiler, [word for text in given.values() for word in shlex.split(text)]) if given else ""
    if not words:
        return ""
    options = ", ".join(f"{name}={text!r}" for name, text in given.items())
    return f"{options}, with which the compiler ends ({words}); unset {' '.join(given)}, or correct the options"


def _complaint(compiler: list[str], options: list[str]) -> str:
    """First line of the compiler's output on these options that is no warning; empty where it accepts them."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "program.so"
        command = [*compiler, "-x", "c", "-", "-shared", "-fPIC", "-o", str(out), *options]
        try:
            done = subprocess.run(
                command, input=PROGRAM, capture_output=True, text=True, errors="replace", timeout=PATIENCE, check=False
            )
        except (OSError, subprocess.TimeoutExpired):
            return ""
    lines = [line.strip() for line in done.stderr.splitlines() if line.strip()] or [f"status {done.returncode}"]
    return "" if done.returncode == 0 else next((line for line in lines if "warning" not in line), lines[0])
