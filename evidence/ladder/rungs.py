"""The rungs of the ladder, from the simplest problem to the hardest."""

from __future__ import annotations

from collections.abc import Callable

from evidence.claims import Rung
from evidence.ladder import (
    half_spheres,
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
    rounded_punch,
    sharing,
    sliding,
    stiff_punch,
    torque,
)

RUNGS: tuple[Callable[[], Rung], ...] = (
    patch.measure,
    hertz_line.measure,
    hertz_point.measure,
    hertz_ellipse.measure,
    half_spheres.measure,
    nafems.measure,
    rounded_punch.measure,
    stiff_punch.measure,
    orders.measure,
    partial_slip.measure,
    mindlin.measure,
    rolling.measure,
    sliding.measure,
    ironing.measure,
    torque.measure,
    sharing.measure,
)
