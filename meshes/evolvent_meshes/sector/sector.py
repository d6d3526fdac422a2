"""Mesh of one tooth sector: the section swept along the helix into 27-node hexahedra with exact nodes.

The section at height z is the mid-face section turned by twist·z, also at middle nodes: all nodes of the loaded flank
lie on the involute helicoid, with modifications on the modified flank, and the two cuts are the same surface one pitch
apart.
"""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.profile import polar
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.quality import check_quality
from evolvent_meshes.mesh.reference_cells import node_positions
from evolvent_meshes.mesh.structured_grid import split_to_simplices
from evolvent_meshes.sector.axial_layers import node_heights
from evolvent_meshes.sector.flank_points import modification_angle
from evolvent_meshes.sector.held_bore import with_held_bore
from evolvent_meshes.sector.recess import without_recess
from evolvent_meshes.sector.section import Section, SectorResolution, section_mesh

MINIMUM_QUALITY = {"quadrilateral": 0.1, "hexahedron": 0.1, "triangle": 1e-6, "tetrahedron": 1e-6}
"""Cell shape -> smallest scaled Jacobian allowed; long thin layers make long thin simplices, not inverted ones."""
PLANE = "quadrilateral", "triangle"
"""Cell shapes of the mid-face section."""


def sector_mesh(gear: GearParameters, resolution: SectorResolution, shape: str = "hexahedron") -> MeshData:
    """Second-order mesh of tooth 0's sector, θ ∈ [−π/z, π/z] about its centre line, in the gear's frame [mm].

    shape: "hexahedron" or "tetrahedron" (six a hexahedron, on the same nodes) for the whole face width, "quadrilateral"
        or "triangle" for the mid-face section in plane strain.

    Volume group: tooth. Facet groups: flank (loaded, θ > 0, above the flank start), fillet (from there to the cut),
    back (all of θ < 0), tip, bore, cut_low (θ = −π/z), cut_high (θ = π/z), in 3D face_low and face_high (ends of z),
    and bore_free where the gear is held on a part of its bore, which is then the group bore, and recess where it has a
    web: free faces of the web, inside the rim and outside the hub.
    The nodes of cut_high are those of cut_low turned by 2π/z.

    Raises MeshError for an unknown shape, a flank start off the involute, cells of bad quality, or a plane section of a
    gear with a web.

    >>> gear = GearParameters.from_rack(
    ...     z=50, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=60.0
    ... )
    >>> mesh = sector_mesh(gear, SectorResolution(profile_elements=12, face_elements=4))
    >>> mesh.shape, len(mesh.facets["flank"])
    ('hexahedron', 48)
    """
    if shape not in MINIMUM_QUALITY:
        raise MeshError(f"sector: wanted one of {', '.join(MINIMUM_QUALITY)}, found shape {shape!r}")
    if gear.thin_web is not None and shape in PLANE:
        raise MeshError(
            f"sector: wanted hexahedra or tetrahedra of a gear with a web, whose sections differ along the face, found "
            f"{shape}s; mesh it in space, or leave out the web"
        )
    section = section_mesh(gear, resolution)
    if shape in PLANE:
        mesh, heights = _flat(section), np.zeros(1)
    else:
        heights = layer_heights(gear.face_width, resolution)
        mesh = _swept(section, heights)
    points = _placed(gear, section, heights)
    mesh, used = without_recess(gear, MeshData(points, mesh.shape, 2, mesh.cells, mesh.facets, mesh.volumes))
    mesh = with_held_bore(gear, mesh)
    if shape in ("triangle", "tetrahedron"):
        mesh = split_to_simplices(mesh, np.tile(_radius_rank(section), len(heights))[used])
    check_quality(mesh, MINIMUM_QUALITY[shape])
    return mesh


def layer_heights(face_width: float, resolution: SectorResolution) -> Floats:
    """Heights (2 layers + 1,) [mm] of the nodes: ends and middles of layers that become thinner towards both faces."""
    n = resolution.face_elements
    even = np.linspace(-1, 1, n + 1)
    swing = (1 - resolution.end_size_ratio) / (1 + resolution.end_size_ratio)
    ends = even + swing * np.sin(np.pi * even) / np.pi
    ends = 0.5 * (ends - ends[::-1])
    return np.insert(ends, np.arange(1, n + 1), 0.5 * (ends[1:] + ends[:-1])) * face_width / 2


def _radius_rank(section: Section) -> Ints:
    """Rank (n,) of the section's nodes by radius, so that both cuts, which have the same radii, are split alike."""
    rank = np.empty(len(section.points), dtype=np.int64)
    rank[np.argsort(np.hypot(*section.points.T))] = np.arange(len(rank))
    return rank


def _flat(section: Section) -> MeshData:
    points = np.pad(section.points, ((0, 0), (0, 1)))
    return MeshData(points, "quadrilateral", 2, section.cells, section.edges, _volumes(len(section.cells)))


def _volumes(n: int) -> dict[str, Ints]:
    return {"tooth": np.arange(n)}


def _swept(section: Section, heights: Floats) -> MeshData:
    """Cells and facets of the swept mesh, without points; node number = level · section nodes + section node."""
    n, layers = len(section.points), len(heights) // 2
    cells = _extruded(section.cells, "quadrilateral", "hexahedron", n, layers)
    facets = {name: _extruded(edge, "interval", "quadrilateral", n, layers) for name, edge in section.edges.items()}
    facets["face_low"] = section.cells
    facets["face_high"] = section.cells + 2 * layers * n
    return MeshData(np.empty((0, 3)), "hexahedron", 2, cells, facets, _volumes(len(cells)))


def _extruded(nodes: Ints, base: str, shape: str, level: int, layers: int) -> Ints:
    """Cells or edges (m, nodes) of shape `base` swept to (layers · m, nodes) of `shape`; `level` nodes a level."""
    index = {tuple(p): i for i, p in enumerate(node_positions(base, 2).tolist())}
    positions = node_positions(shape, 2).tolist()
    below = np.array([index[tuple(p[:-1])] for p in positions])
    above = np.array([p[-1] for p in positions])
    one_layer = nodes[:, below] + above * level
    return np.concatenate([one_layer + 2 * k * level for k in range(layers)])


def _placed(gear: GearParameters, section: Section, heights: Floats) -> Floats:
    """Points (levels · section nodes, 3) [mm]: the section at all heights, the flank with its modifications."""
    radius, angle = np.hypot(*section.points.T), np.arctan2(section.points[:, 1], section.points[:, 0])
    z = node_heights(gear, heights, radius)
    turned = angle + gear.twist * z
    if not gear.modifications.is_empty:
        moved = section.flank_weight > 0
        flank_radius = np.maximum(radius[moved], section.flank_start_radius)
        turned[:, moved] += section.flank_weight[moved] * modification_angle(gear, flank_radius, heights[:, None])
    points = np.empty((len(heights), len(radius), 3))
    points[..., :2] = polar(np.broadcast_to(radius, turned.shape), turned)
    points[..., 2] = z
    return points.reshape(-1, 3)
