"""The rungs of the ladder, from the simplest problem to the hardest."""

from __future__ import annotations

from collections.abc import Callable

from evidence.claims import Rung

RUNGS: tuple[Callable[[], Rung], ...] = ()
