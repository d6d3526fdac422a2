"""Random scenes, wear studies or drives by the hundred, one after the other in processes that may crash or hang.

A process writes one line of JSON a seed. It is killed where a seed takes too long, and started again with the next.
"""

from __future__ import annotations

import json
import os
import subprocess
import time
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from enum import Enum
from queue import Empty, Queue
from threading import Event, Thread
from typing import Any

from evidence.processes import environment, module_run
from evidence.robustness.campaigns.drive_outcomes import DriveOutcome, DriveVerdict, drive_outcome_of
from evidence.robustness.campaigns.random_drives import random_drive
from evidence.robustness.campaigns.random_scenes import random_scene
from evidence.robustness.campaigns.random_wear import random_study
from evidence.robustness.campaigns.scene_outcomes import Outcome, Verdict, outcome_of
from evidence.robustness.campaigns.wear_outcomes import WearOutcome, WearVerdict, wear_outcome_of
from evolvent.fem.backend import dolfinx_compat

PATIENCE = 900.0
"""Seconds after which a seed has hung. Nearly all take one to twenty; 206, a wide plastic pair whose friction history
lasts thirteen pitches, before and after deflection, takes 250 on a core of its own."""

LOOK = 0.5
"""Seconds between two looks at whether a campaign has been ended."""
CHUNK = 10
"""Consecutive seeds of one task. A task runs one process at a time, and starts another after a crash or hang."""


@dataclass(frozen=True)
class Trial:
    """What is done with each seed."""

    command: str
    """Of `python -m evidence.robustness`, for the process that may die."""
    solve: Callable[[int], Any]
    """Seed -> an `outcome` with a `verdict`."""
    outcome: type
    verdict: type[Enum]


SCENES = Trial("seeds", lambda seed: outcome_of(random_scene(seed), seed), Outcome, Verdict)
LEVELS = Trial(
    "level-seeds", lambda seed: outcome_of(random_scene(seed, plane=False), seed, in_levels=True), Outcome, Verdict
)
DRIVES = Trial("drive-seeds", lambda seed: drive_outcome_of(random_drive(seed), seed), DriveOutcome, DriveVerdict)
WEAR = Trial("wear-seeds", lambda seed: wear_outcome_of(random_study(seed), seed), WearOutcome, WearVerdict)


def solve_seeds(trial: Trial, first: int, count: int) -> None:
    """In the process that may die: one JSON line a seed on standard output."""
    dolfinx_compat.silence_logs()
    for seed in range(first, first + count):
        outcome = trial.solve(seed)
        print(json.dumps({**asdict(outcome), "verdict": outcome.verdict.name}), flush=True)


def all_outcomes(count: int, trial: Trial) -> Generator[Any, None, None]:
    """The outcomes of the seeds 0 to count − 1 in order, by as many processes at a time as there are cores. They end
    with the iteration."""
    ended = Event()
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        chunks = [
            pool.submit(list, campaign(first, min(CHUNK, count - first), PATIENCE, trial, ended))
            for first in range(0, count, CHUNK)
        ]
        try:
            for chunk in chunks:
                yield from chunk.result()
        finally:
            ended.set()
            for chunk in chunks:
                chunk.cancel()


def campaign(first: int, count: int, patience: float, trial: Trial, ended: Event) -> Iterator[Any]:
    """The outcomes of the seeds first, first + 1, ..., whatever they do to the process, until `ended` is set."""
    seed = first
    while seed < first + count and not ended.is_set():
        for outcome in _until_it_dies(seed, first + count - seed, patience, trial, ended):
            yield outcome
            seed = outcome.seed + 1


def _until_it_dies(first: int, count: int, patience: float, trial: Trial, ended: Event) -> Iterator[Any]:
    command = module_run("evidence.robustness", trial.command, first, count)
    with subprocess.Popen(
        command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        assert process.stdout is not None
        lines: Queue[str] = Queue()
        Thread(target=_pass_on, args=(process.stdout, lines), daemon=True).start()
        for seed in range(first, first + count):
            try:
                line = _next(lines, patience, ended)
            except Empty:
                process.kill()
                if ended.is_set():
                    return
                yield trial.outcome(seed, trial.verdict["HUNG"], f"no result after {patience:g} s")
                return
            if not line:
                yield trial.outcome(seed, trial.verdict["CRASHED"], f"the process ended with status {process.wait()}")
                return
            values = json.loads(line)
            yield trial.outcome(**{**values, "verdict": trial.verdict[values["verdict"]]})


def _next(lines: Queue[str], patience: float, ended: Event) -> str:
    """The next line. Raises Empty where there is none within `patience` [s], or `ended` is set before."""
    until = time.monotonic() + patience
    while True:
        try:
            return lines.get(timeout=LOOK)
        except Empty:
            if ended.is_set() or time.monotonic() > until:
                raise


def _pass_on(source: Iterable[str], lines: Queue[str]) -> None:
    """Every line as it comes, and an empty one at the end."""
    for line in source:
        lines.put(line)
    lines.put("")
