"""What became of random scenes and wear studies: a CSV file of all, and a summary for the page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from evidence.robustness.campaigns.random_scenes import random_scene
from evidence.robustness.campaigns.scene_outcomes import Outcome, Verdict
from evidence.robustness.campaigns.wear_outcomes import BLOCKS, WearOutcome, WearVerdict
from evidence.tables import Column, Table, markdown
from evolvent.scene.gear_problem import gear_problem

SCENES = Table(
    Outcome,
    (
        Column("seed", "seed"), Column("verdict", lambda outcome: outcome.verdict.value.split(",")[0]),
        Column("balance error", "balance", ".1e"), Column("mean iterations", "iterations", ".1f"),
        Column("most iterations", "most"), Column("dofs", "dofs"), Column("message", "line"),
    ),
)
STUDIES = Table(
    WearOutcome,
    (
        Column("seed", "seed"), Column("kind", "kind"), Column("verdict", lambda outcome: outcome.verdict.value),
        Column("largest K/H [mm²/N]", "fastest", ".2g"), Column("blocks", "blocks"), Column("refused", "refused"),
        Column("block error", "error", ".2g"), Column("depth", "depth", ".2g"), Column("message", "line"),
    ),
)
BAD_COLUMNS = (
    Column("seed", "seed"),
    Column("outcome", lambda outcome: outcome.verdict.value, words=True),
    Column("message", "line", words=True),
)
BAD_SCENES = Table(Outcome, BAD_COLUMNS)
BAD_STUDIES = Table(WearOutcome, (BAD_COLUMNS[0], Column("kind", "kind", words=True), *BAD_COLUMNS[1:]))


def scene_summary(outcomes: Sequence[Outcome]) -> str:
    """Counts, the numbers of those that converged, and every other message, as Markdown."""
    solved = _converged(outcomes)
    plane = [outcome for outcome in solved if gear_problem(random_scene(outcome.seed)).is_plane]
    more = f"{len(plane)} of those that converged are plane"
    more += f", with {_mean_iterations(plane):.1f} iterations." if plane else "."
    return _counted(outcomes, more)


def level_summary(outcomes: Sequence[Outcome]) -> str:
    """The same of scenes in space on flanks in levels."""
    return _counted(outcomes, "All are in space, on second-order hexahedra, with flanks in levels (two_level.md).")


def _converged(outcomes: Sequence[Outcome]) -> list[Outcome]:
    return [outcome for outcome in outcomes if outcome.verdict is Verdict.CONVERGED]


def _mean_iterations(outcomes: Sequence[Outcome]) -> float:
    return float(np.mean([outcome.iterations for outcome in outcomes]))


def _counted(outcomes: Sequence[Outcome], more: str) -> str:
    """more: a sentence behind the numbers of those that converged."""
    counts, solved = Counter(outcome.verdict for outcome in outcomes), _converged(outcomes)
    words = f"{len(outcomes)} scenes, seeds {outcomes[0].seed} to {outcomes[-1].seed}."
    if solved:
        balances = [outcome.balance for outcome in solved]
        words += (
            f" Of those that converged the balance error is at most {max(balances):.1e} (median "
            f"{np.median(balances):.1e}), and Newton's method took {_mean_iterations(solved):.1f} iterations a "
            f"position on average, the frictionless start included. {more}"
        )
    rows = [[verdict.value, str(counts[verdict])] for verdict in Verdict]
    bad = [outcome for outcome in outcomes if outcome not in solved]
    parts = [markdown(["outcome", "scenes"], rows, right={1}), words]
    return "\n\n".join([*parts, BAD_SCENES.markdown(bad)] if bad else parts)


def wear_summary(outcomes: Sequence[WearOutcome]) -> str:
    """Counts by kind, and every message, as Markdown."""
    kinds = sorted({outcome.kind or "unknown" for outcome in outcomes})
    counts = Counter((outcome.verdict, outcome.kind or "unknown") for outcome in outcomes)
    fastest, deepest = max(outcome.fastest for outcome in outcomes), max(outcome.depth for outcome in outcomes)
    done, refused = sum(outcome.blocks for outcome in outcomes), sum(outcome.refused for outcome in outcomes)
    left = sum(outcome.blocks == BLOCKS for outcome in outcomes)
    words = (
        f"{len(outcomes)} studies of up to {BLOCKS} blocks, seeds {outcomes[0].seed} to {outcomes[-1].seed}: K/H up to "
        f"{fastest:.2g} mm²/N, worn to {deepest:.2g} of a module, radius or height at most; {done} blocks were "
        f"accepted, {refused} refused and made shorter, {left} studies left after the last one. Wrong is a state "
        "that was accepted with a cell turned over, a depth that is no number or comes back, a volume that is not "
        "K/H·∫∫p|v_s| dA dt within 1e-6, or a mesh that has not lost the same within 1 %; and a stop whose message "
        "does not say what was wanted and found, or after which the last good state cannot be solved again."
    )
    rows = [[verdict.value, *(str(counts[verdict, kind]) for kind in kinds)] for verdict in WearVerdict]
    bad = [outcome for outcome in outcomes if outcome.verdict is not WearVerdict.FINISHED]
    parts = [markdown(["outcome", *kinds], rows, right=range(1, len(kinds) + 1)), words]
    return "\n\n".join([*parts, BAD_STUDIES.markdown(bad)] if bad else parts)
