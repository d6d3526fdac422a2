"""Lines on a table of root stress that is written by hand."""

from __future__ import annotations

from pathlib import Path

from evolvent.run.strength.summary_lines import summary_lines
from evolvent.strength.results.tables import STRENGTH

ROWS = """gear,method,friction,stress_MPa,stress_MPa_error,load_share,whole_load_MPa
pinion,ISO 6336-3:2019,nan,560.4,nan,1,560.4
pinion,"equal shares, tip (e)",nan,700,nan,0.5,1400
pinion,"finite elements, tension",0.05,459.4,5.8,0.62,741
pinion,"finite elements, compression",0.05,-480.2,nan,0.62,-775
pinion,"finite elements, tension, outer point of single contact",0.05,344,4,0.614,548.7
wheel,ISO 6336-3:2019,nan,570.6,nan,1,570.6
"""


def test_a_line_a_gear(tmp_path: Path) -> None:
    """The standard, tension and compression, an error bar where there is one; tension at the outer point with the
    share of the load, and with all of it; other points of load are left to the table."""
    (tmp_path / STRENGTH).write_text(ROWS, encoding="utf-8")
    assert list(summary_lines(tmp_path)) == [
        "pinion: ISO 6336-3:2019 560 MPa; finite elements, tension 459 ± 6 MPa (μ = 0.05); finite elements, "
        "compression -480 MPa (μ = 0.05); at the outer point of single contact 344 MPa under 61 % of the load, 549 MPa "
        "under all of it",
        "wheel: ISO 6336-3:2019 571 MPa",
    ]
