"""Processes are measured one by one."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from evidence.processes import Command, RunFailed, run
from tests.support.running.processes import one_at_a_time


def test_a_run_costs_what_its_process_takes(tmp_path: Path) -> None:
    """A process that holds 200 MB and spins half a second is told apart from one that does nothing; errors and time
    limits are said."""
    code = "x = bytearray(200_000_000); import time; e = time.process_time() + 0.5\nwhile time.process_time() < e: pass"
    busy = run(Command((sys.executable, "-c", code), tmp_path, tmp_path / "busy.log"))
    idle = run(Command((sys.executable, "-S", "-c", "pass"), tmp_path, tmp_path / "idle.log"))
    assert busy.cpu >= 0.5 > idle.cpu
    assert busy.memory_MB > 190 > 60 > idle.memory_MB
    with pytest.raises(RunFailed, match="exit code 3"):
        run(Command((sys.executable, "-c", "raise SystemExit(3)"), tmp_path, tmp_path / "bad.log"))
    words = sys.executable, "-c", "import time; time.sleep(60)"
    sleeping = Command(words, tmp_path, tmp_path / "long.log", time_limit=0.5)
    with pytest.raises(RunFailed, match="ended after"):
        run(sleeping)


@pytest.mark.mpi
def test_shared_memory_of_ranks_counts_once(tmp_path: Path) -> None:
    """Two ranks that map the same 200 MB and have 50 MB each of their own for five seconds: 300 MB at once, with 15 to
    60 MB each for Python."""
    code = """
import mmap, sys, time
with open(sys.argv[1], "r+b") as file:
    common = mmap.mmap(file.fileno(), 200_000_000)
common[::4096] = bytes(len(common[::4096]))
own = bytearray(50_000_000)
time.sleep(5.0)
"""
    held = tmp_path / "held"
    with open(held, "wb") as file:
        file.truncate(200_000_000)
    words = sys.executable, "-c", code, str(held)
    with one_at_a_time(2):
        cost = run(Command(words, tmp_path, tmp_path / "two.log", ranks=2))
    assert 300 < cost.memory_MB < 420
