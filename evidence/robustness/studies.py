"""`python -m evidence.robustness.studies [--out docs]`: studies on several workers, killed, and on a Dask cluster.

Writes OUT/studies/measured.csv, from which `make pages` makes the table of docs/studies.md. Half an hour on two cores.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from evidence.checkout import DOCS, ROOT
from evidence.processes import environment
from evidence.robustness.study_programs import (
    PATIENCE,
    records,
    scheduler,
    started,
    times_written,
    until,
    words,
    worker,
)
from evidence.tables import Column, Table, write_rows

SCENES, FEW, KILLS = 200, 12, 3
STUDY = """
title = "small scenes"
scene = "{scene}"
compute = "strength"
leave_out = ["pinion.tip_diameter_mm", "wheel.tip_diameter_mm", "pinion.root_diameter_mm", "wheel.root_diameter_mm"]

[set]
pinion.face_width_mm = 25.0
pinion.dedendum_coefficient = 1.6
wheel.dedendum_coefficient = 1.6
mesh.level = "quick"
sweep.positions = 4
output.error_bars = false

[latin_hypercube]
samples = {samples}

[latin_hypercube.ranges]
pair.normal_pressure_angle_deg = [16.0, 20.0]
pinion.addendum_coefficient = [1.15, 1.35]
wheel.addendum_coefficient = [1.15, 1.35]
load.torque_Nm = [200.0, 500.0]
"""
"""Zhang's pair in plane strain: each scene has gears of its own."""


@dataclass(frozen=True)
class Measured:
    """A figure of studies, and what was wanted."""

    what: str
    """The figure."""
    found: float
    """Its value."""
    wanted: str
    """In words."""
    holds: str
    """yes or no."""


TABLE = Table(
    Measured,
    (Column("figure", "what", words=True), Column("found", "found", ".4g"), Column("wanted", "wanted", words=True),
     Column("holds", "holds", words=True)),
)


def yes(holds: bool) -> str:
    return "yes" if holds else "no"


def on_workers(folder: Path) -> Iterator[Measured]:
    """The same study on one worker and on two."""
    seconds = {}
    for count in (1, 2):
        begin = time.perf_counter()
        _computed(_study(folder, SCENES), folder / f"on_{count}", "--workers", str(count))
        seconds[count] = time.perf_counter() - begin
    ratio = seconds[1] / seconds[2]
    machine = f"{len(os.sched_getaffinity(0))} cores, load {os.getloadavg()[2]:.1f} in the last quarter of an hour"
    yield Measured(f"{SCENES} scenes on 1 worker [s]", seconds[1], machine, "")
    yield Measured("the same on 2 workers: times as fast", ratio, "at least 1.8", yes(ratio >= 1.8))
    yield busy(folder / "on_2", 2)
    same = rows(folder / "on_1") == rows(folder / "on_2")
    yield Measured("tables that differ", float(not same), "0", yes(same))


def busy(out: Path, workers: int) -> Measured:
    """Part of the workers' time, from the first scene's beginning to the last one's end, in which they compute scenes:
    beside other work it says what the speed-up does not."""
    spans = []
    for path in records(out):
        end, seconds = path.stat().st_mtime, float(json.loads(path.read_text(encoding="utf-8"))["seconds"])
        spans.append((end - seconds, end))
    begins, ends = zip(*spans)
    share = sum(end - begin for begin, end in spans) / (workers * (max(ends) - min(begins)))
    wanted = "at least 0.9"
    return Measured(f"share of the time in which {workers} workers compute, {len(spans)} scenes", share, wanted,
                    yes(share >= 0.9))


def killed(folder: Path) -> Iterator[Measured]:
    """A study killed three times, each time after two more scenes, and begun again."""
    study, out = _study(folder, FEW), folder / "killed"
    for kill in range(1, KILLS + 1):
        with started(words(study, out, "--quiet", "--workers", "2")) as program:
            until(lambda: len(records(out)) >= 2 * kill, say=f"{2 * kill} scenes")  # noqa: B023  called at once
            os.kill(program.pid, signal.SIGKILL)
    _computed(study, out, "--workers", "2")
    _computed(study, folder / "undisturbed", "--workers", "2")
    same, times = rows(out) == rows(folder / "undisturbed"), times_written(out)
    yield Measured(f"{FEW} scenes, killed {KILLS} times: tables that differ", float(not same), "0", yes(same))
    twice = sum(count > 1 for count in times)
    yield Measured("scenes that were computed twice", float(twice), "0", yes(twice == 0 and len(times) == FEW))


def on_a_cluster(folder: Path) -> Iterator[Measured]:
    """A running scheduler with three workers, one of which is killed."""
    study, out = _study(folder, FEW), folder / "cluster"
    with ExitStack() as stack:
        address = stack.enter_context(scheduler(folder))
        workers = [stack.enter_context(worker(address, folder)) for _ in range(3)]
        with started(words(study, out, "--quiet", "--scheduler", address)) as program:
            until(lambda: len(records(out)) >= 3, say="three scenes")
            workers[0].kill()
            program.communicate(timeout=10.0 * PATIENCE)
    same = rows(out) == rows(folder / "undisturbed")
    yield Measured("a Dask cluster of 3 workers, one killed: tables that differ", float(not same), "0", yes(same))


def _study(folder: Path, samples: int) -> Path:
    path = folder / f"study_{samples}.toml"
    path.write_text(STUDY.format(scene=ROOT / "demos/zhang2023.toml", samples=samples), encoding="utf-8")
    return path


def _computed(study: Path, out: Path, *options: str) -> None:
    subprocess.run(words(study, out, "--quiet", *options), cwd=ROOT, env=environment(), check=True)


def rows(out: Path) -> list[dict[str, str]]:
    """Rows of a study's table without the time of each scene."""
    with open(out / "study.csv", encoding="utf-8") as stream:
        return [{**row, "seconds": ""} for row in csv.DictReader(stream)]


def main() -> None:
    """Measures, and writes the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=DOCS)
    out = parser.parse_args().out / "studies"
    out.mkdir(parents=True, exist_ok=True)
    found: list[Measured] = []
    with tempfile.TemporaryDirectory() as folder:
        for part in (killed, on_a_cluster, on_workers):
            for each in part(Path(folder)):
                print(f"{each.what}: {each.found:.4g} (wanted: {each.wanted}) {each.holds}", flush=True)
                found.append(each)
                write_rows(out / "measured.csv", found)


if __name__ == "__main__":
    main()
