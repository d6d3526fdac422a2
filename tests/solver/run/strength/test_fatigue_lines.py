"""evolvent.run.strength.fatigue_lines."""

from __future__ import annotations

from pathlib import Path

from evolvent.run.strength.fatigue_lines import fatigue_lines

HEAD = (
    "gear,friction,criterion,place,value,unit,value_error,depth_um,at_zone_end,near_friction_reversal,at_depth_limit,"
    "change_at_points_percent\n"
)
FIRST = """pinion,0.05,contact_pressure,surface,1000,MPa,30,0,False,False,False,0
pinion,0.05,dang_van,surface,250,MPa,,0,False,False,False,0
pinion,0.05,dang_van,0.02 half-widths,300,MPa,,3.456,False,False,False,0
"""
MORE = """pinion,0.1,contact_pressure,surface,1010,MPa,30,0,True,False,False,-0.3
pinion,0.1,maximum_shear,below,310,MPa,,54.3,True,True,True,1.5
wheel,0.05,contact_pressure,surface,900,MPa,30,0,False,False,False,0
"""

NONE = """pinion,0.2,contact_pressure,surface,nan,MPa,nan,nan,False,False,False,nan
pinion,0.2,dang_van,surface,nan,MPa,nan,nan,False,False,False,nan
"""


def test_nothing_evaluated_is_said(tmp_path: Path) -> None:
    """Where no slice bears load between the tip-edge zones there is a sentence, and no "nan"; where that is so at the
    first coefficient alone, the others have no change."""
    (tmp_path / "fatigue.csv").write_text(HEAD + FIRST + NONE)
    _, line = fatigue_lines(tmp_path)
    (tmp_path / "fatigue.csv").write_text(HEAD + NONE + "pinion,0.3,dang_van,surface,90,MPa,,0,False,False,False,nan\n")
    assert list(fatigue_lines(tmp_path))[1] == "μ = 0.3: Dang Van at the surface 90 MPa"
    assert "nothing evaluated: wanted contact between the tip-edge zones" in line and "nan" not in line


def test_a_line_a_friction_coefficient(tmp_path: Path) -> None:
    """Of the pinion; an error that is not known is left out, and the change of the first coefficient, which is none.
    What does not hold is said, by name where it is not all."""
    (tmp_path / "fatigue.csv").write_text(HEAD + FIRST + MORE)
    assert list(fatigue_lines(tmp_path)) == [
        "μ = 0.05: contact pressure 1000 ± 30 MPa, Dang Van at the surface 250 MPa, Dang Van 3.46 µm deep 300 MPa",
        "μ = 0.1: contact pressure 1010 ± 30 MPa (-0.3 %), maximum shear stress 54.3 µm deep 310 MPa (+1.5 %); beside "
        "the zone of a tip edge: all of these; where friction reverses, so that the stress history does not hold: "
        "maximum shear stress 54.3 µm deep; no maximum over the depth, at the first or last one from 0.2 half-widths "
        "down: maximum shear stress 54.3 µm deep",
    ]
