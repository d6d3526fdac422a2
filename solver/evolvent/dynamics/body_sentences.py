"""Sentences on the vibration of gear bodies that the oscillator of a pair leaves out."""

from __future__ import annotations

from evolvent.dynamics.mesh_oscillator import MeshOscillator
from evolvent.dynamics.pair_model import RIGID, Drive

BODY_HARMONICS, NEAR = (1, 2, 3), (0.9, 1.2)
"""Mesh harmonics that excite enough to matter, and the parts of a speed between which they do: of He's pair the largest
force is too low by 23 % at 0.96 times the speed, by 5 % at 1.14 times it, by 1.5 % at 0.85 times it (docs/dynamics.md,
gear bodies)."""


def body_bands(first: float) -> list[tuple[int, float, float]]:
    """Mesh harmonic, and the speeds [r/min] between which it excites the bodies' own vibration, the fastest first.
    first: speed at which the first harmonic has its frequency [r/min]; infinite for rigid bodies."""
    low, high = NEAR
    return [(number, low * first / number, high * first / number) for number in BODY_HARMONICS]


def near_body_vibration(drive: MeshOscillator, speed: float) -> bool:
    """Whether a low mesh harmonic excites the bodies' own vibration at a speed of the pinion [r/min]."""
    return any(low < speed < high for _, low, high in body_bands(drive.body_speed(1)))


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
    near = [number for number, low, high in body_bands(drive.body_speed(1)) if low < fastest and slowest < high]
    if not near:
        return []
    places = ", ".join(f"{drive.body_speed(number):.0f} r/min (mesh harmonic {number})" for number in near)
    low, high = NEAR
    return [
        f"gear bodies: their own vibration of {drive.body_frequency:.0f} Hz on the mesh, with bores whose centres "
        f"cannot move, is left out. From {low:g} to {high:g} times {places} motion and forces are larger than "
        "computed, by an amount that differs from pair to pair and has no bound; evolvent transient has it, whose "
        "dynamic_factor is without the force of the damper"
    ]
