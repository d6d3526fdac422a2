"""The rungs of the ladder, from the simplest problem to the hardest."""

from __future__ import annotations

from collections.abc import Callable

from evidence.claims import Rung
from evidence.ladder import (
    hertz_ellipse,
    hertz_line,
    hertz_point,
    ironing,
    mindlin,
    nafems,
    orders,
    partial_slip,
    patch,
    rolling,
    sharing,
    sliding,
    torque,
)

RUNGS: tuple[Callable[[], Rung], ...] = (
    patch.measure,
    hertz_line.measure,
    hertz_point.measure,
    hertz_ellipse.measure,
    nafems.measure,
    orders.measure,
    partial_slip.measure,
    mindlin.measure,
    rolling.measure,
    sliding.measure,
    ironing.measure,
    torque.measure,
    sharing.measure,
)
