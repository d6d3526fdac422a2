"""Pages of measured figures: their header with command, machine and versions, their pictures."""

from __future__ import annotations

import os
import platform
from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

from evolvent.fem.backend import dolfinx_compat
from evolvent.results.drawing import style


def header(title: str, command: str) -> str:
    """The page's first lines: its title, the command that writes it, the machine and the versions that it ran on."""
    return "\n".join(
        (
            f"# {title}",
            "",
            f"<!-- Written by `{command}`: do not edit. -->",
            f"Written by `{command}` on {machine()}; {versions()}.",
        )
    )


def machine() -> str:
    """Processor, its cores that this process may use, and memory, in one line."""
    cores = len(os.sched_getaffinity(0))
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    return f"{_processor()}, {cores} core{'s' if cores > 1 else ''}, {memory:.0f} GiB"


def _processor() -> str:
    """The processor's name as Linux tells it; where it tells none, the architecture."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def versions() -> str:
    """Of the solver and what it stands on, in one line."""
    return ", ".join(f"{name} {version}" for name, version in dolfinx_compat.versions().items() if version)


def picture(figure: Figure, path: Path) -> Path:
    """Writes a PNG with a palette, a third as large as one without. Gives its path back. Raises OSError."""
    style.save(figure, path)
    with Image.open(path) as image:
        image.convert("RGB").quantize().save(path, optimize=True)
    return path


def write(path: Path, parts: Sequence[str]) -> Path:
    """Writes a page, an empty line between its parts. Gives its path back. Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n\n".join(part.strip() for part in parts) + "\n", encoding="utf-8")
    return path
