"""The rungs of the ladder, from the simplest problem to the hardest."""

from __future__ import annotations

from collections.abc import Callable

from evidence.claims import Rung
from evidence.ladder import hertz_ellipse, hertz_line, hertz_point, nafems, orders, patch

RUNGS: tuple[Callable[[], Rung], ...] = (
    patch.measure,
    hertz_line.measure,
    hertz_point.measure,
    hertz_ellipse.measure,
    nafems.measure,
    orders.measure,
)
