"""Sentences on the vibration of gear bodies that the oscillator of a pair leaves out."""

from __future__ import annotations

from evolvent.dynamics.pair_model import RIGID, Drive

BODY_HARMONICS, NEAR = (1, 2, 3), 0.1
"""Mesh harmonics that excite enough to matter, and the part of a speed within which they do (docs/dynamics.md, gear
bodies)."""


def bodies_said(drive: Drive, slowest: float, fastest: float) -> list[str]:
    """Sentences on what the model of the gear bodies leaves out, at pinion speeds between two [r/min]."""
    if drive.settings.bodies is not None:
        return body_resonances(drive, slowest, fastest)
    return [
        f"{RIGID}: all inertia is at the bores, behind what gives way between bore and mesh, so that natural speed, "
        "resonances and jumps lie too low, the more the smaller the bores (docs/dynamics.md, gear bodies); "
        '"elastic", the default, has the inertia where it is'
    ]


def body_resonances(drive: Drive, slowest: float, fastest: float) -> list[str]:
    """A sentence where low mesh harmonics excite the bodies' own vibration, which is left out, at speeds between two
    [r/min]; none where none does."""
    near = [
        (number, speed) for number in BODY_HARMONICS
        if (1.0 - NEAR) * (speed := drive.body_speed(number)) < fastest and slowest < (1.0 + NEAR) * speed
    ]
    if not near:
        return []
    places = ", ".join(f"{speed:.0f} r/min (mesh harmonic {number})" for number, speed in near)
    return [
        f"gear bodies: their own vibration of {drive.body_frequency:.0f} Hz on the mesh is left out. Within a "
        f"tenth of {places} motion and forces are larger than computed; evolvent transient has it"
    ]
