"""A gear whose flank has levels of its own, against exact condensation of the very same cells.

Yang's pinion, 2.8 mm wide with crowning and tip relief, as a full ring and with a web of 0.8 mm, whose coarse cells are
split into 2 × 2 on the flank.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.gears.condensed_gear import GearBody, condensed_gear
from evolvent.gears.meshing.flank_levels import FlankLevel, LevelledSector
from evolvent.gears.meshing.levelled_meshes import levelled_mesh
from evolvent.gears.problem.gear_problem import GearProblem, MeshSettings
from evolvent.gears.two_level.flank_refinement import coarse_body
from evolvent.gears.two_level_gear import two_level_gear
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.splitting import split
from evolvent_meshes.sector.flank_points import on_flank
from tests.support.paper_pairs import yang
from tests.support.running.samples import sampled

LEVEL = FlankLevel(2, 2, (2, 1, 1))
RELIEVED = Modifications(tip_relief_um=10.0, tip_relief_start_diameter=46.0, lead_crowning_um=5.0)
CARRIES_PRESSURE = Member.PINION
WEB = Web(0.8, 2.5)


def problem(web: Web | None = None) -> GearProblem:
    pair = yang(pinion=RELIEVED)
    pinion, wheel = (replace(gear, face_width=2.8, web=each) for gear, each in zip(pair.gears, (web, None)))
    narrow = GearPair(pinion, wheel, pair.centre_distance)
    return GearProblem(narrow, 20e3, mesh=MeshSettings("quick", two_level=True))


def few_cells(sector: LevelledSector) -> LevelledSector:
    """One level on 12 × 4 coarse cells."""
    return LevelledSector(replace(sector.coarse, profile_elements=12, face_elements=4), (LEVEL,))


def same_cells(own: GearProblem, mesh: MeshData) -> GearBody:
    """Condensed exactly, split in the whole sector."""
    gear = own.pair.pinion
    plain = replace(gear, modifications=Modifications())
    fine = split(mesh, coarse_body(plain, mesh, own.materials[0], LEVEL).counts).mesh
    points = fine.points.copy()
    flank = np.unique(fine.facets["flank"])
    points[flank] = on_flank(plain, points[flank])
    return condensed_gear(
        plain, replace(fine, points=points), own.materials[0], own.contact_teeth, CARRIES_PRESSURE, True
    )


def by_place(body: GearBody) -> Ints:
    """The flank's nodes in the order of radius and height."""
    return np.lexsort((np.round(body.z, 5), np.round(np.hypot(*body.flank.points[:, :2].T), 2)))


def ridge(body: GearBody) -> Floats:
    """Forces (n, 3) of a Hertz pressure 0.3 mm wide on a contact line across the flank [N]."""
    gear, ρ = body.gear, body.roll_length
    line = ρ.min() + 0.5 * np.ptp(ρ) + gear.hand * body.z * np.tan(gear.base_helix_angle)
    s = (ρ**2 - line**2) / (2 * gear.base_radius) / 0.15
    return np.asarray((body.flank.mass().T @ np.sqrt(np.maximum(1.0 - s**2, 0.0)))[:, None] * -body.flank.normals)


@pytest.mark.slow
@pytest.mark.parametrize("web", sampled([WEB, None]), ids=["web", "full ring"])
def test_response_to_a_ridge_is_that_of_the_same_cells(web: Web | None) -> None:
    """Displacement along the ridge's own force: its mean within 0.1 %, its shape, which decides on the pressure, within
    1 % of its own spread; and on the next tooth within 0.1 %. The flank that the gap is measured on has crowning and
    relief, 15 µm at the tip's ends."""
    own = problem(web)
    sector = levelled_mesh(own, CARRIES_PRESSURE, few_cells)
    found, exact = two_level_gear(own, CARRIES_PRESSURE, sector), same_cells(own, sector.mesh)
    here, there = by_place(found), by_place(exact)
    force, normals = ridge(exact)[there], exact.flank.normals[there]
    weight = np.linalg.norm(force, axis=1) / np.linalg.norm(force, axis=1).sum()
    u, v = (body.chain.apply(body.rows(0, at), force, body.rows(0, at)) for body, at in ((found, here), (exact, there)))
    along, wanted = (-np.einsum("na,na->n", moved, normals) for moved in (u, v))
    error, spread = along - wanted, wanted - wanted @ weight
    assert abs(error @ weight) < 1e-3 * wanted @ weight
    assert np.sqrt((error - error @ weight) ** 2 @ weight) < 0.01 * np.sqrt(spread**2 @ weight)
    u, v = (body.chain.apply(body.rows(0, at), force, body.rows(1, at)) for body, at in ((found, here), (exact, there)))
    assert np.linalg.norm(u - v) < 1e-3 * np.linalg.norm(v)
    plain, relieved = exact.flank.points[there], found.flank.points[here]
    assert relieved == pytest.approx(on_flank(own.pair.pinion, plain), abs=1e-9)
    assert np.linalg.norm(relieved - plain, axis=1).max() > 15e-3
