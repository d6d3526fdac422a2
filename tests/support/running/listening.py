"""What a program and all that it starts listen on, while it runs; by the kernel's tables, without a further program."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

LOOPBACK = ("0100007F", "00000000000000000000000001000000", "0000000000000000FFFF00000100007F")
"""127.0.0.1, ::1 and ::ffff:127.0.0.1 as the kernel writes them."""
LISTEN = "0A"
GLANCE = 0.2
"""Time between two looks [s]."""
SETTLED = 1.0
"""Time after MPI has started in which every port that it opens is open [s]."""
LIBRARY = "libpetsc"
"""Loaded after MPI has started."""
Found = set[tuple[str, str]]
"""Name of a process, address and port as the kernel writes them."""


def processes(pid: int) -> list[int]:
    """A process and all below it."""
    below = [pid]
    for each in below:
        try:
            tasks = list(Path(f"/proc/{each}/task").iterdir())
            below += [int(child) for task in tasks for child in (task / "children").read_text().split()]
        except OSError:  # it has ended
            continue
    return below


def listening(pid: int) -> Found:
    """What one process listens on beyond loopback."""
    try:
        name = Path(f"/proc/{pid}/comm").read_text().strip()
        files = {os.readlink(each) for each in Path(f"/proc/{pid}/fd").iterdir() if each.is_symlink()}
        rows = [line.split() for kind in ("tcp", "tcp6")
                for line in Path(f"/proc/{pid}/net/{kind}").read_text().splitlines()[1:]]
    except OSError:
        return set()
    return {
        (name, row[1]) for row in rows
        if row[3] == LISTEN and row[1].split(":")[0] not in LOOPBACK and f"socket:[{row[9]}]" in files
    }


def started_mpi(pid: int) -> int:
    """How many of the process and those below it have loaded what comes after MPI."""
    return sum(_has_loaded(each, LIBRARY) for each in processes(pid))


def _has_loaded(pid: int, library: str) -> bool:
    try:
        return library in Path(f"/proc/{pid}/maps").read_text()
    except OSError:  # it has ended
        return False


def watched(
    words: Sequence[str], folder: Path, variables: Mapping[str, str], until: Callable[[int], bool], limit: float = 300.0
) -> tuple[Found, str]:
    """What a program listened on beyond loopback until it ended, or until `SETTLED` after a condition held; and what it
    said. Raises RuntimeError where it ends with an error before, TimeoutError after the limit [s]."""
    found: Found = set()
    begin, since = time.monotonic(), float("inf")
    log = folder / "watched.log"
    with open(log, "w+b") as stream:
        process = subprocess.Popen(
            words, cwd=folder, env={**os.environ, **variables}, stdin=subprocess.DEVNULL, stdout=stream, stderr=stream
        )
        try:
            while process.poll() is None and (now := time.monotonic()) < since + SETTLED:
                found |= {each for one in processes(process.pid) for each in listening(one)}
                since = min(since, now) if until(process.pid) else since
                if now > begin + limit:
                    raise TimeoutError(f"{' '.join(words)}: not done after {limit:g} s")
                time.sleep(GLANCE)
            ended = process.returncode
        finally:
            process.terminate()
            process.wait()
    said = log.read_text(errors="replace")
    if ended not in (None, 0):
        raise RuntimeError(f"{' '.join(words)}: status {ended}: {said}")
    return found, said
