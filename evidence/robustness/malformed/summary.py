"""What the page says of malformed input."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from evidence.robustness.malformed.trials import PATIENCE, Outcome, Verdict
from evidence.tables import markdown


def malformed_summary(outcomes: Sequence[Outcome]) -> str:
    """Trials and refusals of each command, and every trial that was not refused."""
    tried = Counter(each.command for each in outcomes)
    refused = Counter(each.command for each in outcomes if each.verdict is Verdict.REFUSED)
    failed = [each for each in outcomes if each.verdict is not Verdict.REFUSED]
    rows = [[f"`{name}`", str(tried[name]), str(refused[name])] for name in tried]
    words = (
        f"**{len(outcomes)}** trials, **{len(failed)}** not refused as they must be: status 2, a message on each error "
        f"that says what was found, no traceback, no file written, within {PATIENCE:g} s. Tried are wrong values of "
        "every parameter of every command, spoilt scenes and studies, and every key of both with values that it cannot "
        "have."
    )
    lines = [f"- `{each.command}`, {each.wrong}: {each.verdict.value}" for each in failed]
    return "\n\n".join([words, markdown(["command", "trials", "refused"], rows, (1, 2)), "\n".join(lines)]).strip()
