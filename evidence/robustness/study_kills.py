"""`python -m evidence.robustness.study_kills [--kills 30] [--seed 0] [--out docs]`: kills of a study at random moments.

Workers, those that start among them, and the study itself are killed; a study that was killed, has given up, or has
ended, is begun again, until all kills are done; then it is let end. Writes OUT/studies/kills.csv, from which
`make pages` makes rows of docs/studies.md.
"""

from __future__ import annotations

import argparse
import math
import os
import random
import signal
import subprocess
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from evidence.checkout import DOCS, ROOT
from evidence.processes import environment
from evidence.robustness.studies import Measured, rows, yes
from evidence.robustness.study_programs import (
    descendants,
    has_started,
    runs,
    started,
    words,
    workers_for,
    workers_of,
)
from evidence.tables import write_rows

SCENES = """
title = "scenes that share gears, and some that do not"
scene = "{scene}"
compute = "strength"

[set]
pinion.face_width_mm = 25.0
mesh.level = "quick"
sweep.positions = 2
output.error_bars = false

[grid]
load.torque_Nm = [100.0, 200.0, 300.0]
pair.normal_pressure_angle_deg = [20.0, 19.5]
"""
"""Six scenes of Zhang's pair in plane strain, on two pairs of gears."""
ORPHANS, PATIENCE = 10.0, 1200.0
"""Time in which processes end with their study; in which a study ends [s]."""
STUDY, COMPUTING, STARTING = "the study", "workers", "workers that start"
GIVEN_UP = "worker processes one after the other ended while they started"
"""Part of the message of a study that gives up, see `evolvent.run.study.local_workers.STARTS`."""
NAMED = 300
"""Largest number of characters of a message that is printed."""
SAME = 1e-8
"""Largest relative difference of a figure between two runs of a scene (docs/checks.md)."""
LONGEST = {STUDY: 30.0, COMPUTING: 10.0, STARTING: 3.0}
"""Longest time until a process of a kind is killed, from when it is there [s]."""


@dataclass
class Outcome:
    """What kills have led to."""

    kills: Counter[str] = field(default_factory=Counter)
    """Number of kills of each kind."""
    orphans: int = 0
    """Processes that have outlived their study by more than ORPHANS."""
    slowest: float = 0.0
    """Longest time that a process has outlived its study [s]."""
    given_up: int = 0
    """Studies that have ended with a message as more than ten workers in a row were killed while they started."""
    hangs: int = 0
    """Studies that have not ended within PATIENCE."""
    differ: int = 0
    """Tables that differ by more than `SAME` from that of a study without kills."""
    ends: int = 0
    """Studies that have ended by themselves."""


def killed_at_random(folder: Path, kills: int, seed: int) -> Outcome:
    """Kills as many processes, each a random time after it is there, below a folder."""
    random_, outcome, study = random.Random(seed), Outcome(), folder / "study.toml"
    study.write_text(SCENES.format(scene=ROOT / "demos/zhang2023.toml"), encoding="utf-8")
    subprocess.run(words(study, folder / "undisturbed", "--quiet"), cwd=ROOT, env=environment(), check=True)
    wanted = rows(folder / "undisturbed")
    while outcome.hangs == 0 and (outcome.kills.total() < kills or not outcome.ends):
        out = folder / f"out_{outcome.ends}"
        with started(words(study, out, "--quiet", "--workers", "2")) as program:
            while outcome.kills.total() < kills and program.poll() is None:
                kind = random_.choice((STUDY, COMPUTING, STARTING))
                _kill(program, kind, random_.uniform(0.0, LONGEST[kind]), outcome)
            said = ""
            with suppress(subprocess.TimeoutExpired):
                said = "".join(each or "" for each in program.communicate(timeout=PATIENCE))
            if GIVEN_UP in said:
                outcome.given_up += 1
            elif program.returncode != -signal.SIGKILL:
                if program.returncode:
                    print(f"ended with status {program.returncode}: {said.strip()[-NAMED:]}", flush=True)
                outcome.hangs += program.poll() is None
                outcome.differ += program.poll() != 0 or bool(differing(rows(out), wanted))
                outcome.ends += 1
    return outcome


