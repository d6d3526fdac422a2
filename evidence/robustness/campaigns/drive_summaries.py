"""What became of random drives: a CSV file of all, and a summary for the page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from evidence.robustness.campaigns.drive_outcomes import ENERGY, FOLDS, RETURNS, DriveOutcome, DriveVerdict
from evidence.tables import Column, Table, markdown

DRIVES = Table(
    DriveOutcome,
    (
        Column("seed", "seed"), Column("verdict", lambda outcome: outcome.verdict.value), Column("kind", "kind"),
        Column("damping ratio", "damping_ratio", ".3g"), Column("backlash / deflection", "backlash", ".3g"),
        Column("speeds", "speeds"), Column("motions verified", "states"), Column("unstable", "unstable"),
        Column("folds", "folds"), Column("jumps", "jumps"), Column("subharmonic", "subharmonic"),
        Column("not repeating", "unrepeated"), Column("beyond measure", "escaped"),
        Column("error after a period", "returned", ".1e"), Column("over the amplification", "scaled", ".1e"),
        Column("energy error", "energy", ".1e"), Column("CPU [s]", "cpu", ".1f"), Column("message", "line"),
    ),
)
BAD = Table(
    DriveOutcome,
    (
        Column("seed", "seed"), Column("kind", "kind", words=True),
        Column("outcome", lambda outcome: outcome.verdict.value, words=True), Column("message", "line", words=True),
    ),
)


def drive_summary(outcomes: Sequence[DriveOutcome]) -> str:
    """Counts, what was verified and how well, and every message, as Markdown."""
    counts = Counter(outcome.verdict for outcome in outcomes)
    rows = [[verdict.value, str(counts[verdict])] for verdict in DriveVerdict]
    bad = [outcome for outcome in outcomes if outcome.verdict is not DriveVerdict.VERIFIED]
    swept = [outcome for outcome in outcomes if outcome.states]
    parts = [markdown(["outcome", "drives"], rows, right={1}), _what(outcomes)]
    parts += [_found(swept)] if swept else []
    return "\n\n".join([*parts, BAD.markdown(bad)] if bad else parts)


def _what(outcomes: Sequence[DriveOutcome]) -> str:
    """What a seed is, and what is wrong."""
    return (
        f"{len(outcomes)} drives, seeds {outcomes[0].seed} to {outcomes[-1].seed}: drawn mesh stiffnesses, forces that "
        "stiffen, gaps and unloaded errors, damping ratios of 0.002 to 0.5, backlash of 0.03 to 30 static deflections "
        "and none, inertia, load, shafts in series; 60 to 100 speeds from a sixth to 1.6 of the natural one, up and "
        "down. Wrong is: a motion, stable or not, that SciPy's integrator does not lead back to itself after its "
        f"period, within {RETURNS:g} of the static deflection (of the motion where that is larger) times the norm of "
        f"the period map's derivative where that is above 1; a period whose dampers take out what the excitation has "
        f"not put in, within {ENERGY:g}; a branch of steady states whose folds are elsewhere when it is followed from "
        f"its other end, by more than {FOLDS:g} of the speed."
    )


def _found(swept: Sequence[DriveOutcome]) -> str:
    """Figures of those that were swept."""

    def total(name: str) -> int:
        return sum(getattr(outcome, name) for outcome in swept)

    def each(name: str) -> list[float]:
        return [getattr(outcome, name) for outcome in swept]

    lost = [outcome for outcome in swept if outcome.lost]
    return (
        f"{total('states')} motions were verified, {total('unstable')} of them unstable; the largest error after a "
        f"period is {max(each('returned')):.1e}, over the amplification {max(each('scaled')):.1e} (median of the "
        f"drives' largest {np.median(each('scaled')):.1e}), that of the energy {max(each('energy')):.1e}. The branches "
        f"have {total('folds')} folds, and the pairs jump {total('jumps')} times. At {2 * total('speeds')} speeds, up "
        f"and down, the motion repeats after several meshes {total('subharmonic')} times and not within sixteen "
        f"{total('unrepeated')} times; it grows beyond measure (a hundred static deflections) {total('escaped')} "
        f"times. In {len(lost)} drives the branch could not be followed from end to end of the speeds, mostly "
        "as it grows beyond measure: it is followed from both ends then, and the sweep says so. A sweep takes "
        f"{np.median(each('cpu')):.1f} s of CPU time (median; at most {max(each('cpu')):.0f})."
    )
