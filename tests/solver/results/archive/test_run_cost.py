"""What a run has cost: kept with its positions, and added up over the parts of a resumed one.

Problem: He's spur pair in 2D, two positions, and the same worn a little. Exact: who resumes a finished run solves
nothing, so the times of meshing, condensing and positions stay what they were, and memory does not shrink.
"""

from __future__ import annotations

import json
from dataclasses import astuple
from pathlib import Path
from typing import Any

import pytest

from evolvent.commands.app import Exit, main
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.run_cost import FILE, Cost, Timings, read_cost, write_cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.store import ArchiveError
from tests.support.checkout import ROOT

SHORT = ("sweep.positions=2", "output.animation=false", "output.pictures=false", "output.fields=false")
HE = (str(ROOT / "demos/he2022.toml"), "--quiet", "--level", "quick", *(w for key in SHORT for w in ("--set", key)))
WEARS = ("--set", "wear.cycles=1e4", "--set", "wear.pinion_mm2_per_N=1e-10")
COMPUTED = ("mesh", "assemble", "factor", "positions", "error_bars")


def summary(out: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    return found


def test_cost_of_two_parts_adds_times_and_takes_the_larger_memory() -> None:
    """Times add up, memory is that of the larger part."""
    one = Cost(Timings(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 21.0), 100.0)
    other = Cost(Timings(positions=1.0, output=2.0, total=3.5), 70.0)
    assert one + other == Cost(Timings(1.0, 2.0, 3.0, 5.0, 5.0, 8.0, 24.5), 100.0) == other + one


def test_cost_is_read_as_written(tmp_path: Path) -> None:
    """Nothing kept is nothing spent; what was kept comes back; what cannot be read is said, not counted as nothing."""
    folder, cost = RunFolder(tmp_path), Cost(Timings(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 21.0), 100.0)
    assert read_cost(folder) == Cost()
    write_cost(folder, cost)
    assert read_cost(folder) == cost
    for text in ("", "[]", '{"timings": {}, "memory_MB": 1.0}', '{"timings": null}'):
        (tmp_path / FILE).write_text(text, encoding="utf-8")
        with pytest.raises(ArchiveError, match=r"cost\.json: wanted what the run has cost so far, found .*; remove"):
            read_cost(folder)


@pytest.mark.parametrize("more", [(), WEARS], ids=["sweep", "wear"])
def test_resumed_finished_run_keeps_its_cost(more: tuple[str, ...], tmp_path: Path) -> None:
    """A finished run and a finished study keep what they measured; only output was made again."""
    command = ["run", *HE, *more, "--out", str(tmp_path)]
    assert main(command) == Exit.DONE
    before = summary(tmp_path)
    assert main([*command, "--resume"]) == Exit.DONE
    after = summary(tmp_path)
    assert all(before["timings_s"][part] > 0.0 for part in COMPUTED)
    assert {part: after["timings_s"][part] for part in COMPUTED} == {
        part: before["timings_s"][part] for part in COMPUTED
    }
    assert after["timings_s"]["output"] > before["timings_s"]["output"]
    assert after["timings_s"]["total"] > before["timings_s"]["total"]
    assert after["peak_memory_MB"] >= before["peak_memory_MB"]


def test_resumed_stopped_run_adds_its_cost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stopped before its second position: what it has spent by then is there. Set to 1000 s of each part and 1 TB, it
    is in what the resumed run says."""
    write = Archive.write_position

    def stopped(self: Archive, index: int, position: Any) -> None:
        if index == 1:
            raise KeyboardInterrupt
        write(self, index, position)

    command = ["run", *HE, "--set", "output.error_bars=false", "--out", str(tmp_path)]
    with monkeypatch.context() as patch:
        patch.setattr(Archive, "write_position", stopped)
        assert main(command) == Exit.FAILED
    spent = read_cost(RunFolder(tmp_path)).timings
    assert min(spent.mesh, spent.assemble, spent.factor, spent.positions) > 0.0
    assert spent.total >= sum(astuple(spent)[:-1])
    write_cost(RunFolder(tmp_path), Cost(Timings(*[1e3] * len(astuple(spent))), 1e6))
    assert main([*command, "--resume"]) == Exit.DONE
    found = summary(tmp_path)
    for part in ("mesh", "assemble", "factor", "positions", "total"):
        assert found["timings_s"][part] > 1e3, part  # gears were condensed a second time
    assert found["peak_memory_MB"] == 1e6


def test_cost_of_the_companion_is_kept_with_the_error_bars(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stopped once the bars are kept, before any table: the companion, which is not solved again, is counted, and part
    of the total."""
    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    command = ["run", *HE, "--out", str(tmp_path)]
    with monkeypatch.context() as patch:
        patch.setattr("evolvent.run.kinds.run.write_tables", stopped)
        assert main(command) == Exit.FAILED
    spent = read_cost(RunFolder(tmp_path)).timings
    assert spent.error_bars > 0.0
    assert main([*command, "--resume"]) == Exit.DONE
    found = summary(tmp_path)["timings_s"]
    assert found["error_bars"] == spent.error_bars
    assert found["total"] > spent.total >= sum(astuple(spent)[:-1])


def test_overwriting_run_starts_with_no_cost(tmp_path: Path) -> None:
    """What a run has cost that is replaced does not count."""
    command = ["run", *HE, "--set", "output.error_bars=false", "--out", str(tmp_path)]
    assert main(command) == Exit.DONE
    write_cost(RunFolder(tmp_path), Cost(Timings(mesh=1e6, total=1e6), 1e9))
    assert main([*command, "--overwrite"]) == Exit.DONE
    assert summary(tmp_path)["timings_s"]["total"] < 1e6
    assert summary(tmp_path)["peak_memory_MB"] < 1e9
