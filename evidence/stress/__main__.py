"""`python -m evidence.stress [all | matrix | scenes | wear | independence | faults]` measures, writes docs/stress.md.

Each part keeps its own piece of the page, docs/stress/PART.md, so that one can be measured again alone. `seeds FIRST
COUNT` and `wear-seeds FIRST COUNT` are what `scenes` and `wear` start in a process of its own.
"""

from __future__ import annotations

import argparse
import logging
import sys
from collections.abc import Callable
from typing import Any

from evidence import report
from evidence.checkout import DOCS
from evidence.claims import Claim
from evidence.stress.campaign import SCENES, WEAR, Trial, campaign, solve_seeds, summary, write_outcomes
from evidence.stress.faults import fault_claims
from evidence.stress.independence import cylinder_claims, gear_claims, iteration_claims, theta_claims
from evidence.stress.matrix import SHEETS
from evidence.stress.sheets import draw, write_csv
from evidence.stress.wear_summary import wear_summary, write_wear
from evolvent.fem.backend import dolfinx_compat

COUNTS = {SCENES.command: 500, WEAR.command: 100}
TITLE, COMMAND = "Stability under stress", "make stress"
INTRODUCTION = """What happens at the edge of what can be asked: every setting over the widest range that makes
sense, random gear pairs that pass validation, and the method's own parameters. A cell that says "refused" ended with a
message and no result; what was refused is listed below its figure."""


def matrix() -> list[str]:
    """Heat maps, their CSVs, and what was refused."""
    parts = ["## The matrix of settings"]
    for sheet in (make() for make in SHEETS):
        write_csv(sheet, DOCS / "stress" / f"{sheet.name}.csv")
        report.picture(draw(sheet), DOCS / "pictures/stress" / f"{sheet.name}.png")
        parts += [f"### {sheet.title}", f"![{sheet.title}](pictures/stress/{sheet.name}.png)"]
        parts += [f"- {row}, {column}: {message}" for row, column, message in sheet.refused]
        print(f"{sheet.name}: {len(sheet.refused)} refused", flush=True)
    return parts


def scenes() -> list[str]:
    """Random scenes, counted."""
    outcomes = _outcomes(SCENES)
    write_outcomes(outcomes, DOCS / "stress/scenes.csv")
    return ["## Random scenes", summary(outcomes)]


def wear() -> list[str]:
    """Random wear studies, counted, and what those that were stopped said."""
    outcomes = _outcomes(WEAR)
    write_wear(outcomes, DOCS / "stress/wear.csv")
    return ["## Random wear studies", wear_summary(outcomes)]


def _outcomes(trial: Trial) -> list[Any]:
    """Of all seeds. Control-C ends them early: the page says how many there were."""
    outcomes: list[Any] = []
    count = COUNTS[trial.command]
    try:
        for outcome in campaign(0, count, trial=trial):
            outcomes.append(outcome)
            print(outcome.seed, outcome.verdict.value, outcome.message.splitlines()[-1:], flush=True)
    except KeyboardInterrupt:
        print(f"interrupted after {len(outcomes)} of {count} seeds", flush=True)
    return outcomes


def independence() -> list[str]:
    """Claims on γ, θ and iterations."""
    claims = [*gear_claims(), *theta_claims(), *cylinder_claims(), *iteration_claims()]
    return ["## Independence of γ and θ; iterations", _claimed(claims)]


def faults() -> list[str]:
    """Killed and resumed."""
    return ["## Faults", _claimed(fault_claims())]


def _claimed(claims: list[Claim]) -> str:
    head = ["quantity", "found", "wanted", "error", "allowed", ""]
    return report.table(head, [_row(claim) for claim in claims], right={1, 2, 3, 4})


def _row(claim: Claim) -> list[str]:
    numbers = [f"{value:.6g}" for value in (claim.found, claim.wanted)]
    errors = [f"{value:.2g}" for value in (claim.error, claim.tolerance)]
    return [claim.quantity, *numbers, *errors, "holds" if claim.holds else "**FAILS**"]


PARTS: dict[str, Callable[[], list[str]]] = {
    "matrix": matrix, "scenes": scenes, "wear": wear, "independence": independence, "faults": faults,
}  # fmt: skip


TRIALS = {trial.command: trial for trial in (SCENES, WEAR)}


def main(arguments: list[str]) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=["all", *PARTS, *TRIALS], nargs="?", default="all")
    parser.add_argument("numbers", type=int, nargs="*", help="of seeds and wear-seeds: the first, and how many")
    given = parser.parse_args(arguments)
    dolfinx_compat.silence_logs()
    logging.getLogger("evolvent").setLevel(logging.ERROR)
    if given.part in TRIALS:
        solve_seeds(TRIALS[given.part], *given.numbers)
        return
    for name in PARTS if given.part == "all" else (given.part,):
        report.write(DOCS / "stress" / f"{name}.md", PARTS[name]())
    pieces = [DOCS / "stress" / f"{name}.md" for name in PARTS]
    texts = [piece.read_text(encoding="utf-8") for piece in pieces if piece.exists()]
    report.write(DOCS / "stress.md", [report.header(TITLE, COMMAND), INTRODUCTION, *texts])


if __name__ == "__main__":
    main(sys.argv[1:])
