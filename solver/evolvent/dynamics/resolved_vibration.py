"""Whether time steps resolve the vibration of the gears on their mesh."""

from __future__ import annotations

import math

ENOUGH_STEPS = 20.0
"""A period of the pair's own vibration: the method's period is 1.1 % too long then, with eight steps 6.4 %
(ρ_∞ = 0.8, without damping), more than a resonance is wide."""
MOST_POSITIONS = 1000
"""Of a mesh period, that a scene may have."""


def unresolved(speed: float, natural: float, steps: float, positions: int) -> str:
    """The sentence on too long time steps; empty where there are `ENOUGH_STEPS` of them.

    speed: of the pinion [r/min]. natural: frequency of the pair's own vibration [Hz]. steps: equal ones, in a period
    of it. positions: of a mesh period, each of which ends a step.
    """
    if steps >= ENOUGH_STEPS:
        return ""
    wanted = positions * ENOUGH_STEPS / steps if steps else math.inf
    if wanted > MOST_POSITIONS:
        remedy = f"no sweep.positions up to {MOST_POSITIONS} resolves it: transient.spectral_radius = 0 leaves statics"
    else:
        remedy = (
            f"sweep.positions = {math.ceil(wanted)} resolves it, transient.spectral_radius = 0 leaves statics where "
            "that is too many"
        )
    return (
        f"{speed:g} r/min: the pair's own vibration of {natural:.0f} Hz has {steps:.2g} time steps a period; wanted "
        f"{ENOUGH_STEPS:g}: what the mesh excites of it is not resolved; {remedy}"
    )
