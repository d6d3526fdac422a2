"""Pressure at the edge of a tip that bears: singular where it is sharp, Hertz's where it is rounded."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.support.gear_cases import force, model_of, spur_scene, swept

RADIUS_UM = 800.0
PLANE_MODULUS = 210e3 / (1.0 - 0.3**2)


def edge_pressure(degrees: float, elements: int, radius_um: float) -> tuple[float, float]:
    """Largest pressure [MPa] and force [N/mm] of He's tooth pair 0, which leaves the mesh on the pinion's tip edge at
    this rotation [°]; both gears have these roundings, 0: none. elements: across 2b_H at the pitch point."""
    tips = [f"{gear}.tip_rounding_um={radius_um}" for gear in ("pinion", "wheel")]
    model = model_of(spur_scene(f"mesh.elements_per_contact_width={elements}", *tips))
    result = swept(model, np.array([degrees]), [0.0])[0].results[0]
    return float(result.contact.pressure[result.contact.tooth == 0].max()), force(result, 0)


@pytest.mark.slow
def test_sharp_edge_is_singular_and_rounded_edge_is_hertzian() -> None:
    """He's pair in plane strain, meshes of 6, 12 and 24 elements across the contact. Sharp: the pressure under the edge
    has no limit and grows by more than a fifth each time. Rounded with 0.8 mm: it tends to that of Hertz's contact of
    the arc with the wheel's flank, whose radius is 20 mm here, p = √(F' E*/π (1/R + 1/ρ)), and is within 5 % of it."""
    sharp = [edge_pressure(6.6, elements, 0.0)[0] for elements in (6, 12, 24)]
    assert sharp[1] > 1.2 * sharp[0]
    assert sharp[2] > 1.2 * sharp[1]
    errors = []
    for elements in (6, 12, 24):
        pressure, load = edge_pressure(5.8, elements, RADIUS_UM)
        hertz = math.sqrt(load * 0.5 * PLANE_MODULUS / math.pi * (1e3 / RADIUS_UM + 1.0 / 20.0))
        errors.append(pressure / hertz - 1.0)
    assert errors[0] > errors[1] > errors[2]
    assert abs(errors[2]) < 0.05
