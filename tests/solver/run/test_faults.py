"""`evolvent run` struck by faults: killed at random times again and again, a rank killed, no folder, no room, a NaN.

Disks that are full at each write in turn are made by full_disks.py. What is damaged at a chosen moment is in
test_archive.py. `make stress` kills 20 times; here it is fewer.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path

import pytest

from evidence.robustness.faults import Struck, arguments, differs, run, struck_again_and_again
from evolvent.results.archive.store import read_arrays
from tests.support.running.processes import BROKEN_RUN, RunScript

STEP, LAST = 20, 640  # kB; a run with its companion takes 610, a position and the flanks no less than a step


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run that nothing happened to."""
    out = tmp_path_factory.mktemp("faults") / "whole"
    done = run(out)
    assert done.returncode == 0, done.stderr
    return out


@pytest.mark.evidence
@pytest.mark.slow
def test_run_killed_at_random_times_is_resumed(whole: Path, tmp_path: Path) -> None:
    """kill -9 at four random moments, each time resumed: every number is that of the undisturbed run within 1e-7, and
    before the end there is no table."""
    struck: Struck = struck_again_and_again(tmp_path / "out", kills=4, seed=1)
    assert struck.kills == 4
    assert differs(tmp_path / "out", whole) < 1e-7


def test_comparison_of_runs_sees_another_torque(whole: Path, tmp_path: Path) -> None:
    """The comparison above sees another torque."""
    assert run(tmp_path / "out", "--set", "load.torque_Nm=170.1").returncode == 0
    assert differs(tmp_path / "out", whole) > 1e-5


@pytest.mark.mpi
def test_killed_rank_ends_the_run(whole: Path, run_script: RunScript, tmp_path: Path) -> None:
    """kill -9 of one of two ranks in its third turn, after two pairs of positions: the run ends at once with a status
    that is not 0, what was complete is whole, and resumed on one rank it is the undisturbed run."""
    out = tmp_path / "out"
    script = BROKEN_RUN
    done = run_script(script, "killrank-1-3", *arguments(out), ranks=2)
    assert done.returncode != 0
    assert not (out / "summary.json").exists()
    assert read_arrays(out / "results" / "state.npz")["complete"] == 4
    assert run(out, "--resume").returncode == 0
    assert differs(out, whole) < 1e-7


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can start a process as another user")
def test_folder_without_write_permission_is_refused(tmp_path: Path) -> None:
    """A folder of another user: status 2, its name and what to do, no traceback."""
    out = tmp_path / "theirs"
    out.mkdir(mode=0o555)
    for folder in (tmp_path, *tmp_path.parents):
        if folder.stat().st_mode & 0o055 != 0o055:
            folder.chmod(folder.stat().st_mode & 0o777 | 0o055)
    done = run(out, user=65534)
    if "ModuleNotFoundError" in done.stderr:
        pytest.skip("another user cannot read the checkout")
    assert done.returncode == 2
    assert f"--out: found {str(out)!r} (Permission denied); allowed: a directory that can be made" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("at", [1, 3])
def test_nan_compliance_is_not_converged(at: int, whole: Path, run_script: RunScript, tmp_path: Path) -> None:
    """A compliance that turns into NaN at the first or third position: status 3 and "not a number", no table, the
    checkpoint before it intact, and once healed --resume completes the run."""
    out = tmp_path / "out"
    done = run_script(BROKEN_RUN, f"nan-{at}", *arguments(out))
    assert done.returncode == 3
    assert "not a number" in done.stderr and "Traceback" not in done.stderr
    assert not (out / "summary.json").exists()
    if at > 1:
        assert read_arrays(out / "results" / "state.npz")["complete"] == at - 1
    assert run(out, "--resume").returncode == 0
    assert differs(out, whole) < 1e-7


@pytest.mark.evidence
@pytest.mark.slow
@pytest.mark.skipif(os.geteuid() != 0, reason="mounting a small file system wants root")
def test_full_disk_at_every_write_is_resumed(run_script: RunScript, tmp_path: Path) -> None:
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
            assert disk["complete"] or Path(found[0]).parent.name != "fields", "fields come after the tables"
    assert disks[-1]["status"] == 0
    assert lacking >= {"gears", "position", "flanks"}
