"""Random scenes or wear studies by the hundred, one after the other in a process of their own that may crash or hang.

The process writes one JSON line a scene; whoever watches it kills it when a scene takes too long and starts the next.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass
from enum import Enum
from pathlib import Path
from queue import Empty, Queue
from threading import Thread
from typing import Any

import numpy as np

from evidence.report import table
from evidence.stress.outcomes import Outcome, Verdict, outcome_of
from evidence.stress.random_scenes import random_scene
from evidence.stress.random_wear import random_study
from evidence.stress.wear_outcomes import WearOutcome, WearVerdict, wear_outcome_of
from evolvent.fem.backend import dolfinx_compat
from evolvent.scene.gear_problem import gear_problem

PATIENCE = 900.0
"""Seconds after which a scene has hung. Nearly all take one to twenty; 206, a wide pair of plastic whose friction
remembers for thirteen pitches, before and after deflection, takes 250 on a core of its own."""


@dataclass(frozen=True)
class Trial:
    """What is tried with a seed. command: of `python -m evidence.stress`, for the process that may die; solve: what it
    does with a seed, which gives an `outcome` with a `verdict`."""

    command: str
    solve: Callable[[int], Any]
    outcome: type
    verdict: type[Enum]


SCENES = Trial("seeds", lambda seed: outcome_of(random_scene(seed), seed), Outcome, Verdict)
WEAR = Trial("wear-seeds", lambda seed: wear_outcome_of(random_study(seed), seed), WearOutcome, WearVerdict)


def solve_seeds(trial: Trial, first: int, count: int) -> None:
    """In the process that may die: one JSON line a seed on standard output."""
    dolfinx_compat.silence_logs()
    for seed in range(first, first + count):
        found = asdict(trial.solve(seed))
        print(json.dumps({**found, "verdict": found["verdict"].name}), flush=True)


def campaign(first: int, count: int, patience: float = PATIENCE, trial: Trial = SCENES) -> Iterator[Any]:
    """The outcomes of the seeds first, first + 1, ..., whatever they do to the process."""
    seed = first
    while seed < first + count:
        for outcome in _until_it_dies(seed, first + count - seed, patience, trial):
            yield outcome
            seed = outcome.seed + 1


def _until_it_dies(first: int, count: int, patience: float, trial: Trial) -> Iterator[Any]:
    command = [sys.executable, "-m", "evidence.stress", trial.command, str(first), str(count)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        assert process.stdout is not None
        lines: Queue[str] = Queue()
        Thread(target=_pass_on, args=(process.stdout, lines), daemon=True).start()
        for seed in range(first, first + count):
            try:
                line = lines.get(timeout=patience)
            except Empty:
                process.kill()
                yield trial.outcome(seed, trial.verdict["HUNG"], f"no result after {patience:g} s")
                return
            if not line:
                yield trial.outcome(seed, trial.verdict["CRASHED"], f"the process ended with status {process.wait()}")
                return
            found = json.loads(line)
            yield trial.outcome(**{**found, "verdict": trial.verdict[found["verdict"]]})


def _pass_on(source: Iterable[str], lines: Queue[str]) -> None:
    """Every line as it comes, and an empty one at the end."""
    for line in source:
        lines.put(line)
    lines.put("")


def write_outcomes(outcomes: list[Outcome], path: Path) -> None:
    """A CSV of all outcomes. Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    rows = ["seed,verdict,balance error,mean iterations,most iterations,dofs,message"]
    rows += [
        f"{o.seed},{o.verdict.value.split(',')[0]},{o.balance:.1e},{o.iterations:.1f},{o.most},{o.dofs},"
        f'"{_first_line(o.message)}"'
        for o in outcomes
    ]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")


def summary(outcomes: list[Outcome]) -> str:
    """What became of the scenes, as Markdown."""
    counts = Counter(o.verdict for o in outcomes)
    rows = [[verdict.value, str(counts[verdict])] for verdict in Verdict]
    solved = [o for o in outcomes if o.verdict is Verdict.CONVERGED]
    flat = [o for o in solved if gear_problem(random_scene(o.seed)).is_plane]
    words = f"{len(outcomes)} scenes, seeds {outcomes[0].seed} to {outcomes[-1].seed}."
    if solved:
        means = [float(np.mean([o.iterations for o in some])) if some else 0.0 for some in (solved, flat)]
        words += (
            f" Of those that converged {len(flat)} are plane and {len(solved) - len(flat)} are not; the balance error "
            f"is at most {max(o.balance for o in solved):.1e} (median {np.median([o.balance for o in solved]):.1e}), "
            f"and Newton's method took {means[0]:.1f} iterations a position on average (plane ones {means[1]:.1f}), "
            f"the frictionless start included."
        )
    bad = [[str(o.seed), o.verdict.value, _first_line(o.message)] for o in outcomes if o not in solved]
    parts = [table(["outcome", "scenes"], rows, right={1}), words]
    return "\n\n".join([*parts, table(["seed", "outcome", "message"], bad, right={0})] if bad else parts)


def _first_line(message: str) -> str:
    return message.strip().splitlines()[-1].replace('"', "'") if message else ""
