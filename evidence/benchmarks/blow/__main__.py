"""`python -m evidence.benchmarks.blow`: a block flies against a block, by Evolvent and by CalculiX, for
docs/transient_method.md.

Keeps its tables in docs/benchmark/, its picture in docs/pictures/benchmark/; `python -m evidence.pages` then writes the
page. Takes some minutes. Without CalculiX (`packages/peers build/peers` installs it) nothing is kept.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

from evidence import report
from evidence.benchmarks.blow.comparison import BLOWS, KEPT, PICTURE, SCATTER, Case, cases, picture, scatter
from evidence.checkout import DOCS
from evidence.tables import write_rows

SHOWN = {"all modes", "penalty 3e6 N/mm³"}


def main() -> None:
    """The command line."""
    if shutil.which("ccx") is None:
        sys.exit("blow: wanted CalculiX, found no ccx; `packages/peers build/peers` installs it. Nothing is kept")
    found: list[Case] = []
    with tempfile.TemporaryDirectory() as folder:
        for blow in BLOWS:
            for case in cases(blow, Path(folder)):
                print(case.row, flush=True)
                found.append(case)
        beside = scatter(found, Path(folder))
    write_rows(DOCS / KEPT, [case.row for case in found])
    write_rows(DOCS / SCATTER, [beside])
    finest = [case for case in found if case.course.time_step == BLOWS[-1].time_step]
    report.picture(picture([case for case in finest if case.setting in SHOWN]), DOCS / PICTURE)


if __name__ == "__main__":
    main()
