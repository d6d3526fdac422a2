"""Number of natural modes of a gear up to a frequency, from its size alone: Weyl's law with its term of the boundary.

A body has about as many waves of each kind, of shear and of pressure with the wave number k = 2πf/c, as have room in
it: A k²/4π + L k/4π in a section of the area A and the free rim L in plane strain, V k³/6π² + S k²/16π in space.
"""

from __future__ import annotations

import math

from evolvent_meshes.gears.gear import GearParameters


def expected_modes(
    gear: GearParameters, elastic: tuple[float, float], density: float, highest: float, plane: bool
) -> float:
    """Number of modes up to a frequency [Hz] of a gear in plane strain or in space; each of a pair counts.

    elastic: Young's modulus [MPa] and Poisson's ratio. density: [t/mm³].
    """
    shear, pressure = (2.0 * math.pi * highest / c for c in _wave_speeds(*elastic, density))
    middle, depth = 0.5 * (gear.tip_diameter + gear.root_diameter), 0.5 * (gear.tip_diameter - gear.root_diameter)
    area, rim = 0.25 * math.pi * (middle**2 - gear.bore_diameter**2), math.pi * middle + 2.0 * gear.z * depth
    if plane:
        return sum(area * k**2 + rim * k for k in (shear, pressure)) / (4.0 * math.pi)
    volume, surface = area * gear.face_width, rim * gear.face_width + 2.0 * area
    waves = (shear, shear, pressure)
    return sum(volume * k**3 / (6.0 * math.pi**2) + surface * k**2 / (16.0 * math.pi) for k in waves)


def _wave_speeds(modulus: float, nu: float, density: float) -> tuple[float, float]:
    """Speeds of shear and pressure waves [mm/s]. density: [t/mm³]."""
    shear = 0.5 * modulus / (1.0 + nu)
    return math.sqrt(shear / density), math.sqrt(2.0 * shear * (1.0 - nu) / (1.0 - 2.0 * nu) / density)
