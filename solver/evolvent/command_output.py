"""What commands print when they have computed a scene."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer


def done(out: Path, *names: str) -> None:
    """Names the files that were written: pictures, and tables that a scene asks for, may be missing."""
    typer.echo("done: " + ", ".join(str(out / name) for name in names if (out / name).exists()))


def warn(sentences: Sequence[str]) -> None:
    """Prints what a command has returned to be read."""
    for sentence in sentences:
        typer.echo(f"evolvent: warning: {sentence}", err=True)
