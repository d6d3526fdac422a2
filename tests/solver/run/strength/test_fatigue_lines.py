"""evolvent.run.strength.fatigue_lines."""

from __future__ import annotations

from pathlib import Path

from evolvent.run.strength.fatigue_lines import fatigue_lines

TABLE = """gear,friction,criterion,place,value,unit,value_error,change_at_points_percent
pinion,0.05,contact_pressure,surface,1000,MPa,30,0
pinion,0.05,dang_van,near surface,300,MPa,,0
pinion,0.1,contact_pressure,surface,1010,MPa,30,-0.3
wheel,0.05,contact_pressure,surface,900,MPa,30,0
"""


def test_a_line_a_friction_coefficient(tmp_path: Path) -> None:
    """Of the pinion; an error that is not known is left out, and the change of the first coefficient, which is none."""
    (tmp_path / "fatigue.csv").write_text(TABLE)
    assert list(fatigue_lines(tmp_path)) == [
        "μ = 0.05: contact pressure 1000 ± 30 MPa, Dang Van near the surface 300 MPa",
        "μ = 0.1: contact pressure 1010 ± 30 MPa (-0.3 %)",
    ]