def differing(table: Sequence[Mapping[str, str]], wanted: Sequence[Mapping[str, str]]) -> list[str]:
    """Cells of a table that are not those of the wanted one, numbers to `SAME`; prints them."""
    if [list(row) for row in table] != [list(row) for row in wanted]:
        found = [f"{len(table)} rows, wanted {len(wanted)}, or other columns"]
    else:
        pairs = [(name, row[name], other[name]) for row, other in zip(table, wanted) for name in row]
        found = [f"{name}: {cell}, wanted {other}" for name, cell, other in pairs if not _same(cell, other)]
    for each in found:
        print(f"differs: {each}", flush=True)
    return found


def _same(cell: str, wanted: str) -> bool:
    """Whether two cells are the same text, or numbers that differ by less than `SAME`."""
    with suppress(ValueError):
        return cell == wanted or math.isclose(float(cell), float(wanted), rel_tol=SAME)
    return False


def _kill(program: subprocess.Popen[str], kind: str, seconds: float, outcome: Outcome) -> None:
    """Waits for a process of a kind, then for a time, and kills it where study and process still run."""
    begin = time.monotonic()
    while not (there := _of(kind, program.pid)) and time.monotonic() - begin < PATIENCE and program.poll() is None:
        time.sleep(0.1)
    with suppress(subprocess.TimeoutExpired):
        program.wait(seconds)
    if not there or not runs(there[0]) or program.poll() is not None:
        return
    below = descendants(program.pid)
    with suppress(ProcessLookupError):
        os.kill(there[0], signal.SIGKILL)
        outcome.kills[kind] += 1
        print(f"{outcome.kills.total()}: {kind}, after {seconds:.2f} s", flush=True)
    if kind == STUDY:
        program.wait()
        _outlived(program.pid, below, outcome)


def _of(kind: str, study: int) -> list[int]:
    """Processes of a kind."""
    if kind == STUDY:
        return [study]
    return [each for each in workers_of(study) if has_started(each) == (kind == COMPUTING)]


def _outlived(study: int, below: Sequence[int], outcome: Outcome) -> None:
    """Waits for the end of all processes below a study that has ended."""
    begin = time.monotonic()
    while left := [each for each in {*below, *workers_for(study)} if runs(each)]:
        outcome.slowest = time.monotonic() - begin
        if outcome.slowest > ORPHANS:
            outcome.orphans += len(left)
            return
        time.sleep(0.05)


def measured(outcome: Outcome) -> Iterator[Measured]:
    """Rows for the page."""
    count = ", ".join(f"{number} of {kind}" for kind, number in sorted(outcome.kills.items()))
    yield Measured(f"kills at random moments: {count}", float(outcome.kills.total()), "at least 30",
                   yes(outcome.kills.total() >= 30))
    yield Measured("studies among them that hang", float(outcome.hangs), "0", yes(outcome.hangs == 0))
    yield Measured("studies that say that eleven workers in a row ended while they started, and are begun again",
                   float(outcome.given_up), "any number", "yes")
    yield Measured(f"processes that outlive their study by more than {ORPHANS:g} s", float(outcome.orphans), "0",
                   yes(outcome.orphans == 0))
    yield Measured("longest time that one does [s]", outcome.slowest, "at most 10", yes(not outcome.orphans))
    yield Measured(f"tables, of {outcome.ends} that were ended, that differ", float(outcome.differ), "0",
                   yes(outcome.differ == 0))


def main() -> None:
    """Measures, and writes the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=DOCS)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = list(measured(killed_at_random(Path(folder), given.kills, given.seed)))
    for each in found:
        print(f"{each.what}: {each.found:.4g} (wanted: {each.wanted}) {each.holds}", flush=True)
    (given.out / "studies").mkdir(parents=True, exist_ok=True)
    write_rows(given.out / "studies/kills.csv", found)


if __name__ == "__main__":
    main()
