"""Moments of inertia against the outline as a polygon, and a disc."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from evolvent.gears.problem.gear_inertia import equivalent_mass, polar_moment
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.gears.profile import Profile, mirror, polar

STANDARD: dict[str, Any] = {"normal_module": 3.0, "normal_pressure_angle_deg": 20.0, "face_width": 20.0}


def outline(gear: GearParameters) -> Floats:
    """Points (n, 2) around the gear, root arcs and tips as arcs."""
    profile, t = Profile(gear), np.linspace(0.0, 1.0, 400)
    root, _, tip = profile.radii
    half = np.concatenate([
        polar(np.full(400, root), np.linspace(profile.sector_angle, profile.root_angle, 400)), profile.fillet(t),
        profile.involute_at_roll(np.linspace(*profile.roll_lengths, 400)),
        profile.edge_line(t), polar(np.full(400, tip), np.linspace(profile.tip_angle, 0.0, 400)),
    ])
    tooth = np.concatenate([mirror(half), half[::-1]])
    turns = 2.0 * np.pi * np.arange(gear.z) / gear.z
    return np.concatenate([tooth @ np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]]) for a in turns])


@pytest.mark.parametrize("helix", [0.0, 25.0])
@pytest.mark.parametrize("teeth", [24, 50])
@pytest.mark.parametrize("tip", [{}, {"tip_rounding_um": 600.0}, {"tip_chamfer_um": 600.0}], ids=str)
def test_polar_moment_is_that_of_the_outline(teeth: int, helix: float, tip: dict[str, Any]) -> None:
    """ρb Σ(x_i y_j − x_j y_i)(x_i² + x_i x_j + x_j² + y_i² + y_i y_j + y_j²)/12 of a polygon of 1600 points a tooth,
    less the bore: 1e-6."""
    gear = GearParameters.from_rack(z=teeth, helix_angle_deg=helix, bore_diameter=30.0, **STANDARD, **tip)
    x, y = outline(gear).T
    X, Y = np.roll(x, -1), np.roll(y, -1)
    whole = float(np.sum((x * Y - X * y) * (x * x + x * X + X * X + y * y + y * Y + Y * Y))) / 12.0
    exact = 7850e-12 * 20.0 * (abs(whole) - np.pi * 15.0**4 / 2.0)
    assert polar_moment(gear, 7.85e-9) == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize(("hub", "inner"), [(50.0, 50.0), (None, 30.0)])
def test_inertia_beside_a_web_is_left_out(hub: float | None, inner: float) -> None:
    """Exact: less than the full ring by a ring of π ρ (b − b_s)(r_o⁴ − r_i⁴)/2, from the hub or the bore to 8 mm below
    the root circle, 1e-12."""
    full, webbed = (
        GearParameters.from_rack(z=50, bore_diameter=30.0, web=web, **STANDARD) for web in (None, Web(5.0, 8.0, hub))
    )
    outer = 0.5 * full.root_diameter - 8.0
    ring = 7850e-12 * 15.0 * np.pi * (outer**4 - (0.5 * inner) ** 4) / 2.0
    assert polar_moment(full, 7.85e-9) - polar_moment(webbed, 7.85e-9) == pytest.approx(ring, rel=1e-12)


def test_inertia_of_the_paper_is_in_tonnes() -> None:
    """He's gear without a bore, 156 mm across its tips, weighs in with 7.65 t·mm² to 4 %, not kg·mm²; the mass that
    both move is I/(2 r_b²) = 0.7701 kg."""
    gear = GearParameters.from_rack(z=50, bore_diameter=70.0, **STANDARD)
    bore = 7850e-12 * 20.0 * np.pi * 35.0**4 / 2.0
    assert polar_moment(gear, 7.85e-9) + bore == pytest.approx(7.65, rel=0.04)
    assert equivalent_mass(GearPair(gear, gear, 150.0), (7.65, 7.65)) == pytest.approx(0.7701e-3, rel=1e-4)
