"""`python -m evidence.robustness [PART] [--out docs]`: measures a part, writes OUT/stress.md.

PART: matrix, scenes, levels, wear, dynamics, independence, faults, malformed, or all, the default. Each keeps its piece
of the page in OUT/stress/PART.md, so that one can be measured again alone. `seeds FIRST COUNT`, `level-seeds ...`,
`wear-seeds ...` and `drive-seeds ...` are the processes that `scenes`, `levels`, `wear` and `dynamics` start.
"""

from __future__ import annotations

import argparse
import logging
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from evidence import report
from evidence.checkout import DOCS
from evidence.claims import Claim
from evidence.robustness.campaigns import drive_summaries, summaries
from evidence.robustness.campaigns.campaign import DRIVES, LEVELS, SCENES, WEAR, Trial, all_outcomes, solve_seeds
from evidence.robustness.faults import fault_claims
from evidence.robustness.malformed.summary import malformed_summary
from evidence.robustness.malformed.trials import Verdict, outcomes, trials
from evidence.robustness.settings.independence import cylinder_claims, gear_claims, iteration_claims, theta_claims
from evidence.robustness.settings.level_independence import level_claims
from evidence.robustness.settings.matrix import SHEETS
from evidence.robustness.settings.sheets import draw, write_sheet
from evidence.tables import Column, Table
from evolvent.fem.backend import dolfinx_compat

TITLE, COMMAND = "Robustness", "make stress"
INTRODUCTION = """What happens at the edge of what can be asked: every setting over the widest range that makes
sense, random gear pairs that pass validation, and the method's own parameters. A cell that says "refused" ended with a
message and no result; what was refused is listed below its figure."""
PICTURES = "pictures/stress"
COUNTS = {SCENES.command: 500, LEVELS.command: 100, WEAR.command: 100, DRIVES.command: 200}
CLAIMS = Table(
    Claim,
    (
        Column("quantity", "quantity", words=True),
        Column("found", lambda claim: f"{claim.found:.6g}"),
        Column("wanted", lambda claim: f"{claim.wanted:.6g}"),
        Column("error", lambda claim: f"{claim.error:.2g}"),
        Column("allowed", lambda claim: f"{claim.tolerance:.2g}"),
        Column("", lambda claim: "holds" if claim.holds else "**FAILS**", words=True),
    ),
)
"""NaN is shown: what was refused fails its claim."""


def matrix(out: Path) -> list[str]:
    """Heat maps, their CSV files, and what was refused."""
    (out / PICTURES).mkdir(parents=True, exist_ok=True)
    parts = ["## The matrix of settings"]
    for sheet in (make() for make in SHEETS):
        write_sheet(sheet, out / "stress" / f"{sheet.name}.csv")
        report.picture(draw(sheet), out / PICTURES / f"{sheet.name}.png")
        parts += [f"### {sheet.title}", f"![{sheet.title}]({PICTURES}/{sheet.name}.png)"]
        parts += [f"- {row}, {column}: {message}" for row, column, message in sheet.refused]
        print(f"{sheet.name}: {len(sheet.refused)} refused", flush=True)
    return parts


def scenes(out: Path) -> list[str]:
    """Random scenes, counted."""
    outcomes = _outcomes(SCENES)
    summaries.SCENES.write(out / "stress/scenes.csv", outcomes)
    return ["## Random scenes", summaries.scene_summary(outcomes)]


def levels(out: Path) -> list[str]:
    """Random scenes on flanks in levels of their own, counted."""
    outcomes = _outcomes(LEVELS)
    summaries.SCENES.write(out / "stress/levels.csv", outcomes)
    return ["## Random scenes, flanks in levels", summaries.level_summary(outcomes)]


def wear(out: Path) -> list[str]:
    """Random wear studies, counted, and the messages of those that were stopped."""
    outcomes = _outcomes(WEAR)
    summaries.STUDIES.write(out / "stress/wear.csv", outcomes)
    return ["## Random wear studies", summaries.wear_summary(outcomes)]


def dynamics(out: Path) -> list[str]:
    """Random drives over the speed, counted, and their motions verified."""
    outcomes = _outcomes(DRIVES)
    drive_summaries.DRIVES.write(out / "stress/dynamics.csv", outcomes)
    return ["## Random vibrating pairs", drive_summaries.drive_summary(outcomes)]


def _outcomes(trial: Trial) -> list[Any]:
    """Of all seeds. Control-C ends them early: the page says how many there were."""
    outcomes: list[Any] = []
    count = COUNTS[trial.command]
    try:
        for outcome in all_outcomes(count, trial):
            outcomes.append(outcome)
            print(outcome.seed, outcome.verdict.value, outcome.line, flush=True)
    except KeyboardInterrupt:
        print(f"interrupted after {len(outcomes)} of {count} seeds", flush=True)
    return outcomes


def independence(_: Path) -> list[str]:
    """Claims on γ, θ and iterations."""
    claims = [*gear_claims(), *theta_claims(), *level_claims(), *cylinder_claims(), *iteration_claims()]
    return ["## Independence of γ and θ; iterations", CLAIMS.markdown(claims)]


def faults(_: Path) -> list[str]:
    """Killed and resumed."""
    return ["## Faults", CLAIMS.markdown(fault_claims())]


def malformed(_: Path) -> list[str]:
    """Malformed input to every command."""
    with tempfile.TemporaryDirectory() as folder:
        found = list(outcomes(Path(folder) / "tried", trials()))
    for each in found:
        if each.verdict is not Verdict.REFUSED:
            print(f"{each.command}, {each.wrong}: {each.verdict.value}\n{each.message}", flush=True)
    return ["## Malformed input", malformed_summary(found)]


PARTS: Mapping[str, Callable[[Path], list[str]]] = {
    "matrix": matrix, "scenes": scenes, "levels": levels, "wear": wear, "dynamics": dynamics,
    "independence": independence, "faults": faults, "malformed": malformed,
}
TRIALS = {trial.command: trial for trial in (SCENES, LEVELS, WEAR, DRIVES)}


def main(arguments: list[str]) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=["all", *PARTS, *TRIALS], nargs="?", default="all")
    parser.add_argument("numbers", type=int, nargs="*", help="of seeds and wear-seeds: the first, and how many")
    parser.add_argument("--out", type=Path, default=DOCS, help="folder of the page")
    given = parser.parse_args(arguments)
    dolfinx_compat.silence_logs()
    logging.getLogger("evolvent").setLevel(logging.ERROR)
    if given.part in TRIALS:
        solve_seeds(TRIALS[given.part], *given.numbers)
        return
    for name in PARTS if given.part == "all" else (given.part,):
        report.write(given.out / "stress" / f"{name}.md", PARTS[name](given.out))
    pieces = [given.out / "stress" / f"{name}.md" for name in PARTS]
    texts = [piece.read_text(encoding="utf-8") for piece in pieces if piece.exists()]
    report.write(given.out / "stress.md", [report.header(TITLE, COMMAND), INTRODUCTION, *texts])


if __name__ == "__main__":
    main(sys.argv[1:])
