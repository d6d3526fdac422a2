"""Every verification demo at its small size, as a user runs it: serially and on two ranks. It checks its own bounds."""

from __future__ import annotations

import json

import pytest

DEMOS = ("two_blocks", "hertz_cylinder", "hertz_sphere", "transmission_error")


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("demo", DEMOS)
def test_demo(run_script, tmp_path, demo, ranks):
    """Status 0, a table and a picture; the table is printed once, whatever the number of ranks."""
    done = run_script(f"demos/{demo}.py", "--quick", "--out", str(tmp_path), ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    assert (tmp_path / f"{demo}.png").stat().st_size > 20_000
    table = (tmp_path / "table.csv").read_text().splitlines()
    head = table[0].split(",")[0].strip('"')
    assert len(table) > 3
    assert sum(line.startswith(head) for line in done.stdout.splitlines()) == 1


@pytest.mark.parametrize("ranks", [1, 2])
def test_gear_demo(run_script, tmp_path, ranks):
    """The paper's pair on a coarse mesh: status 0, tables, fields, pictures; the demo itself asserts the trend."""
    done = run_script("demos/yang2022.py", "--quick", "--out", str(tmp_path), ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["ranks"] == ranks
    assert len(summary["positions"]) == 4 * 2
    assert max(row["balance_error"] for row in summary["positions"]) < 1e-2
    assert (tmp_path / "fields" / "contact.pvd").exists()
    assert len(list((tmp_path / "pictures").glob("*.png"))) >= 10


def test_wear_demo(run_script, tmp_path):
    """Status 0, a table of at least ten rows and a picture; the demo itself asserts what Archard's law asks for."""
    done = run_script("demos/pin_on_disc.py", "--quick", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr[-3000:]
    assert (tmp_path / "pin_on_disc.png").stat().st_size > 20_000
    assert len((tmp_path / "table.csv").read_text().splitlines()) > 10


def test_gear_wear_demo(run_script, tmp_path):
    """He's pair on a coarse mesh: status 0, the run's pictures and the paper's, a table over the profile, a line a
    figure; the demo itself asserts its bounds."""
    done = run_script("demos/he2022_wear.py", "--quick", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr[-3000:]
    pictures = sorted(path.name[:2] for path in (tmp_path / "pictures").glob("2*.png"))
    assert pictures == ["20", "22", "23", "24", "25", "26", "27", "28"]
    assert min(path.stat().st_size for path in (tmp_path / "pictures").glob("2*.png")) > 20_000
    assert len((tmp_path / "table.csv").read_text().splitlines()) > 10
    assert "depth at r = 77 mm" in done.stdout and "whole engagement" in done.stdout


def test_gear_wear_demo_refuses_too_much(run_script, tmp_path):
    """A setting that wears the flank away: status 2 and what is allowed."""
    settings = ("--set", "wear.cycles=1e9", "--out", str(tmp_path))
    done = run_script("demos/he2022_wear.py", "--quick", *settings)
    assert done.returncode == 2
    assert "wear.cycles" in done.stderr
    assert not list(tmp_path.iterdir())
