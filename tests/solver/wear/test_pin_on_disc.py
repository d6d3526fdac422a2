"""K/H from pin-on-disc records: exact lines, scattered ones, and unusable records."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from evolvent.commands.app import Exit, main
from evolvent.wear import PinOnDisc, Record, coefficient
from evolvent_meshes.arrays import Floats
from evolvent_meshes.csv_tables import TableError

K = 1.3832e-10  # mm²/N, He 2022
HE = PinOnDisc(500.0, 6.0)


def written(path: Path, distance: Floats, depth: Floats, header: str = "sliding_distance_km,depth_um") -> Path:
    """A record."""
    path.write_text(header + "\n" + "\n".join(f"{s:.9g},{h:.9g}" for s, h in zip(distance, depth)) + "\n")
    return path


def test_coefficient_of_the_printed_wear_rate(tmp_path: Path) -> None:
    """Problem: 500 N on a pin of 6 mm, 17.684 MPa, wearing by 2.446 µm per km. Exact: K/H = 1.3832e-10 mm²/N, without
    spread."""
    s = np.linspace(0.0, 10.0, 21)
    found = coefficient([Record.read(written(tmp_path / "a.csv", s, 3.0 + 2.446 * s))], HE)
    assert HE.pressure == pytest.approx(17.684, abs=5e-4)
    assert found.value == pytest.approx(K, rel=1e-4)
    assert found.high - found.low < 1e-6 * K


def test_record_units_and_running_in(tmp_path: Path) -> None:
    """Problem: the same record in m and mm, with a steep running-in part. Exact: the same K/H without that part, more
    with it."""
    s = np.linspace(0.0, 10e3, 101)
    h = 2.446e-6 * s + 2e-3 * np.minimum(s / 500.0, 1.0)
    path = written(tmp_path / "a.csv", s, h, "sliding_distance_m, depth_mm")
    assert coefficient([Record.read(path, 0.5e6)], HE).value == pytest.approx(K, rel=1e-3)
    assert coefficient([Record.read(path)], HE).value > 1.01 * K


def test_confidence_intervals_hold_the_true_coefficient(tmp_path: Path) -> None:
    """Problem: records with normal scatter. Exact: the 95 % intervals of one record, and of the mean of four, hold the
    true value about 19 times in 20."""
    rng, s, single, mean = np.random.default_rng(3), np.linspace(0.0, 10.0, 30), 0, 0
    for _ in range(200):
        rates = 2.446 * (1.0 + 0.1 * rng.normal(size=4))
        records = [Record("r", 1e6 * s, 1e-3 * (rate * s + rng.normal(size=30))) for rate in rates]
        one, four = coefficient(records[:1], HE), coefficient(records, HE)
        single += one.low < rates[0] / 2.446 * K < one.high
        mean += four.low < K < four.high
    assert 180 <= single <= 199
    assert 180 <= mean <= 199


BAD = {
    "gap": ("sliding_distance_m,depth_um\n0,0\n1000,\n2000,2\n", r"line 3, depth_um: found ''; allowed: a number"),
    "nan": ("sliding_distance_m,depth_um\n0,0\n1000,nan\n", "line 3, depth_um: found 'nan'; allowed: a number"),
    "word": ("sliding_distance_m,depth_um\n0,0\n1000,deep\n", "found 'deep'"),
    "short line": ("sliding_distance_m,depth_um\n0,0\n1000\n", "line 3: found 1 cells; allowed: 2 cells"),
    "unsorted": ("sliding_distance_m,depth_um\n0,0\n2000,2\n1000,1\n3000,3\n4000,4\n", "rises from line to line"),
    "no unit": ("sliding_distance,depth\n0,0\n1,1\n", "one column named sliding_distance_mm or"),
    "unknown unit": ("sliding_distance_mi,depth_um\n0,0\n1,1\n", "one column named sliding_distance_mm or"),
    "twice": ("sliding_distance_m,depth_um,depth_um\n0,0,0\n1,1,1\n", "one column named depth_um or depth_mm"),
    "empty": ("", "a header and lines of numbers"),
    "too few": ("sliding_distance_m,depth_um\n0,0\n1000,1\n", "found 2; allowed: at least 5 lines from 0 m on"),
    "grows thinner": ("sliding_distance_m,depth_um\n0,5\n1000,4\n2000,3\n3000,2\n4000,1\n", "is the record's depth"),
    "metres as millimetres": (
        "sliding_distance_mm,depth_mm\n" + "".join(f"{s},{s / 4.0}\n" for s in range(6)), "are its units",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_record_is_refused(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One message with place and remedy, status 2, no traceback."""
    text, message = BAD[name]
    (tmp_path / "r.csv").write_text(text)
    with pytest.raises(TableError, match=message):
        coefficient([Record.read(tmp_path / "r.csv")], HE)
    status = main(["wear-coefficient", str(tmp_path / "r.csv"), "--force-N", "500", "--pin-diameter-mm", "6"])
    assert status == Exit.BAD_INPUT
    assert "Traceback" not in capsys.readouterr().err


def test_wear_coefficient_command_prints_the_interval(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`evolvent wear-coefficient` prints every record's value, the mean, its interval and the rate."""
    s = np.linspace(0.0, 10.0, 21)
    paths = [str(written(tmp_path / f"{i}.csv", s, (2.4 + 0.1 * i) * s)) for i in range(2)]
    assert main(["wear-coefficient", *paths, "--force-N", "500", "--pin-diameter-mm", "6"]) == Exit.DONE
    out = capsys.readouterr().out
    assert "0.csv: 21 lines, K/H = 1.3572e-10" in out
    assert "17.684 MPa 2.45 µm per km" in out


def test_record_given_twice_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The same record again, which would narrow any interval, is refused."""
    s = np.linspace(0.0, 10.0, 21)
    paths = [str(written(tmp_path / f"{i}.csv", s, 2.4 * s)) for i in range(2)]
    assert main(["wear-coefficient", *paths, "--force-N", "500", "--pin-diameter-mm", "6"]) == Exit.BAD_INPUT
    assert "1.csv: found the same lines as in 0.csv" in capsys.readouterr().err


def test_interval_below_zero_is_warned_of(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Problem: two records, one wearing four times as fast. Exact: the interval of their mean reaches below 0, with a
    warning."""
    s = np.linspace(0.0, 10.0, 21)
    paths = [str(written(tmp_path / f"{i}.csv", s, slope * s)) for i, slope in enumerate((1.0, 4.0))]
    assert main(["wear-coefficient", *paths, "--force-N", "500", "--pin-diameter-mm", "6"]) == Exit.DONE
    assert "give more records" in capsys.readouterr().err


def test_missing_record_is_named(tmp_path: Path) -> None:
    """A record that does not exist is named."""
    with pytest.raises(TableError, match=r"none\.csv: found No such file or directory; allowed: a readable CSV file"):
        Record.read(tmp_path / "none.csv")


@pytest.mark.parametrize("wrong", [(0.0, 6.0), (500.0, float("nan")), (500.0, 1e200), (float("inf"), 6.0)])
def test_force_and_diameter_out_of_range_are_refused(wrong: tuple[float, float]) -> None:
    """A force and a diameter beyond the range of any test are refused."""
    with pytest.raises(TableError, match=r"found .*; allowed: a number from 1e-06 to 1e\+09 N|from 0\.001 to 10000 mm"):
        PinOnDisc(*wrong)
