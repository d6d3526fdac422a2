"""Tables of `evolvent transient` that no motion has made."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any

from evolvent.dynamics.results.transient.facts import TransientFacts
from evolvent.dynamics.results.transient.kept_tables import KeptTables
from evolvent.dynamics.results.transient.rows import TransientRow, TransientToothRow

COUNT, PITCH, LOAD = 8, 8.0, 1000.0
"""Positions of a mesh period; its rotation [°]; load along the line of action [N]."""


def transient_tables(speeds: tuple[float, ...] = (1500.0,), frictions: tuple[float, ...] = (0.1,)) -> KeptTables:
    """Mesh force 1000 (1 + 0.5 sin) N ± 800 N and pressures a tenth of it in MPa, over a mesh period of 8 positions and
    the engagement of a tooth over two."""
    unknown: Any = math.nan
    nothing = TransientFacts(**dict.fromkeys((each.name for each in fields(TransientFacts)), unknown))
    rows, teeth, facts = [], [], []
    for speed in speeds:
        for friction in frictions:
            facts.append(replace(nothing, speed_rpm=speed, friction=friction, load_N=LOAD, steady=True, modes=2))
            for k in range(2 * COUNT):
                angle = k * PITCH / COUNT
                force = LOAD * (1.0 + 0.5 * math.sin(2.0 * math.pi * angle / PITCH))
                teeth.append(TransientToothRow(
                    speed, friction, angle - PITCH, 0.5 * force, 90.0, 500.0, 0.1 * force, 80.0, 100.0))
                if k < COUNT:
                    rows.append(TransientRow(
                        speed, friction, angle, 1e-5 * k, 0.01 * force, 1.0, 10.0, 0.0, force, 800.0, 100.0, 100.0,
                        0.1 * force, 80.0, 100.0))
    return KeptTables("a pair", rows, teeth, facts)
