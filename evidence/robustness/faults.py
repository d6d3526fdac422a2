"""A run killed at random times and resumed until it is complete: its results must be those of an undisturbed run."""

from __future__ import annotations

import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from evidence.checkout import ROOT
from evidence.claims import Claim, regression
from evidence.processes import environment, module_run, run_arguments
from evidence.scenes import QUIET
from evolvent.results.archive.store import read_arrays

SETTINGS = ("contact.friction=[0.1, 0.3]", "sweep.positions=8", *QUIET)
KILLS = 20
GLANCE = 0.02  # s between two looks at a running run
AGREEMENT = 1e-7
PASSING = ("seconds", "residual", "iterations")
"""What depends on the clock or on rounding."""


@dataclass(frozen=True)
class Struck:
    """A run that was killed."""

    complete: tuple[int, ...]
    """Positions, of at least nine, that were complete each time."""

    @property
    def kills(self) -> int:
        return len(self.complete)


def arguments(out: Path, *more: str) -> list[str]:
    """He's spur pair with friction, as words after `evolvent run`."""
    return run_arguments("demos/he2022.toml", out, SETTINGS, "--level", "quick", *more)


def started(out: Path, *more: str, user: int | None = None) -> subprocess.Popen[str]:
    """`evolvent run` of the spur pair in the background. user: the number of another user, for root."""
    command = module_run("evolvent", "run", *arguments(out, *more))
    return subprocess.Popen(
        command, cwd=ROOT, env=environment(), user=user, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def run(out: Path, *more: str, user: int | None = None) -> subprocess.CompletedProcess[str]:
    """`evolvent run` to its end."""
    with started(out, *more, user=user) as process:
        output, errors = process.communicate()
    return subprocess.CompletedProcess(process.args, process.returncode, output, errors)


def struck_again_and_again(out: Path, kills: int, seed: int) -> Struck:
    """Kills a run at random moments, resuming it each time, and lets it end when it was killed so often.

    A kill falls after a random number of positions, at a random time of what an undisturbed run takes there, so that
    start, meshes, positions and writing are all hit on a machine of any speed. A run that is beyond that number, or
    that ended before it was killed, is started anew with --overwrite. Files that are no run's lie in the same folders.
    Raises RuntimeError where resuming does not end well or one of these files is touched.
    """
    rng = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory() as folder:
        stages = _stages(Path(folder) / "out")
    foreign = _foreign_files(out)
    complete: list[int] = []
    while len(complete) < kills:
        after = int(rng.integers(len(stages)))
        anew = (out / "summary.json").exists() or _complete(out) > after
        span = stages[after if anew or _complete(out) < after else 0]
        earlier = _stamp(out) if anew and after else None  # the start is hit from its very beginning
        with started(out, "--overwrite" if anew else "--resume") as process:
            await_positions(process, out, after, earlier)
            try:
                process.communicate(timeout=float(rng.uniform()) * span)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.communicate()
                complete.append(_complete(out))
    last = run(out, "--resume")
    if last.returncode != 0:
        raise RuntimeError(f"{out}: wanted a resumed run to end with status 0, found {last.returncode}: {last.stderr}")
    for path, content in foreign.items():
        if path.read_bytes() != content:
            raise RuntimeError(f"{path}: wanted a file that is no run's as it was, found it changed")
    return Struck(tuple(complete))


def _stages(out: Path) -> list[float]:
    """Seconds of an undisturbed run after 0, 1, ... complete positions until the next, and after the last until its
    end."""
    times = [time.perf_counter()]
    with started(out) as process:
        while process.poll() is None:
            await_positions(process, out, len(times))
            times.append(time.perf_counter())
    return np.diff(times).tolist()


def _foreign_files(out: Path) -> dict[Path, bytes]:
    """Makes files that are no run's, where runs write."""
    foreign = {out / name: name.encode() for name in ("photo.png", "pictures/02_mine.png", "results/measured.npz")}
    for path, content in foreign.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return foreign


class Running(Protocol):
    """What is asked of a run's process."""

    def poll(self) -> int | None:
        """Its exit status, None while it runs."""
        ...


def await_positions(process: Running, out: Path, positions: int, earlier: int | None = None) -> None:
    """Until so many positions are complete, or the run has ended. earlier: the stamp of the state that an earlier run
    left, whose positions do not count."""
    while process.poll() is None and earlier is not None and _stamp(out) == earlier:
        time.sleep(GLANCE)
    while process.poll() is None and _complete(out) < positions:
        time.sleep(GLANCE)


def _stamp(out: Path) -> int | None:
    """When the state of a run was written [ns]; None where there is none."""
    try:
        return (out / "results" / "state.npz").stat().st_mtime_ns
    except FileNotFoundError:
        return None


def _complete(out: Path) -> int:
    """Positions that a run can go on after."""
    state = out / "results" / "state.npz"
    return int(read_arrays(state)["complete"]) if state.exists() else 0


def differs(found: Path, wanted: Path) -> float:
    """Largest difference of any number of two runs' archives over the largest of its array; infinite where something is
    missing."""
    one, other = _numbers(found), _numbers(wanted)
    if one.keys() != other.keys():
        return float("inf")
    return max(_difference(one[name], other[name]) for name in one)


def _numbers(out: Path) -> dict[str, NDArray[Any]]:
    return {
        f"{path.name}/{key}": array
        for path in (out / "results").glob("*.npz")
        if path.name != "measured.npz"
        for key, array in read_arrays(path).items()
        if not key.endswith(PASSING)
    }


def _difference(one: NDArray[Any], other: NDArray[Any]) -> float:
    if one.shape != other.shape or one.dtype.kind != other.dtype.kind:
        return float("inf")
    if one.dtype.kind != "f":
        return 0.0 if np.array_equal(one, other) else float("inf")
    return float(np.abs(one - other).max(initial=0.0) / np.abs(other).max(initial=1e-6))


def fault_claims(kills: int = KILLS) -> list[Claim]:
    """20 kills, then the same numbers as undisturbed."""
    with tempfile.TemporaryDirectory() as folder:
        whole, out = Path(folder) / "whole", Path(folder) / "out"
        run(whole)
        struck = struck_again_and_again(out, kills, seed=0)
        error = differs(out, whole)
    what = (
        f"largest relative difference of any number, spur pair killed {struck.kills} times at random and resumed "
        f"(after {', '.join(map(str, struck.complete))} of 9 positions or more)"
    )
    return [regression("the undisturbed run").bound(what, error, AGREEMENT)]
