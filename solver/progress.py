"""A progress bar with the time left, on rank 0 only; a hook on the sweep, never inside the solve."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar


class Progress:
    """`total` positions, or what `what` names, of which `done` need not be computed any more."""

    def __init__(self, total: int, done: int = 0, what: str = "positions", hidden: bool = False) -> None:
        columns = (
            TextColumn(what), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("left"),
            TimeRemainingColumn(),
        )  # fmt: skip
        self._bar = Bar(*columns, console=Console(stderr=True), disable=hidden)
        self._task = self._bar.add_task(what, total=total, completed=done)

    def __enter__(self) -> Progress:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def advance(self) -> None:
        """One more position is done, be it one more than was thought."""
        self._bar.advance(self._task)
        task = self._bar.tasks[self._task]
        self._bar.update(self._task, total=max(task.total or 0.0, task.completed))

    def reach(self, done: int) -> None:
        """So many are done."""
        self._bar.update(self._task, completed=done)
