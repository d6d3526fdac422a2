"""The verification problems, from the simplest to the hardest."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from evidence.claims import Verification
from evidence.verification.contact import (
    half_spheres,
    hertz_ellipse,
    hertz_line,
    hertz_point,
    nafems,
    orders,
    patch,
    rounded_punch,
    stiff_punch,
)
from evidence.verification.friction import ironing, mindlin, partial_slip, rolling, sliding, sliding_ball
from evidence.verification.gears import sharing, torque
from evidence.verification.transient import bar_on_wall, dropped_ball, pressed_block, thousand_impacts

PROBLEMS: Mapping[str, Callable[[], Verification]] = {
    module.__name__.rpartition(".")[2]: module.verify
    for module in (
        patch, hertz_line, hertz_point, hertz_ellipse, half_spheres, nafems, rounded_punch, stiff_punch, orders,
        partial_slip, mindlin, rolling, sliding, sliding_ball, ironing, torque, sharing,
        bar_on_wall, dropped_ball, pressed_block, thousand_impacts,
    )
}
"""Name -> what solves it."""
