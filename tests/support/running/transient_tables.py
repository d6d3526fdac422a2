"""Tables of `evolvent transient` that no motion has made."""

from __future__ import annotations

import math
from dataclasses import dataclass

from evolvent.dynamics.results.transient.facts import TransientFacts
from evolvent.dynamics.results.transient.rows import TransientRow, TransientToothRow
from tests.support.made_rows import made

COUNT, PITCH, LOAD = 8, 8.0, 1000.0
"""Positions of a mesh period; its rotation [°]; load along the line of action [N]."""


@dataclass(frozen=True)
class TransientTables:
    """Rows of all cases."""

    rows: list[TransientRow]
    """Over the mesh period."""
    teeth: list[TransientToothRow]
    """Over the engagement of a tooth."""
    facts: list[TransientFacts]
    """Of each case."""


def transient_tables(speeds: tuple[float, ...] = (1500.0,), frictions: tuple[float, ...] = (0.1,)) -> TransientTables:
    """Mesh force 1000 (1 + 0.5 sin) N ± 800 N and pressures a tenth of it in MPa, over a mesh period of 8 positions and
    the engagement of a tooth over two."""
    rows, teeth, facts = [], [], []
    for speed in speeds:
        for friction in frictions:
            case = {"speed_rpm": speed, "friction": friction}
            facts.append(made(TransientFacts, **case, load_N=LOAD, steady=True, modes=2))
            for k in range(2 * COUNT):
                angle = k * PITCH / COUNT
                force = LOAD * (1.0 + 0.5 * math.sin(2.0 * math.pi * angle / PITCH))
                pressure = {
                    "max_pressure_MPa": 0.1 * force, "max_pressure_MPa_error": 80.0, "static_max_pressure_MPa": 100.0,
                }
                teeth.append(made(
                    TransientToothRow, **case, **pressure, tooth_angle_deg=angle - PITCH, normal_force_N=0.5 * force,
                    normal_force_N_error=90.0, static_normal_force_N=500.0,
                ))
                if k < COUNT:
                    rows.append(made(
                        TransientRow, **case, **pressure, pinion_angle_deg=angle, time_s=1e-5 * k,
                        transmission_error_um=0.01 * force, transmission_error_um_error=1.0,
                        static_transmission_error_um=10.0, mesh_force_N=force, mesh_force_N_error=800.0,
                    ))
    return TransientTables(rows, teeth, facts)
