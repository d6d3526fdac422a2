"""evolvent.run.strength.fatigue_lines."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from evolvent.results.archive.run_folder import RunFolder
from evolvent.run.strength.fatigue_lines import fatigue_lines
from evolvent.strength.results.fatigue_rows import FATIGUE, FatigueRow
from tests.support.made_rows import made

HEAD = (
    "gear,friction,criterion,place,value,unit,value_error,depth_um,at_zone_end,near_friction_reversal,at_depth_limit,"
    "point_value,point_depth_um,point_at_zone_end,point_near_friction_reversal,change_percent,change_at_points_percent\n"
)
FIRST = """pinion,0.05,contact_pressure,surface,1000,MPa,30,0,False,False,False,1000,0,False,False,0,0
pinion,0.05,maximum_shear,below,305,MPa,nan,87.8,True,False,False,305,87.8,False,False,0,0
pinion,0.05,dang_van,surface,250,MPa,nan,0,False,False,False,250,0,False,False,0,0
pinion,0.05,dang_van,0.02 half-widths,300,MPa,nan,3.456,False,False,False,300,3.456,False,False,0,0
"""
MORE = """pinion,0.1,contact_pressure,surface,1010,MPa,30,0,True,False,False,990,0,False,False,-1.0,-0.3
pinion,0.1,maximum_shear,below,310,MPa,nan,54.3,False,False,True,307,87.6,True,True,0.7,1.5
pinion,0.1,dang_van,surface,270,MPa,nan,0,True,False,False,nan,nan,False,False,nan,nan
wheel,0.05,contact_pressure,surface,900,MPa,30,0,False,False,False,900,0,False,False,0,0
"""

NONE = """pinion,0.2,contact_pressure,surface,nan,MPa,nan,nan,False,False,False,nan,nan,False,False,nan,nan
pinion,0.2,dang_van,surface,nan,MPa,nan,nan,False,False,False,nan,nan,False,False,nan,nan
"""


def write(folder: Path, text: str) -> None:
    """fatigue.csv with these lines, and nothing in its other columns."""
    rows = []
    for line in csv.DictReader(io.StringIO(HEAD + text)):
        named = {name: line[name] for name in ("gear", "criterion", "place", "unit")}
        flags = {name: line[name] == "True" for name in line if "at_zone" in name or "near_" in name or "limit" in name}
        numbers = {name: float(line[name]) for name in line if name not in {*named, *flags}}
        rows.append(made(FatigueRow, **named, **flags, **numbers))
    FATIGUE.write(RunFolder(folder), rows)


def test_nothing_evaluated_is_said(tmp_path: Path) -> None:
    """Where no slice bears load between the tip-edge zones there is a sentence, and no "nan"; where that is so at the
    first coefficient alone, the others have no change."""
    write(tmp_path, FIRST + NONE)
    _, line = fatigue_lines(tmp_path)
    write(tmp_path, NONE + "pinion,0.3,dang_van,surface,90,MPa,nan,0,False,False,False,nan,nan,False,False,nan,nan\n")
    assert list(fatigue_lines(tmp_path))[1] == "μ = 0.3: Dang Van at the surface 90 MPa"
    assert "nothing evaluated: wanted contact between the tip-edge zones" in line and "nan" not in line


def test_a_line_a_friction_coefficient(tmp_path: Path) -> None:
    """Of the pinion; an error that is not known is left out, and the change of the first coefficient, which is none.
    The second one's largest shear lies 54.3 µm below another point than the first one's, 87.8 µm deep: both are printed
    at the first one's point, with the flags of that point. A change that is not known is left out, and the largest
    value stands. What does not hold is said, by name where it is not all."""
    write(tmp_path, FIRST + MORE)
    assert list(fatigue_lines(tmp_path)) == [
        "μ = 0.05: contact pressure 1000 ± 30 MPa, maximum shear stress 87.8 µm deep 305 MPa, Dang Van at the surface "
        "250 MPa, Dang Van 3.46 µm deep 300 MPa; beside the zone of a tip edge: maximum shear stress 87.8 µm deep",
        "μ = 0.1: contact pressure 990 ± 30 MPa (-1.0 % at this point, -0.3 % in the median), maximum shear stress "
        "87.6 µm deep 307 MPa (+0.7 % at this point, +1.5 % in the median), Dang Van at the surface 270 MPa; beside "
        "the zone of a tip edge: maximum shear stress 87.6 µm deep, Dang Van at the surface; where friction "
        "reverses, so that the stress history does not hold: maximum shear stress 87.6 µm deep; no maximum over the "
        "depth, at the first or last one from 0.2 half-widths down: maximum shear stress 87.6 µm deep",
    ]
