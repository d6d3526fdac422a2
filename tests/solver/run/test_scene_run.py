"""A whole run: the same on any number of ranks, and failing on all ranks alike."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from evolvent.gears.solution.certificates import BALANCE_LIMIT
from evolvent.results.archive.store import read_arrays
from tests.support.gear_cases import HELICAL
from tests.support.running.processes import BROKEN_RUN, RunScript, on_ranks
from tests.support.running.samples import sampled

SPUR = "demos/he2022.toml"
QUIET = (
    "--quiet", "--set", "output.pictures=false", "--set", "output.animation=false", "--set", "output.fields=false",
)
SHORT = (
    "--level", "quick", "--set", "contact.friction=[0.1, 0.2, 0.3]", "--set", "sweep.positions=4",
)


def positions(out: Path) -> list[dict[str, object]]:
    return json.loads((out / "summary.json").read_text(encoding="utf-8"))["positions"]


def assert_same(found: list[dict[str, object]], wanted: list[dict[str, object]]) -> None:
    """All numbers agree within 1e-8, but for the clock and residuals that are rounding. Those of a tooth agree within
    1e-8 times the largest force of a tooth over its own: Newton's method ends at a residual over the force in the whole
    system, which is more of a lightly loaded tooth."""
    assert len(found) == len(wanted)
    for one, other in zip(found, wanted):
        assert one.keys() == other.keys()
        for name in other.keys() - {"seconds", "newton_iterations", "balance_error", "teeth"}:
            assert one[name] == pytest.approx(other[name], rel=1e-8, abs=1e-8), name
        teeth, other_teeth = one["teeth"], other["teeth"]
        assert isinstance(teeth, list) and isinstance(other_teeth, list)
        largest = max((tooth["force_N"] for tooth in other_teeth), default=0.0)
        for one_tooth, other_tooth in zip(teeth, other_teeth, strict=True):
            within = 1e-8 * largest / max(other_tooth["force_N"], 1e-3 * largest)
            assert one_tooth == pytest.approx(other_tooth, rel=within, abs=1e-8, nan_ok=True)


@pytest.fixture(scope="module")
def on_one_rank(run_script: RunScript, tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, object]]:
    out = tmp_path_factory.mktemp("one") / "out"
    done = run_script(BROKEN_RUN, "ok", SPUR, "--out", str(out), *QUIET, *SHORT)
    assert done.returncode == 0, done.stderr
    return positions(out)


@pytest.mark.mpi
@pytest.mark.parametrize("ranks", sampled([2, 4]))
def test_results_do_not_depend_on_ranks(
    ranks: int, on_one_rank: list[dict[str, object]], run_script: RunScript, tmp_path: Path
) -> None:
    """He's pair with three friction coefficients on 1, 2 and 4 ranks: the same within 1e-8. Each gear is condensed
    once, its coarse companion too; every position of both is searched once, the odd ones of four by rank 0, the others
    by rank 1, and two more, a rank each, where the first of them closes the pitch."""
    out = tmp_path / "out"
    done = run_script(BROKEN_RUN, "count", SPUR, "--out", str(out), *QUIET, *SHORT, ranks=ranks)
    assert done.returncode == 0, done.stderr
    assert_same(positions(out), on_one_rank)
    for rank in range(ranks):
        condensed, searched = 2 * int(rank < 2), 2 * 3 * int(rank < 2)
        assert f"rank {rank}: condensed {condensed}, searched {searched}" in done.stdout
    assert json.loads((out / "summary.json").read_text(encoding="utf-8"))["ranks"] == ranks


@pytest.mark.evidence
@pytest.mark.slow
@pytest.mark.mpi
def test_helical_results_do_not_depend_on_ranks(run_script: RunScript, tmp_path: Path) -> None:
    """A coarse helical pair, one gear and, of three friction coefficients that close the pitch at different positions,
    one or two a rank: as on one rank within 1e-8. Two ranks have the last position at hand when one of two coefficients
    closes at the one before."""
    scene = tmp_path / "helical.toml"
    scene.write_text(HELICAL, encoding="utf-8")
    found = []
    for count in (1, 2):
        out = tmp_path / str(count)
        mixed = "--set", "contact.friction=[0.0, 0.5, 0.9]", "--set", "sweep.positions=10"
        where = str(scene), "--out", str(out)
        done = run_script(BROKEN_RUN, "ok", *where, *QUIET, *mixed, ranks=count)
        assert done.returncode == 0, done.stderr
        found.append(positions(out))
        solved = [int(read_arrays(path)["count"]) for path in sorted((out / "results").glob("position_*.npz"))]
        assert solved == [3] * 10 + [2, 2, 2, 1]
    assert_same(*found)


@pytest.mark.mpi
@pytest.mark.parametrize(("rank", "number", "complete"), [(0, 1, 0), (1, 3, 4)])
def test_failing_rank_ends_the_run_on_all_ranks(
    rank: int, number: int, complete: int, run_script: RunScript, tmp_path: Path
) -> None:
    """An unexpected error on one of three ranks: its message and where it was raised, status 1, no hang; the positions
    of the turns before are kept, two of each."""
    out = tmp_path / "out"
    how = f"raise-{rank}-{number}"
    done = run_script(BROKEN_RUN, how, SPUR, "--out", str(out), *QUIET, *SHORT, ranks=3, timeout=60)
    assert done.returncode == 1
    assert f"ArithmeticError: rank {rank} broke" in done.stderr
    assert f"on rank {rank} of 3" in done.stderr
    assert "broken_run.py" in done.stderr
    assert len(list((out / "results").glob("position_*.npz"))) == complete
    assert not (out / "summary.json").exists()


@pytest.mark.parametrize("ranks", on_ranks(1, 2))
def test_unbalanced_position_is_an_error(ranks: int, run_script: RunScript, tmp_path: Path) -> None:
    """A position that fails its balance certificate: status 3, the numbers, and it is not written."""
    out = tmp_path / "out"
    done = run_script(BROKEN_RUN, "unbalanced", SPUR, "--out", str(out), *QUIET, *SHORT, ranks=ranks)
    assert done.returncode == 3
    assert "wanted a balance error of at most 1e-09, found" in done.stderr
    assert not list((out / "results").glob("position_*.npz"))
    assert not (out / "summary.json").exists()
    assert "failed: pinion at" in (out / "run.log").read_text(encoding="utf-8")


@pytest.mark.parametrize("ranks", on_ranks(1, 2))
def test_unbalanced_pitch_is_an_error(ranks: int, run_script: RunScript, tmp_path: Path) -> None:
    """A pitch that fails its balance certificate: status 3, the numbers, and no result."""
    out = tmp_path / "out"
    done = run_script(BROKEN_RUN, "leaking", SPUR, "--out", str(out), *QUIET, *SHORT, ranks=ranks)
    assert done.returncode == 3
    assert "wanted an energy balance within 1e-09 of the input, found" in done.stderr
    assert "solved again, on deflected flanks" in (out / "run.log").read_text(encoding="utf-8")
    assert not (out / "summary.json").exists()


def test_positions_are_balanced(on_one_rank: list[dict[str, object]]) -> None:
    """Every position is well within the limit."""
    assert max(float(str(row["balance_error"])) for row in on_one_rank) < BALANCE_LIMIT
