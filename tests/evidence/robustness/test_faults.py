"""When a run is killed: what an earlier run left in the folder does not count."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from evidence.robustness.faults import await_positions


class Rewriting:
    """A run that starts anew: at its third look it removes the state of the run before, then it completes a position at
    each look."""

    def __init__(self, state: Path) -> None:
        self.state, self.looks = state, 0

    def poll(self) -> int | None:
        """Still running, for twenty looks."""
        self.looks += 1
        if self.looks == 3:
            self.state.unlink()
        if self.looks > 3:
            np.savez(self.state, complete=self.looks - 3)
        return 0 if self.looks == 20 else None


def test_positions_of_an_earlier_run_do_not_count(tmp_path: Path) -> None:
    """A folder with 8 complete positions, in which a run starts anew, that is to be killed after 5: it is awaited until
    5 of its own are complete, which is at its eighth look."""
    state = tmp_path / "results" / "state.npz"
    state.parent.mkdir()
    np.savez(state, complete=8)
    run = Rewriting(state)
    await_positions(run, tmp_path, 5, earlier=state.stat().st_mtime_ns)
    assert run.looks == 8
