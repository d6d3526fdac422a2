"""Starts a command and writes what it took: python -S launch.py COST.json RANKS WORD ...

A small process of its own: Linux counts the memory of the process that starts another one into the largest resident
memory of that one, and the benchmark itself is large. The memory of several ranks is that of all processes of this
session at once, sampled: pages that they share count once.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

SAMPLING = 2.0
"""Seconds between two looks at the memory of several ranks, which take some hundredths of a second each."""


def main() -> int:
    out, ranks, *words = sys.argv[1:]
    begin = time.perf_counter()
    process = subprocess.Popen(words)
    together = _largest_together(process.pid) if int(ranks) > 1 else None
    _, status, used = os.wait4(process.pid, 0)
    wall = time.perf_counter() - begin
    memory = used.ru_maxrss / 1024.0 if together is None else together
    Path(out).write_text(json.dumps({"wall": wall, "cpu": used.ru_utime + used.ru_stime, "memory_MB": memory}))
    code = os.waitstatus_to_exitcode(status)
    return 128 - code if code < 0 else code


def _largest_together(pid: int) -> float:
    """Largest sampled memory [MB] of all processes of this session until the command ends."""
    largest, looked = 0.0, time.monotonic() - SAMPLING
    while os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
        if time.monotonic() - looked >= SAMPLING:
            largest, looked = max(largest, sum(map(_proportional, _session()))), time.monotonic()
        time.sleep(0.02)
    return largest


def _session() -> list[str]:
    """The processes of this session."""
    return [name for name in os.listdir("/proc") if name.isdigit() and _session_of(name) == os.getsid(0)]


def _session_of(pid: str) -> int:
    try:
        return os.getsid(int(pid))
    except OSError:  # it has ended
        return -1


def _proportional(pid: str) -> float:
    """Resident memory of a process [MB]; of pages that n processes share, the n-th part."""
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0.0
    return sum(int(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024.0


if __name__ == "__main__":
    sys.exit(main())
