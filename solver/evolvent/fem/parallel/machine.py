"""Memory available to a run: the machine's, or the smaller limit of a container or a batch system."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

CGROUP = Path("sys/fs/cgroup")


def machine_megabytes(root: Path = Path("/")) -> float:
    """Memory [MB] of this machine, or the smallest limit of the process's control groups (Linux, versions 1 and 2).

    root: root of the file system; tests give another one.
    """
    return min(_physical(), *_limits(root), float("inf")) / 1e6


def _physical() -> float:
    return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))


def _limits(root: Path) -> Iterator[float]:
    """Limits [bytes] of the process's control groups and of all groups above them.

    In a container the process's group may be the uppermost one that it sees.
    """
    for line in _text(root / "proc/self/cgroup").splitlines():
        _, controllers, group = line.split(":", 2)
        if controllers in ("", "memory"):
            folder = root / CGROUP / controllers
            name = "memory.limit_in_bytes" if controllers else "memory.max"
            path = Path(group.lstrip("/"))
            texts = (_text(folder / each / name).strip() for each in (path, *path.parents))
            yield from (float(text) for text in texts if text.isdigit())


def _text(path: Path) -> str:
    """The text of a file of the kernel; empty where there is none."""
    try:
        return path.read_text(encoding="utf-8")
    except OSError:
        return ""
