"""Lines on a table of root stress that is written by hand."""

from __future__ import annotations

from pathlib import Path

from evolvent.run.strength.summary_lines import summary_lines
from evolvent.strength.results.tables import STRENGTH

ROWS = """gear,method,friction,stress_MPa,stress_MPa_error
pinion,ISO 6336-3:2019,nan,560.4,nan
pinion,"equal shares, tip (e)",nan,700,nan
pinion,"finite elements, tension",0.05,459.4,5.8
pinion,"finite elements, compression",0.05,-480.2,nan
pinion,"finite elements, tension, outer point of double contact (b)",0.05,344,4
wheel,ISO 6336-3:2019,nan,570.6,nan
"""


def test_a_line_a_gear(tmp_path: Path) -> None:
    """The standard, tension and compression, an error bar where there is one; points of load are left to the table."""
    (tmp_path / STRENGTH).write_text(ROWS, encoding="utf-8")
    assert list(summary_lines(tmp_path)) == [
        "pinion: ISO 6336-3:2019 560 MPa; finite elements, tension 459 ± 6 MPa (μ = 0.05); finite elements, "
        "compression -480 MPa (μ = 0.05)",
        "wheel: ISO 6336-3:2019 571 MPa",
    ]
