"""Progress display of a run on rank 0: its stages one after the other, each with its time.

A terminal shows bars. Where stderr is a file or a pipe, each stage prints a line when it begins and one at each tenth.
"""

from __future__ import annotations

import time
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, ProgressColumn, SpinnerColumn, Task, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bars
from rich.text import Text

MESHING, CONDENSING, POSITIONS, CYCLES = "meshing", "condensing", "positions", "cycles of wear"
ERROR_BARS, DEFORMATION, OUTPUT = "error bars", "deformation", "tables and pictures"
VIBRATION, VARIANTS = "vibration", "variants"
TENTHS = 10


class Progress:
    """The stages of a run; a new one ends the previous one. hidden: display nothing."""

    def __init__(self, hidden: bool = False, console: Console | None = None) -> None:
        console = console or Console(stderr=True)
        self._plain = None if hidden or console.is_terminal else console
        columns = (
            SpinnerColumn(finished_text="[green]✓"), TextColumn("{task.description:<19}"), BarColumn(bar_width=24),
            _Count(), TimeElapsedColumn(), _Left(),
        )
        self._bars = Bars(*columns, console=console, disable=hidden or self._plain is not None)
        self._begun = time.monotonic()

    def __enter__(self) -> Progress:
        self._bars.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self._end()
        if not self._bars.disable:  # rich before 14 would print an empty line
            self._bars.stop()

    def stage(self, what: str, total: int | None = None, done: int = 0) -> None:
        """Begins a stage, or goes on with one of the same name. total: number of its items, None where it is unknown.
        done: items that are done already."""
        task = self._task
        if task is not None and task.description == what:
            self._bars.update(task.id, total=total, completed=done)
            return
        self._end()
        self._bars.add_task(what, total=total, completed=done)
        self._say(what if total is None else f"{what}: {done} of {total}")

    def note(self, sentence: str) -> None:
        """Displays a sentence beside the stages."""
        self._say(sentence)
        if self._plain is None and not self._bars.disable:
            self._bars.console.print(Text(sentence))

    def advance(self, more: bool = False) -> None:
        """Counts an item as done. more: another one follows, even beyond `total`; the stage is then not complete."""
        task = self._task
        if task is not None:
            done = round(task.completed) + 1
            self._show(task, done, max(task.total or 0.0, done + more))

    def reach(self, done: int) -> None:
        """Sets the number of items that are done."""
        if self._task is not None:
            self._show(self._task, done, self._task.total or 0.0)

    @property
    def _task(self) -> Task | None:
        """The bar of the current stage."""
        return self._bars.tasks[-1] if self._bars.tasks else None

    def _show(self, task: Task, done: int, total: float) -> None:
        """Updates the bar, or prints a line where a tenth is passed."""
        tenths = [int(TENTHS * count / max(total, 1.0)) for count in (task.completed, done)]
        self._bars.update(task.id, completed=done, total=total)
        if tenths[1] > tenths[0]:
            self._say(f"{task.description}: {done} of {total:.0f}")

    def _end(self) -> None:
        """Shows the current stage as complete, whatever its expected number of items."""
        task = self._task
        if task is not None:
            done = max(task.completed, 1) if task.total is None else task.completed
            self._bars.update(task.id, completed=done, total=done)

    def _say(self, line: str) -> None:
        if self._plain is not None:
            self._plain.print(Text(f"{time.monotonic() - self._begun:7.1f} s  {line}"), soft_wrap=True)


class _Count(ProgressColumn):
    """Column with the number of items done and their total, where a stage counts them."""

    def render(self, task: Task) -> Text:
        total = task.total
        counts = total is not None and (total > 1 or not task.finished)
        return Text(f"{task.completed:,.0f}/{total:,.0f}" if counts and total is not None else "", style="green")


class _Left(ProgressColumn):
    """Column with the estimated remaining time."""

    def render(self, task: Task) -> Text:
        seconds = task.time_remaining
        if task.finished or not task.total or seconds is None:
            return Text("")
        minutes, rest = divmod(round(seconds), 60)
        return Text(f"{minutes // 60}:{minutes % 60:02d}:{rest:02d} left", style="cyan")
