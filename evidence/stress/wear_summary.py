"""What became of random wear studies, as a table and as a page."""

from __future__ import annotations

import csv
from collections import Counter
from pathlib import Path

from evidence.report import table
from evidence.stress.wear_outcomes import BLOCKS, WearOutcome, WearVerdict

HEAD = ["seed", "kind", "verdict", "largest K/H [mm²/N]", "blocks", "refused", "block error", "depth", "message"]


def write_wear(outcomes: list[WearOutcome], path: Path) -> None:
    """A CSV of all outcomes. Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(HEAD)
        for o in outcomes:
            numbers = [f"{o.fastest:.2g}", o.blocks, o.refused, f"{o.error:.2g}", f"{o.depth:.2g}"]
            out.writerow([o.seed, o.kind, o.verdict.value, *numbers, _line(o)])


def wear_summary(outcomes: list[WearOutcome]) -> str:
    """What became of the studies, as Markdown: counts by kind, and every message."""
    kinds = sorted({o.kind or "unknown" for o in outcomes})
    counts = Counter((o.verdict, o.kind or "unknown") for o in outcomes)
    rows = [[verdict.value, *(str(counts[verdict, kind]) for kind in kinds)] for verdict in WearVerdict]
    fastest, deepest = max(o.fastest for o in outcomes), max(o.depth for o in outcomes)
    done, refused = sum(o.blocks for o in outcomes), sum(o.refused for o in outcomes)
    left = sum(o.blocks == BLOCKS for o in outcomes)
    words = (
        f"{len(outcomes)} studies of up to {BLOCKS} blocks, seeds {outcomes[0].seed} to {outcomes[-1].seed}: K/H up to "
        f"{fastest:.2g} mm²/N, worn to {deepest:.2g} of a module, radius or height at most; {done} blocks were "
        f"accepted, {refused} refused and made shorter, {left} studies left after the last one. Wrong is a state "
        "that was accepted with a cell turned over, a depth that is no number or comes back, a volume that is not "
        "K/H·∫∫p|v_s| dA dt within 1e-6, or a mesh that has not lost the same within 1 %; and a stop whose message "
        "does not say what was wanted and found, or after which the last good state cannot be solved again."
    )
    bad = [[str(o.seed), o.kind, o.verdict.value, _line(o)] for o in outcomes if o.verdict is not WearVerdict.FINISHED]
    parts = [table(["outcome", *kinds], rows, right=set(range(1, len(kinds) + 1))), words]
    return "\n\n".join([*parts, table(["seed", "kind", "outcome", "message"], bad, right={0})] if bad else parts)


def _line(outcome: WearOutcome) -> str:
    """The last line of its message."""
    return outcome.message.strip().splitlines()[-1] if outcome.message else ""
