"""Chamfered and rounded tips: where the involute ends, what follows, exact nodes of the mesh."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.gears.profile import Profile, mirror
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.meshes.mesh_measures import covers_boundary, measure
from tests.support.meshes.sector_cases import GEARS, gear_and_start, nodes_of
from tests.support.paper_pairs import he, he_gear

EDGES: list[dict[str, Any]] = [
    {"tip_chamfer_um": 100.0}, {"tip_chamfer_um": 300.0}, {"tip_rounding_um": 100.0}, {"tip_rounding_um": 300.0},
]


def off_edge(gear: GearParameters, points: Floats) -> float:
    """Largest distance [mm] of points (n, 2) at θ > 0 from chamfer or arc, which are computed anew here."""
    form, tip = gear.tip_form_diameter / 2.0, gear.tip_diameter / 2.0
    start = Profile(gear).involute(form)
    θ = math.atan2(start[1], start[0])
    if gear.tip_chamfer_um:
        across = θ + math.pi / 4.0  # normal of a line at 45° to the radius
        return float(abs((points - start) @ [math.cos(across), math.sin(across)]).max())
    radius, normal = 1e-3 * gear.tip_rounding_um, Profile(gear).normal(gear.roll_length(gear.tip_form_diameter))
    centre = start - radius * normal
    assert np.hypot(*centre) + radius == pytest.approx(tip, abs=1e-9)  # touches the tip circle
    return float(abs(np.linalg.norm(points - centre, axis=1) - radius).max())


@pytest.mark.parametrize("edge", EDGES, ids=["small chamfer", "chamfer", "small rounding", "rounding"])
@pytest.mark.parametrize("name", GEARS)
def test_flank_nodes_lie_on_involute_and_edge(name: str, edge: dict[str, Any]) -> None:
    """All nodes of flank and back: on the involute within 1e-9 mm up to d_Fa, on chamfer or arc beyond, and some at
    d_Fa itself; the groups are the boundary, the cells are well shaped."""
    sharp, start = gear_and_start(name)
    gear = replace(sharp, **edge)
    mesh = sector_mesh(gear, SectorResolution(flank_start_diameter=start), "quadrilateral")
    form = gear.tip_form_diameter / 2.0
    for group, sign in (("flank", 1.0), ("back", -1.0)):
        nodes = nodes_of(mesh, group)
        plane = nodes[:, :2] if sign > 0 else mirror(nodes[:, :2])
        radius = np.hypot(*plane.T)
        on_involute = (radius <= form + 1e-9) & (radius > start / 2.0)
        lifted = np.column_stack([plane, np.zeros(len(plane))])
        assert abs(Flank(gear).distance(lifted[on_involute])).max() < 1e-9
        assert off_edge(gear, plane[radius > form + 1e-9]) < 1e-9
        assert group == "back" or abs(radius - form).min() < 1e-9
    assert covers_boundary(mesh)
    assert scaled_jacobians(mesh).min() > 0.12


@pytest.mark.parametrize("edge", EDGES[1::2], ids=["chamfer", "rounding"])
def test_area_is_that_of_the_outline(edge: dict[str, Any]) -> None:
    """The section's area is that of the exact outline: 1e-5, for the coarse back flank bends where its edge begins; the
    edges are 2e-4 of it."""
    sharp, start = gear_and_start("he")
    gear = replace(sharp, **edge)
    x, y = Profile(gear).outline(4000).T
    area = 0.5 * float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()) - math.pi / gear.z * (gear.bore_diameter / 2.0) ** 2
    mesh = sector_mesh(gear, SectorResolution(flank_start_diameter=start, profile_elements=60), "quadrilateral")
    assert measure(mesh) == pytest.approx(area, rel=1e-5)


def test_contact_ratio_ends_at_the_tip_form_circle() -> None:
    """He's gears with chamfers of 0.3 mm roll as sharp ones with d_a = 155.4 mm: 1.755 falls to the same figure."""
    chamfered = replace(he_gear(), tip_chamfer_um=300.0)
    pair = GearPair(chamfered, chamfered, 150.0)
    assert pair.transverse_contact_ratio == pytest.approx(he(155.4).transverse_contact_ratio, rel=1e-12)
    assert pair.active_start_diameters == pytest.approx(he(155.4).active_start_diameters, rel=1e-12)
    assert he().transverse_contact_ratio - pair.transverse_contact_ratio > 0.1


def test_form_diameter_of_a_rounding() -> None:
    """Between circles of involute and tip: an arc of radius R touches the tip circle and, at ρ_Fa, the involute. For a
    rack's straight flank at α the radial height is R (1 − sin α): He's 50 teeth differ from that by their curvature,
    1 %."""
    gear = replace(he_gear(), tip_rounding_um=200.0)
    height = 0.5 * (gear.tip_diameter - gear.tip_form_diameter)
    angle = math.acos(gear.base_diameter / gear.tip_form_diameter)
    assert height == pytest.approx(0.2 * (1.0 - math.sin(angle)), rel=0.01)
