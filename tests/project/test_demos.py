"""Every verification demo at its small size, as a user runs it: serially and on two ranks. It checks its own bounds."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from evidence.tables import read_csv
from tests.support.running.processes import Done, RunScript, on_ranks
from tests.support.running.samples import sampled

DEMOS = ("two_blocks", "transmission_error", "hertz_cylinder", "hertz_sphere")
LARGER_CELLS = {"yang2022": 'demo.SMALL += ("mesh.order=1",)'}
"""Of a demo that takes long: what makes its small size smaller, to see that it runs on two ranks too."""

Alone = Callable[[str], tuple[Done, Path]]


def started(demo: str, out: Path, ranks: int) -> tuple[str, ...]:
    """What run_script takes: a demo at its small size as a user starts it, on several ranks with larger cells."""
    if ranks == 1 or demo not in LARGER_CELLS:
        return f"demos/{demo}.py", "--quick", "--out", str(out)
    program = f"from demos import {demo} as demo; {LARGER_CELLS[demo]}; demo.main(Path(sys.argv[1]), quick=True)"
    return "-c", f"import sys; from pathlib import Path; {program}", str(out)


@pytest.fixture(scope="module")
def alone(run_script: RunScript, tmp_path_factory: pytest.TempPathFactory) -> Alone:
    """A finished verification demo on one rank, and its folder; each is computed once."""

    @cache
    def computed(demo: str) -> tuple[Done, Path]:
        out = tmp_path_factory.mktemp(demo)
        return run_script(*started(demo, out, 1)), out

    return computed


@pytest.mark.parametrize("ranks", on_ranks(1, 2))
@pytest.mark.parametrize("demo", sampled(DEMOS, every=2))
def test_demo(run_script: RunScript, alone: Alone, tmp_path: Path, demo: str, ranks: int) -> None:
    """Status 0, a table and a picture; the table is printed once, whatever the number of ranks."""
    done, out = alone(demo) if ranks == 1 else (run_script(*started(demo, tmp_path, 2), ranks=2), tmp_path)
    assert done.returncode == 0, done.stderr[-3000:]
    assert (out / f"{demo}.png").stat().st_size > 20_000
    table = (out / "table.csv").read_text().splitlines()
    head = table[0].split(",")[0].strip('"')
    assert len(table) > 3
    assert sum(line.startswith(head) for line in done.stdout.splitlines()) == 1


@pytest.mark.evidence
@pytest.mark.slow
def test_ball_profile_on_squares(alone: Alone) -> None:
    """Square cells of a/2, cut by the edge of contact at all angles: the skew method's profile with γ = 0.3 C is off by
    less than 4 %, and by less than half of what the symmetric one's is (16 %)."""
    done, out = alone("hertz_sphere")
    assert done.returncode == 0, done.stderr[-3000:]
    error = {row["mesh"]: float(row["profile error [%]"] or 0.0) for row in read_csv(out / "table.csv")}
    assert error["squares, a/2, skew"] < min(4.0, 0.5 * error["squares, a/2"])


@pytest.mark.evidence
@pytest.mark.slow
@pytest.mark.parametrize("ranks", on_ranks(1, 2))
def test_gear_demo(run_script: RunScript, tmp_path: Path, ranks: int) -> None:
    """The paper's pair on a coarse mesh: status 0, tables, fields, pictures; the demo itself asserts the trend."""
    done = run_script(*started("yang2022", tmp_path, ranks), ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["ranks"] == ranks
    assert len(summary["positions"]) == 4 * 2
    assert max(row["balance_error"] for row in summary["positions"]) < 1e-2
    assert (tmp_path / "fields" / "contact.pvd").exists()
    assert len(list((tmp_path / "pictures").glob("*.png"))) >= 10


@pytest.mark.evidence
@pytest.mark.slow
def test_wear_demo(run_script: RunScript, tmp_path: Path) -> None:
    """Status 0, a table of at least ten rows and a picture; the demo itself asserts what Archard's law asks for."""
    done = run_script("demos/pin_on_disc.py", "--quick", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr[-3000:]
    assert (tmp_path / "pin_on_disc.png").stat().st_size > 20_000
    assert len((tmp_path / "table.csv").read_text().splitlines()) > 10


@pytest.mark.evidence
@pytest.mark.slow
def test_gear_wear_demo(run_script: RunScript, tmp_path: Path) -> None:
    """He's pair on a coarse mesh: status 0, the run's pictures and the paper's, a table over the profile, a line a
    figure; the demo itself asserts its bounds."""
    done = run_script("demos/he2022_wear.py", "--quick", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr[-3000:]
    pictures = sorted(path.name[:2] for path in (tmp_path / "pictures").glob("2*.png"))
    assert pictures == ["20", "22", "23", "24", "25", "26", "27", "28"]
    assert min(path.stat().st_size for path in (tmp_path / "pictures").glob("2*.png")) > 20_000
    assert len((tmp_path / "table.csv").read_text().splitlines()) > 10
    assert "depth at r = 77 mm" in done.stdout and "whole engagement" in done.stdout


@pytest.mark.evidence
@pytest.mark.slow
def test_gear_dynamics_demo(run_script: RunScript, tmp_path: Path) -> None:
    """He's pair with fewer positions and speeds: status 0 and a picture; resonance leans to lower speeds with both
    models of the mesh, so that running down jumps below running up, and the paper's asks for 258.6 N/µm (m ω²)."""
    done = run_script("demos/he2022_dynamics.py", "--quick", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr[-3000:]
    assert (tmp_path / "he2022_dynamics.png").stat().st_size > 20_000
    rows = read_csv(tmp_path / "table.csv")
    assert len(rows) == 2
    for row in rows:
        assert float(row["jump_down_rpm"]) < float(row["jump_up_rpm"]) < float(row["natural_speed_rpm"])
        assert float(row["stiffness_at_3500_rpm"]) == pytest.approx(258.6, abs=0.05)


@pytest.mark.evidence
@pytest.mark.slow
def test_root_stress_demo(run_script: RunScript, tmp_path: Path) -> None:
    """Zhang's pair on coarse meshes under two torques: status 0, a picture; tension is proportional to the torque, 1 %,
    within 10 % of the paper's at 500 N·m, and below the formula at b."""
    done = run_script("demos/zhang2023.py", "--quick", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr[-3000:]
    assert (tmp_path / "zhang2023.png").stat().st_size > 20_000
    rows = read_csv(tmp_path / "table.csv")
    assert len(rows) == 8
    paper = {"pinion": 490.6, "wheel": 487.01}
    for less, more in zip(rows[:4], rows[4:]):
        tensions = [float(row["tension_MPa"]) for row in (less, more)]
        assert tensions[1] == pytest.approx(2.5 * tensions[0], rel=0.01)
        assert tensions[1] == pytest.approx(paper[more["gear"]], rel=0.1)
        assert tensions[1] < float(more["equal_shares_b_MPa"])


def test_gear_wear_demo_refuses_too_much(run_script: RunScript, tmp_path: Path) -> None:
    """A setting that wears the flank away: status 2 and what is allowed."""
    settings = ("--set", "wear.cycles=1e9", "--out", str(tmp_path))
    done = run_script("demos/he2022_wear.py", "--quick", *settings)
    assert done.returncode == 2
    assert "wear.cycles" in done.stderr
    assert not list(tmp_path.iterdir())
