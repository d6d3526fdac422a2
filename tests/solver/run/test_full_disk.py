"""Disks that are full at each write of a run in turn; see full_disks.py."""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path

import pytest

from tests.support.running.processes import Run

STEP, LAST = 20, 500  # kB; the run takes 460, a position and the flanks in contact no less than a step


@pytest.mark.evidence
@pytest.mark.slow
@pytest.mark.skipif(os.geteuid() != 0, reason="mounting a small file system wants root")
def test_full_disk_at_every_write_is_resumed(run_script: Run, tmp_path: Path) -> None:
    """From a disk without room for the scene to one with room for all: status 1 and one line with file, size, reason
    and remedy; no half-written file, foreign files as they were, and once there is room --resume completes the
    run. The list of files, surfaces, results and fields are among what lacks room."""
    if subprocess.run(["mount", "-t", "tmpfs", "tmpfs", str(tmp_path)], capture_output=True, check=False).returncode:
        pytest.skip("mounting is not allowed here")
    subprocess.run(["umount", str(tmp_path)], check=True)
    settings = ("output.fields=true", "sweep.positions=2", "contact.friction=[0.0, 0.1, 0.2]", "output.error_bars=true")
    sizes = str(STEP), str(LAST)
    done = run_script("tests/support/running/full_disks.py", str(tmp_path), *sizes, *settings, timeout=300.0)
    assert done.returncode == 0, done.stderr
    disks = [json.loads(line) for line in done.stdout.splitlines()]
    assert len(disks) == LAST // STEP
    lacking = set()
    for disk in disks:
        assert disk["kept"] and disk["still"] and not disk["broken"] and not disk["whole"], disk
        told = [line for line in disk["resumed stderr"].splitlines() if not line.startswith("evolvent: warning: ")]
        assert (disk["resumed"], told) == (0, []), disk
        if disk["status"]:
            line = r"evolvent: (\S+): wanted to write \S+ MB, found No space left on device; make room .*--resume.*"
            found = re.findall(rf"^{line}$", disk["stderr"], re.MULTILINE)
            assert disk["status"] == 1 and len(found) == 1, disk
            lacking.add(re.sub(r"[\d_]*\..*", "", Path(found[0]).name))
    assert disks[-1]["status"] == 0
    assert lacking >= {"gears", "position", "flanks"}
    assert any(disk["status"] == 1 and disk["complete"] for disk in disks), "fields come after the tables"
