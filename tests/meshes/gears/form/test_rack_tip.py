"""Fillets of racks with protuberance and of racks that undercut: where they meet the involute, exact nodes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.profile import Profile
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.meshes.sector_cases import nodes_of
from tests.support.paper_pairs import he_gear, yang


def undercut(z: int = 12, helix: float = 0.0) -> GearParameters:
    """A gear of few teeth without profile shift."""
    return GearParameters.from_rack(
        z=z, normal_module=2.0, normal_pressure_angle_deg=20.0, helix_angle_deg=helix, face_width=10.0,
        bore_diameter=8.0,
    )


def cut_by_motion(gear: GearParameters, angle: float) -> float:
    """Radius [mm] at which a ray at a polar angle [rad] from the axis leaves what a rack's tip circle, ellipse in the
    transverse section, has cut in rolling past: by motion alone, without the law of gearing."""
    tip, cosine = gear.rack_tip, math.cos(gear.helix_angle)
    ψ = np.linspace(-math.pi, math.pi, 4001)
    outline = np.column_stack([
        -(tip.land + tip.radius * np.cos(ψ)) / cosine, tip.height - tip.radius * np.sin(ψ) + tip.reference_radius
    ])
    least = math.inf
    for turn in np.linspace(-0.6, 0.6, 2401):
        shifted = outline + np.array([tip.reference_radius * turn, 0.0])
        θ = np.arctan2(shifted[:, 0], shifted[:, 1]) - turn + tip.sector_angle
        radius = np.hypot(*shifted.T)
        crossing = np.flatnonzero(np.diff(np.sign(θ - angle)) != 0)
        least = min([least, *(float(radius[i : i + 2].mean()) for i in crossing)])
    return least


def of_fillet(gear: GearParameters, share: float) -> tuple[float, float]:
    """Radius and polar angle of a point of the fillet, at a share of its length."""
    x, y = Profile(gear).fillet(share)
    return float(np.hypot(x, y)), float(np.arctan2(y, x))


GEARS = {
    "undercut": undercut(), "undercut helical": undercut(11, 25.0), "little undercut": undercut(17),
    "protuberance": replace(he_gear(), protuberance_um=60.0),
    "helical protuberance": replace(yang().pinion, protuberance_um=20.0),
    "undercut with protuberance": replace(undercut(14), protuberance_um=20.0),
}


@pytest.mark.parametrize("name", GEARS)
def test_fillet_ends_on_the_involute_and_stays_inside_below(name: str) -> None:
    """At d_Ff fillet and involute meet within 1e-9 mm; just below, the fillet lies within the involute, which it cuts;
    at its other end it touches the root circle."""
    gear = GEARS[name]
    profile = Profile(gear)
    end = profile.fillet(1.0)
    assert end == pytest.approx(profile.involute(gear.root_form_diameter / 2.0), abs=1e-9)
    radius, angle = of_fillet(gear, 0.9 if name != "little undercut" else 0.9999)
    if radius > gear.base_radius:
        assert angle < float(profile.angle(radius))
    assert np.hypot(*profile.fillet(0.0)) == pytest.approx(gear.root_diameter / 2.0, abs=1e-9)


@pytest.mark.parametrize("name", ["undercut", "undercut helical", "undercut with protuberance"])
def test_fillet_is_what_the_tip_cuts_in_rolling(name: str) -> None:
    """A rack's tip of 4000 points that rolls past in 2400 steps leaves the same fillet: 1e-3 mm, as far as the points
    move in a step along the flank."""
    gear = GEARS[name]
    for share in (0.1, 0.3, 0.6):
        radius, angle = of_fillet(gear, share)
        assert cut_by_motion(gear, angle) == pytest.approx(radius, abs=1e-3)


def test_protuberance_leaves_its_depth_beneath_the_flank() -> None:
    """Where the tip circle's own lowest tangent point cuts, at normal direction α_n, the fillet lies s_pr beneath the
    involute of the finished flank: exactly, as both are parallel there."""
    gear = GEARS["protuberance"]
    radius, angle = gear.rack_tip.generated(gear.normal_pressure_angle)
    point = np.array([[radius * np.cos(angle), radius * np.sin(angle), 0.0]])
    assert Flank(gear).distance(point) == pytest.approx(-0.06, abs=1e-9)


@pytest.mark.parametrize("name", GEARS)
def test_mesh_lies_on_involute_and_fillet(name: str) -> None:
    """Flank nodes are on the involute within 1e-9 mm, fillet nodes on the generated curve within 1e-6 mm, or on the
    root circle."""
    gear = GEARS[name]
    mesh = sector_mesh(gear, SectorResolution(), "quadrilateral")
    assert abs(Flank(gear).distance(nodes_of(mesh, "flank")[1:])).max() < 1e-9
    radius, angle = polar_of(nodes_of(mesh, "fillet"))
    t = np.linspace(0.0, 1.0, 200001)
    curve = polar_of(Profile(gear).fillet(t))
    above = radius > gear.root_diameter / 2.0 + 1e-9
    wanted = np.interp(radius[above], *curve)
    assert (abs(angle[above] - wanted) * radius[above]).max() < 1e-6


def polar_of(points: Floats) -> tuple[Floats, Floats]:
    """Radii and polar angles (n,) of points (n, 2 or 3)."""
    return np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
