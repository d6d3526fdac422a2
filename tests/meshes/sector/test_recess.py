"""Sectors of gears with a web: what is left out, exact faces and volume, the flank as it was, cuts that match."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent_meshes.gears.flank import Flank
from evolvent_meshes.gears.form.support import Support
from evolvent_meshes.gears.form.web import Web
from evolvent_meshes.mesh.mesh_data import MeshError
from evolvent_meshes.mesh.quality import scaled_jacobians
from evolvent_meshes.sector.recess import RECESS
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.meshes.mesh_measures import covers_boundary, measure
from tests.support.meshes.sector_cases import COARSE, ROUNDING, gear_and_start, nodes_of, turned

BODIES = {
    "hub": (Web(4.0, 6.0, 90.0, 1.0), Support()),
    "to the bore": (Web(4.0, 6.0), Support()),
    "hub held in part": (Web(6.0, 3.5, 80.0, -5.0), Support(5.0, 2.0)),
    "flush": (Web(6.0, 8.0, None, 5.45), Support()),
    "thinner than a layer": (Web(1.0, 8.0, 90.0, 1.0), Support()),
}


@pytest.mark.parametrize("name", ["yang wheel", "he"])
@pytest.mark.parametrize("shape", ["hexahedron", "tetrahedron"])
@pytest.mark.parametrize(("web", "support"), BODIES.values(), ids=list(BODIES))
def test_sector_lacks_what_is_beside_the_web(web: Web, support: Support, shape: str, name: str) -> None:
    """A helical and a spur gear, flush of the former. Exact: the volume of the full ring less the ring
    π (r_o² − r_i²)(b − b_s)/z beside the web, 1e-8, as arcs have second-order cells; free faces on the two planes and
    the two cylinders, 1e-12 mm; the nodes of the flank; cuts one pitch apart, with the same facets. Facet groups are
    the whole boundary."""
    plain_gear, start = gear_and_start(name)
    gear, resolution = replace(plain_gear, web=web, support=support), replace(
        COARSE, flank_start_diameter=start, face_elements=8
    )
    mesh, plain = sector_mesh(gear, resolution, shape), sector_mesh(plain_gear, resolution, shape)
    (outer, inner), pitch = (0.5 * d for d in gear.web_diameters), 2.0 * np.pi / gear.z
    left_out = np.pi * (outer**2 - inner**2) * (gear.face_width - web.thickness) / gear.z
    assert measure(mesh) == pytest.approx(measure(plain) - left_out, rel=1e-8)
    assert covers_boundary(mesh)
    recess = nodes_of(mesh, RECESS)
    off_planes = np.abs(recess[:, 2][:, None] - web.ends).min(axis=1)
    off_cylinders = np.abs(np.hypot(*recess[:, :2].T)[:, None] - [outer, inner]).min(axis=1)
    assert np.minimum(off_planes, off_cylinders).max() < 1e-12
    np.testing.assert_allclose(nodes_of(mesh, "flank"), nodes_of(plain, "flank"), rtol=0.0, atol=ROUNDING)
    assert abs(Flank(gear).distance(nodes_of(mesh, "flank"))).max() < 1e-9
    low, high = (np.unique(mesh.facets[group]) for group in ("cut_low", "cut_high"))
    distance = np.linalg.norm(turned(mesh.points[low], pitch)[:, None] - mesh.points[high][None], axis=2)
    assert distance.min(axis=1).max() < 1e-9
    partner = dict(zip(low.tolist(), high[distance.argmin(axis=1)].tolist(), strict=True))
    wanted = {tuple(sorted(partner[n] for n in facet)) for facet in mesh.facets["cut_low"].tolist()}
    assert wanted == {tuple(sorted(facet)) for facet in mesh.facets["cut_high"].tolist()}


@pytest.mark.parametrize("name", ["yang pinion", "yang wheel", "he", "zhang gear"])
def test_cells_of_webs_are_well_shaped(name: str) -> None:
    """Rims from 1.2 modules on, webs of a fifth of the face: scaled Jacobians of at least 0.25, or those of the full
    ring's cells."""
    plain, start = gear_and_start(name)
    resolution = replace(COARSE, flank_start_diameter=start, face_elements=8)
    lowest = min(0.25, float(scaled_jacobians(sector_mesh(plain, resolution)).min()))
    for offset in (0.0, 0.3 * plain.face_width):
        web = Web(0.2 * plain.face_width, 1.2 * plain.normal_module, offset=offset)
        assert scaled_jacobians(sector_mesh(replace(plain, web=web), resolution)).min() >= lowest


@pytest.mark.parametrize("shape", ["hexahedron", "tetrahedron"])
def test_web_as_wide_as_the_face_is_the_full_ring(shape: str) -> None:
    """A web that is as wide as the face leaves nothing out: the mesh is that of the full ring."""
    gear, start = gear_and_start("yang wheel")
    resolution = replace(COARSE, flank_start_diameter=start)
    mesh, plain = (sector_mesh(each, resolution, shape) for each in (replace(gear, web=Web(16.9, 6.0, 90.0)), gear))
    np.testing.assert_allclose(mesh.points, plain.points, rtol=0.0, atol=ROUNDING)
    np.testing.assert_array_equal(mesh.cells, plain.cells)
    assert list(mesh.facets) == list(plain.facets)


def test_layers_and_plane_sections_are_refused() -> None:
    """A web takes a part of at least three layers; in plane strain it has no meaning."""
    gear, start = gear_and_start("yang wheel")
    webbed = replace(gear, web=Web(4.0, 6.0))
    with pytest.raises(MeshError, match="at least 3 layers"):
        sector_mesh(webbed, replace(COARSE, flank_start_diameter=start, face_elements=2))
    with pytest.raises(MeshError, match="mesh it in space"):
        sector_mesh(webbed, COARSE, "quadrilateral")
