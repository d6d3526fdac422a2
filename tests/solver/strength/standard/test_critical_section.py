"""The standard's critical section against the fillet itself, as the sector's profile generates it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from evolvent.strength.standard.critical_section import Rack, critical_section, rack_of, root_section
from evolvent.strength.standard.virtual_gear import VirtualGear, virtual_gear
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.gear import GearParameters


def spur(z: int, x: float, radius: float | None, angle: float = 20.0, allowance: float = 0.0) -> GearParameters:
    return GearParameters.from_rack(
        z=z, normal_module=2.5, normal_pressure_angle_deg=angle, profile_shift=x, rack_tip_radius_coefficient=radius,
        face_width=10.0, bore_diameter=15.0, tooth_thickness_allowance_um=allowance,
    )


def touched(gear: GearParameters) -> tuple[Floats, float]:
    """Point (2,) [mm] of the generated fillet whose tangent is at 30° to the tooth's axis, which is the x axis, and the
    radius of curvature there [mm]."""
    h = 1e-3

    def at(direction: float) -> Floats:
        radius, angle = gear.rack_tip.generated(direction)
        return np.array([radius * np.cos(angle), radius * np.sin(angle)])

    def slope(direction: float) -> Floats:
        return (at(direction + h) - at(direction - h)) / (2.0 * h)

    def rest(direction: float) -> float:
        tangent = slope(direction)
        return float(np.arctan2(abs(tangent[1]), abs(tangent[0])) - np.pi / 6.0)

    direction = brentq(rest, gear.normal_pressure_angle + 2.0 * h, np.pi / 2.0 - 2.0 * h, xtol=1e-13)
    first, second = slope(direction), (at(direction + h) - 2.0 * at(direction) + at(direction - h)) / h**2
    curvature = abs(first[0] * second[1] - first[1] * second[0]) / np.hypot(*first) ** 3
    return at(direction), 1.0 / curvature


@pytest.mark.parametrize(
    "gear",
    [
        spur(33, 0.3, 0.2, 18.0), spur(18, 0.0, None), spur(60, -0.3, 0.25), spur(25, 0.6, 0.2, 25.0),
        spur(40, 0.1, 0.25, 20.0, -200.0),
    ],
    ids=["Zhang", "few teeth", "negative shift", "positive shift", "thin teeth"],
)
def test_section_is_where_30_degree_tangents_touch_the_fillet(gear: GearParameters) -> None:
    """Chord, height and radius of curvature of the fillet that the rack's tip cuts, point by point: 1e-5, the error of
    the differences."""
    section, (point, radius) = root_section(gear), touched(gear)
    assert section.chord == pytest.approx(2.0 * point[1], rel=1e-5)
    assert section.height == pytest.approx(point[0], rel=1e-5)
    assert section.radius == pytest.approx(radius, rel=1e-4)


def test_protuberance_makes_the_root_thinner() -> None:
    """s_pr = 0.1 mm moves the fillet into the tooth by about that on each side: the chord loses 0.2 mm within a
    fifth."""
    gear = spur(25, 0.2, 0.3)
    plain = rack_of(gear)
    cut = critical_section(virtual_gear(gear), Rack(plain.dedendum, plain.tip_radius, 0.1))
    assert root_section(gear).chord - cut.chord == pytest.approx(0.2, rel=0.2)


def test_racks_without_a_fillet_are_refused() -> None:
    """A tip radius far larger than the rack is deep, and a rack so deep that nothing is left of the root."""
    gear = VirtualGear(20.0, 1.0, np.radians(20.0), 0.0, 22.0)
    with pytest.raises(InputError, match="correct the rack's depth"):
        critical_section(gear, Rack(9.0, 0.1))
