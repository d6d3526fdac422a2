"""Lines on a table of root stress that is written by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from evolvent.results.archive.run_folder import RunFolder
from evolvent.run.strength.summary_lines import summary_lines
from evolvent.strength.results.tables import COMPRESSION, STRENGTH, TENSION, StrengthRow
from tests.support.made_rows import made

FORMULA = made(StrengthRow, gear="pinion", method="ISO 6336-3:2019", stress_MPa=560.4, load_share=1.0)
ELEMENTS = replace(FORMULA, method=TENSION, friction=0.05, stress_MPa=459.4, stress_MPa_error=5.8, load_share=0.62)
ROWS = [
    FORMULA,
    replace(FORMULA, method="equal shares, tip (e)", stress_MPa=700.0, load_share=0.5, whole_load_MPa=1400.0),
    ELEMENTS,
    replace(ELEMENTS, method=COMPRESSION, stress_MPa=-480.2, stress_MPa_error=math.nan),
    replace(
        ELEMENTS, method=f"{TENSION}, outer point of single contact", stress_MPa=344.0, load_share=0.614,
        whole_load_MPa=548.7,
    ),
    replace(FORMULA, gear="wheel", stress_MPa=570.6),
]


def test_a_line_a_gear(tmp_path: Path) -> None:
    """The standard, tension and compression, an error bar where there is one; tension at the outer point with the
    share of the load, and with all of it; other points of load are left to the table."""
    STRENGTH.write(RunFolder(tmp_path), ROWS)
    assert list(summary_lines(tmp_path)) == [
        "pinion: ISO 6336-3:2019 560 MPa; finite elements, tension 459 ± 6 MPa (μ = 0.05); finite elements, "
        "compression -480 MPa (μ = 0.05); at the outer point of single contact 344 MPa under 61 % of the load, 549 MPa "
        "under all of it",
        "wheel: ISO 6336-3:2019 571 MPa",
    ]
