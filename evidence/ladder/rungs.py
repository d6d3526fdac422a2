"""The rungs of the ladder, from the simplest problem to the hardest."""

from __future__ import annotations

from collections.abc import Callable

from evidence.claims import Rung
from evidence.ladder import hertz_line

RUNGS: tuple[Callable[[], Rung], ...] = (hertz_line.measure,)
