"""Whether time steps resolve the vibration of the gears on their mesh."""

from __future__ import annotations

import math

ENOUGH_STEPS = 20.0
"""Time steps a period of the pair's own vibration that resolve it: the method's period is 1.1 % too long then, with
eight steps 6.4 % (ρ_∞ = 0.8, without damping), more than a resonance is wide."""
SEEN_STEPS = 8.0
"""Points a period that show a vibration: they miss its peak by up to 8 % of its amplitude."""
MOST_POSITIONS = 1000
"""Largest number of positions of a mesh period in a scene."""


def unresolved(speed: float, natural: float, steps: float, positions: int, radius: float) -> str:
    """Sentence on too long time steps; empty where there are `ENOUGH_STEPS` of them.

    speed: of the pinion [r/min]. natural: frequency of the pair's own vibration [Hz]. steps: equal ones, in a period
    of it. positions: of a mesh period, each of which ends a step. radius: transient.spectral_radius.
    """
    if steps >= ENOUGH_STEPS:
        return ""
    if radius == 0.0:
        return (
            f"{_few(speed, natural, steps, 'time steps')}: what the mesh excites of it is not resolved, and with "
            "transient.spectral_radius = 0 statics are what is left"
        )
    wanted = positions * ENOUGH_STEPS / steps if steps else math.inf
    if wanted > MOST_POSITIONS:
        remedy = f"no sweep.positions up to {MOST_POSITIONS} resolves it: transient.spectral_radius = 0 leaves statics"
    else:
        remedy = (
            f"sweep.positions = {math.ceil(wanted)} resolves it, transient.spectral_radius = 0 leaves statics where "
            "that is too many"
        )
    return f"{_few(speed, natural, steps, 'time steps')}: what the mesh excites of it is not resolved; {remedy}"


def unresolved_within(speed: float, natural: float, steps: float, tolerance: float) -> str:
    """Sentence on too long time steps that a tolerance divides; empty where there are `SEEN_STEPS` of them. Steps are
    short where it matters, and vibration below the tolerance is smeared. steps: in a period, in the mean."""
    if steps >= SEEN_STEPS:
        return ""
    return (
        f"{_few(speed, natural, steps, 'time steps', SEEN_STEPS)}: transient.tolerance = {tolerance:g} lets what "
        "the mesh excites of it be smeared; lower it, or raise sweep.positions"
    )


def unseen(speed: float, natural: float, positions: float) -> str:
    """Sentence on peaks that the tables may miss, as they have the positions alone; empty where they do not. positions:
    in a period of the pair's own vibration."""
    if positions >= SEEN_STEPS:
        return ""
    return (
        f"{_few(speed, natural, positions, 'positions', SEEN_STEPS)}: the tables, and peak_to_peak_um and "
        "pressures from them, may miss peaks between positions, dynamic_factor does not; raise sweep.positions"
    )


def _few(speed: float, natural: float, count: float, what: str, wanted: float = ENOUGH_STEPS) -> str:
    return (
        f"{speed:g} r/min: the pair's own vibration of {natural:.0f} Hz has {count:.3g} {what} a period; wanted "
        f"{wanted:g}"
    )
