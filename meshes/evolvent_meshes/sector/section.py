"""Transverse mesh of one tooth sector: second-order quadrilaterals, fine under the loaded flank only.

The tooth above the flank start lies in polar rows of constant radius: thin layers under the loaded flank, a column of
3:1 transitions, then coarse columns to the back flank. Below, a band one cell thick follows fillets and root; under it
lie the neck, the base and two root blocks down to the bore, or to the web, which goes on below them:

          ___________                B   back band: the last coarse column, then the band
         |B|  |  |T|S|               S   strip of thin layers     T   transition
         |B|  |  |T|S|
         |B|--neck--|B|              The band's inner corners left and right of "base" are
      _B_/ |        | \\_B_          the only irregular nodes (five cells).
     |root |  base  | root|
     |_____|________|_____|  bore

The mesh is built from arrays, without gmsh: it is the same with every version of gmsh, its nodes are exact, and the
cuts on both sides match by construction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.profile import Profile, polar
from evolvent_meshes.mesh.mesh_data import REVERSED_CELL, MeshError
from evolvent_meshes.mesh.structured_grid import boundary_facets, subdivided, transfinite, weld
from evolvent_meshes.sector.body_blocks import body_blocks
from evolvent_meshes.sector.root_band import RootBand
from evolvent_meshes.sector.section_blocks import (
    Piece,
    ToothRows,
    even,
    grid_piece,
    half_steps,
    line,
    mirrored_piece,
    row_radii,
    three_to_one,
    to_polar,
)

WELD = 1e-7
"""Points closer than this are one node [mm]."""


@dataclass(frozen=True)
class SectorResolution:
    """Numbers and sizes of the elements of one tooth sector.

    profile_elements: along the loaded flank from the flank start to the tip corner; a multiple of 3, as three elements
        join one coarse row.
    face_elements: layers along z.
    end_size_ratio: length of the end layers over that of the middle ones.
    layer_depths: thickness of the three thin layers below the flank, the outermost first [mm].
    tip_depth_share: largest share of the tooth's thickness that the thin layers take; near a thin tip they shrink.
    flank_start_diameter: start of the fine flank [mm], a little below the start of the active profile, so that the
        whole width of the contact lies on it; None: the root form diameter.
    size_at: relative element length along the profile at radii [mm]; None: uniform.
    graded_middles: whether the middle nodes along the profile follow `size_at` too, so that rows which are split later
        vary in size smoothly, not parent by parent; else they lie midway.
    fillet_elements: from the flank start to the sector's cut on the loaded side.
    back_elements: the same on the back side.
    neck_elements: of the two before, those above the middle of the fillet.
    band_depth: depth of the cells along fillets and root at the cut, in normal modules.
    band_below_layers: whether it is at least the depth of the thin layers.
    core_elements: coarse columns of the tooth between transitions and back band.
    rim_elements: from the root band to the bore, or to the inside of the rim that a web carries.
    web_elements: from there to the hub or the bore.
    hub_elements: from the hub's outside to the bore.
    fine_back: whether the back flank is as fine as the loaded one, to measure the effect of a coarse one.
    Raises MeshError for counts and sizes that do not make a mesh.
    """

    profile_elements: int = 27
    face_elements: int = 16
    end_size_ratio: float = 0.5
    layer_depths: tuple[float, float, float] = (0.1, 0.15, 0.22)
    tip_depth_share: float = 0.4
    flank_start_diameter: float | None = None
    size_at: Callable[[Floats], Floats] | None = None
    graded_middles: bool = False
    fillet_elements: int = 6
    back_elements: int = 5
    neck_elements: int = 3
    band_depth: float = 0.3
    band_below_layers: bool = True
    core_elements: int = 2
    rim_elements: int = 4
    web_elements: int = 4
    hub_elements: int = 2
    fine_back: bool = False

    def __post_init__(self) -> None:
        if self.profile_elements % 3 or len(self.layer_depths) != 3:
            raise MeshError(
                f"sector resolution: wanted a multiple of 3 profile elements and 3 layers (the mesh coarsens 3:1), "
                f"found {self.profile_elements} and {len(self.layer_depths)}"
            )
        counts = (
            self.profile_elements, self.face_elements, self.core_elements, self.neck_elements, *self.body_elements
        )
        if min(counts) < 1 or min(*self.layer_depths, self.end_size_ratio) <= 0:
            raise MeshError(f"sector resolution: wanted positive counts, layer depths and end ratio, found {self}")
        if min(self.fillet_elements, self.back_elements) <= self.neck_elements:
            raise MeshError(
                f"sector resolution: wanted more fillet and back elements than neck elements ({self.neck_elements}), "
                f"found {self.fillet_elements} and {self.back_elements}"
            )

    @property
    def body_elements(self) -> tuple[int, int, int]:
        """Numbers of elements of rim, web and hub."""
        return self.rim_elements, self.web_elements, self.hub_elements


@dataclass(frozen=True)
class Section:
    """Mesh of the mid-face section, in the node order of gmsh.

    points: (n, 2) [mm].
    cells: (m, 9) node indices.
    edges: name -> (k, 3) node indices of the outline's edges.
    flank_weight: (n,) share of a flank modification by which a node moves: 1 on the loaded flank, falling to 0 through
        the thin layers.
    flank_start_radius: lowest radius of the loaded flank [mm].
    """

    points: Floats
    cells: Ints
    edges: dict[str, Ints]
    flank_weight: Floats
    flank_start_radius: float


def section_mesh(gear: GearParameters, resolution: SectorResolution) -> Section:
    """Mesh of the mid-face section of tooth 0's sector, θ ∈ [−π/z, π/z], without modifications; loaded flank at θ > 0.

    Raises MeshError if the flank start does not lie on the involute.
    """
    profile = Profile(gear)
    start = _flank_start(profile, resolution)
    radii = row_radii(profile, start, resolution.profile_elements, resolution.size_at, resolution.graded_middles)
    band = sum(resolution.layer_depths)
    fine_back = resolution.fine_back
    rows = ToothRows(profile, radii, band, resolution.tip_depth_share, resolution.core_elements + 2, fine_back)
    least = band if resolution.band_below_layers else 0.0
    at_cut = max(least, resolution.band_depth * gear.normal_module)
    widths = (float(rows.strip_width(radii[:1])[0]), float(rows.column_width(radii[:1])[0]))
    neck = resolution.neck_elements
    loaded = RootBand(profile, start, (neck, resolution.fillet_elements), (widths[0], at_cut), mirrored=False)
    back = RootBand(profile, start, (neck, resolution.back_elements), (widths[1 - fine_back], at_cut), mirrored=True)
    pieces = [*_tooth(rows, resolution), _strip_end(loaded, resolution), loaded.band(1), back.band(int(fine_back))]
    pieces += [mirrored_piece(_strip_end(loaded, resolution))] if fine_back else []
    pieces += [_neck(rows, loaded, back), *body_blocks(loaded, back, gear, rows.inner, resolution.body_elements)]
    points, cells = _joined(pieces)
    edges = _named_edges(profile, start, points[:, :2], boundary_facets("quadrilateral", 2, cells))
    return Section(points[:, :2], cells, edges, points[:, 2], start)


def _flank_start(profile: Profile, resolution: SectorResolution) -> float:
    _, form, tip = profile.radii
    if resolution.flank_start_diameter is None:
        return form
    start = resolution.flank_start_diameter / 2
    if not form <= start < tip:
        raise MeshError(
            f"section: wanted a flank start diameter on the involute, from {2 * form:.4f} (root form) to {2 * tip:.4f} "
            f"mm (tip), found {2 * start:.4f}"
        )
    return start


def _layer_columns(resolution: SectorResolution) -> Floats:
    """Columns (4,) of the boundaries of the thin layers, from 0 to 1."""
    depths = np.cumsum((0.0, *resolution.layer_depths))
    return np.asarray(depths / depths[-1])


def _tooth(rows: ToothRows, resolution: SectorResolution) -> list[Piece]:
    """Strip, transitions and coarse columns above the flank start."""
    n = resolution.profile_elements
    layers = subdivided(_layer_columns(resolution), 2)
    strip = grid_piece(rows.points(*np.meshgrid(half_steps(0, n), layers, indexing="ij")), 1 - layers)
    coarse_rows = np.linspace(0, n, 2 * n // 3 + 1)
    columns = half_steps(2, 2 + rows.coarse)
    coarse = grid_piece(rows.points(*np.meshgrid(coarse_rows, columns, indexing="ij")))
    transition = [three_to_one(partial(_transition_point, rows, first)) for first in range(0, n, 3)]
    fine = [strip, *transition]
    return [*fine, coarse, *(map(mirrored_piece, fine) if rows.fine_back else [])]


def _transition_point(rows: ToothRows, first: int, u: Floats, v: Floats) -> Floats:
    return np.column_stack([rows.points(first + u, 1 + v), np.zeros_like(u)])


def _strip_end(side: RootBand, resolution: SectorResolution) -> Piece:
    """The first cell of the band, below the strip of thin layers, where three layers join to one."""
    layers = _layer_columns(resolution)

    def place(u: Floats, v: Floats) -> Floats:
        depth = (1 - v) * np.interp(u, np.arange(4), layers) + v * u / 3
        (r, angle), (r_inner, angle_inner) = to_polar(side.surface(v)), to_polar(side.inner(v))
        points = polar(r + depth * (r_inner - r), angle + depth * (angle_inner - angle))  # the strip's rows are arcs
        return np.column_stack([points, (1 - depth) * (1 - v)])

    return three_to_one(place)


def _neck(rows: ToothRows, loaded: RootBand, back: RootBand) -> Piece:
    """The block between the bands of both sides, from the flank start down to the middles of the fillets."""
    q = half_steps(0, loaded.neck)
    columns = half_steps(1, 1 + rows.inner)
    top = rows.points(np.zeros_like(columns), columns)
    bottom = line(loaded.inner(q[-1:])[0], back.inner(q[-1:])[0], even(columns))
    return grid_piece(transfinite(loaded.inner(q), back.inner(q), top, bottom, even(q), even(columns)))


def _joined(pieces: list[Piece]) -> tuple[Floats, Ints]:
    """Points (n, 3) and counter-clockwise cells (m, 9) of all pieces, welded."""
    cells, start = [], 0
    for points, piece_cells in pieces:
        diagonals = points[piece_cells[:, [2, 3]], :2] - points[piece_cells[:, [0, 1]], :2]
        clockwise = np.linalg.det(diagonals).sum() < 0
        cells.append(start + (piece_cells[:, REVERSED_CELL["quadrilateral", 2]] if clockwise else piece_cells))
        start += len(points)
    points = np.concatenate([points for points, _ in pieces])
    keep, number = weld(points, WELD)
    return _with_single_middles(points[keep], number[np.concatenate(cells)])


def _with_single_middles(points: Floats, cells: Ints) -> tuple[Floats, Ints]:
    """The mesh with one middle node an edge: that of the first piece where two pieces curve their edge differently."""
    corners = np.sort(cells[:, [[0, 1], [1, 2], [2, 3], [3, 0]]], axis=2).reshape(-1, 2)
    _, first, edge = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    middles = cells[:, 4:8].reshape(-1)
    merged = cells.copy()
    merged[:, 4:8] = middles[first][edge.reshape(-1)].reshape(-1, 4)
    used, number = np.unique(merged, return_inverse=True)
    return points[used], number.reshape(merged.shape)


def _named_edges(profile: Profile, start: float, points: Floats, edges: Ints) -> dict[str, Ints]:
    """The edges of the outline, named after the curve on which their middle nodes lie."""
    radius, angle = to_polar(points[edges[:, 2]])
    chosen = {
        "bore": abs(radius - profile.gear.bore_diameter / 2) < WELD,
        "tip": (abs(radius - profile.radii[2]) < WELD) | (radius > profile.corner_radius + WELD),
        "cut_low": abs(angle + profile.sector_angle) * radius < WELD,
        "cut_high": abs(angle - profile.sector_angle) * radius < WELD,
    }
    rest = ~np.any(list(chosen.values()), axis=0)
    chosen["flank"] = rest & (angle > 0) & (radius > start)
    chosen["fillet"] = rest & (angle > 0) & (radius <= start)
    chosen["back"] = rest & (angle < 0)
    return {name: edges[mask] for name, mask in chosen.items()}
