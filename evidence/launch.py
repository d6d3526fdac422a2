"""Starts a command and writes what it took: python -S launch.py COST.json WORD ...

A small process of its own: Linux counts the memory of the process that starts another one into the largest resident
memory of that one, and the benchmark itself is large.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path


def main() -> int:
    out, *words = sys.argv[1:]
    begin = time.perf_counter()
    process = subprocess.Popen(words)
    _, status, used = os.wait4(process.pid, 0)
    wall = time.perf_counter() - begin
    cost = {"wall": wall, "cpu": used.ru_utime + used.ru_stime, "memory_MB": used.ru_maxrss / 1024.0}
    Path(out).write_text(json.dumps(cost))
    code = os.waitstatus_to_exitcode(status)
    return 128 - code if code < 0 else code


if __name__ == "__main__":
    sys.exit(main())
