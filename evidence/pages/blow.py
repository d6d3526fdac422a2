"""The table of docs/transient_method.md beside CalculiX."""

from __future__ import annotations

from pathlib import Path

from evidence.benchmarks.blow.comparison import KEPT, SCATTER, TABLE, Scatter
from evidence.tables import read_rows


def table(docs: Path) -> str:
    """As `python -m evidence.benchmarks.blow` kept it. Raises ValueError where nothing was."""
    rows, scatter = TABLE.read(docs / KEPT), read_rows(docs / SCATTER, Scatter)
    if not (rows and scatter):
        writes = "`python -m evidence.benchmarks.blow` writes them"
        raise ValueError(f"{docs}: wanted {KEPT} and {SCATTER}, found none; {writes}")
    words = (
        f"The lowest {scatter[0].frequencies} natural frequencies of the block that is held differ by at most "
        f"{scatter[0].frequency_difference:.0e}: both programs have the same stiffness and mass. Halving the step "
        f"changes Evolvent's mean force with all modes by up to {scatter[0].step_difference:.1%} of the largest."
    )
    return f"{TABLE.markdown(rows)}\n\n{words}"
