"""A synthetic run: Hertz pressure on the nominal contact lines of a pair, with an even line load.

The line load q is the same on all contact lines. It follows from the pinion's moment with friction, which opposes the
pinion's rotation before the pitch point and supports it after:

    T_1 = q ∫ (r_b1 cos β_b − μ ρ_1 sign(−ξ)) dl        T_2 = u (T_1 − friction power)

Torques, energy and the effect of friction are therefore known in closed form, and every figure has data.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from evolvent.contact.hertz import line_half_width, line_peak_pressure, line_pressure
from evolvent.fem.surface import Surface, surface_of
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.meshed_gear import MeshedGear
from evolvent.gears.meshing.element_sizes import sector_resolutions
from evolvent.gears.pressure.contact_slices import Slices
from evolvent.gears.sweep.pitch_sweep import SweepState, SweptPosition
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.archive.gear_shapes import GearShape, gear_shape
from evolvent.results.run_data import RunData, SolvedPosition, run_data
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.flank import contact_lines
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.sector.sector import sector_mesh

PEAK_TO_PEAK = 1.6e-3
"""Peak-to-peak transmission error [mm]."""
STIFFNESS = 3e5
"""Tangent stiffness along the line of action, of the whole face [N/mm]."""
LAST_ROW = 0.3
"""Contact within this roll distance [mm] of an end of the path of contact bears on a tip edge."""
WINDOW = 0.6
"""Arc length on either side of a contact line within which nodes have results [mm]."""
NO_STATE = SweepState((0.0, 0.0), ())


def synthetic_scene(*overrides: str, file: str = "demos/yang2022.toml") -> Scene:
    """The scene of a demo at level quick, by default with six positions."""
    return load_scene(file, ["mesh.level=quick", "sweep.positions=6", *overrides])


@lru_cache(maxsize=4)
def synthetic_run(*overrides: str, file: str = "demos/yang2022.toml") -> RunData:
    """The run of a demo's scene, see the module."""
    scene = synthetic_scene(*overrides, file=file)
    shapes, flank = synthetic_shapes(scene)
    return run_data(scene, shapes, synthetic_sweep(scene, flank))


def resolved_slices(*columns: Any) -> Slices:
    """Slices on infinitely fine flanks without relief. columns: all others, in the order of `Slices`."""
    count = len(columns[0])
    no = np.zeros(count, dtype=bool)
    every: list[Any] = [*columns, np.zeros((count, 2)), no, no]
    return Slices(*every)


def steep_run(*overrides: str) -> RunData:
    """He's spur pair with three times the even load on tip edges: the pressure rises between the last position and the
    limit of a tip-edge zone, and is largest there."""
    even = synthetic_run("sweep.positions=7", *overrides, file="demos/he2022.toml")
    return replace(even, positions=tuple(tuple(map(_with_loaded_edges, position)) for position in even.positions))


def _with_loaded_edges(solved: SolvedPosition) -> SolvedPosition:
    """The position with three times the load on tip edges."""
    cut = solved.cut
    return replace(solved, cut=replace(cut, hertz=np.where(cut.edge, 3.0, 1.0) * cut.hertz))


def synthetic_shapes(scene: Scene) -> tuple[tuple[GearShape, GearShape], Surface]:
    """Both gears' surfaces, and the pinion's flank."""
    shape = "quadrilateral" if gear_problem(scene).is_plane else "hexahedron"
    meshes: list[MeshData] = [
        sector_mesh(gear, resolution, shape)
        for gear, resolution in zip(scene.gear_pair().gears, sector_resolutions(gear_problem(scene)))
    ]
    pinion, wheel = (MeshedGear(mesh, surface_of(mesh, "flank")) for mesh in meshes)
    return (gear_shape(pinion), gear_shape(wheel)), pinion.flank


def synthetic_sweep(scene: Scene, flank: Surface) -> list[SweptPosition]:
    """The positions of a pitch."""
    step = 2.0 * np.pi / scene.pinion.teeth / scene.sweep.positions
    return [
        SweptPosition(
            k * step,
            tuple(synthetic_position(scene, flank, k * step, μ) for μ in scene.contact.friction),
            NO_STATE,
        )
        for k in range(scene.sweep.positions)
    ]


def even_line_load(scene: Scene, angle: float, friction: float) -> float:
    """Line load q [N per mm of contact line] at a pinion rotation [rad]."""
    pair, estimate = scene.gear_pair(), scene.hertz_estimate()
    cos_b, arms = np.cos(pair.pinion.base_helix_angle), 0.0
    for line in contact_lines(pair, angle):
        ξ, z = line.points(2001)
        ρ = pair.curvature_radii(ξ)[0]
        arm = pair.pinion.base_radius * cos_b + friction * ρ * np.sign(ξ)
        arms += float(np.mean(arm)) * (z[-1] - z[0]) / cos_b
    return estimate.pinion_torque / arms


def synthetic_position(scene: Scene, flank: Surface, angle: float, friction: float) -> PositionResult:
    """The result at a pinion rotation [rad] and a friction coefficient. flank: of the pinion."""
    pair, estimate, d = scene.gear_pair(), scene.hertz_estimate(), flank.points.shape[1]
    line = Ridge(pair, even_line_load(scene, angle, friction), estimate.modulus)
    error = 0.02 + 0.5 * PEAK_TO_PEAK * np.cos(angle * pair.pinion.z)
    stand = PairRotation(pair, angle, (error / pair.pinion.base_radius, 0.0))
    teeth = [each.tooth for each in contact_lines(pair, angle)]
    parts = [contact_points(stand, flank, tooth, line, friction) for tooth in teeth]
    points = ContactPoints.joined(parts)
    tooth, node, traction = (np.concatenate(c) for c in zip(*(nodal(stand, flank, t, line, friction) for t in teeth)))
    no_rows, no_forces = np.zeros((0, 2), dtype=np.int64), np.zeros((0, d))
    torque = estimate.pinion_torque / (pair.face_width if d == 2 else 1.0)
    loss = float(np.sum(points.weights[:, None] * points.traction[:, 1:] * points.rate[:, 1:]))
    return PositionResult(
        stand, friction, (torque, pair.ratio * (torque - loss)), points, tooth, node, flank.weights()[node], traction,
        5, 1e-9, STIFFNESS / (1.0 if d == 3 else pair.face_width),
        no_rows, no_rows, no_forces, no_forces, 0.1,
    )


@dataclass(frozen=True)
class Ridge:
    """Hertz pressure across contact lines under an even line load."""

    pair: GearPair
    """The gear pair."""
    q: float
    """Line load [N/mm]."""
    modulus: float
    """Contact modulus E* [MPa]."""

    def at(self, s: Floats, ξ: Floats) -> Floats:
        """Pressure (n,) [MPa] at distances s (n,) [mm] from the line, at roll distances ξ (n,) [mm]."""
        start, end = self.pair.path_of_contact
        radius = self.pair.relative_curvature_radius(np.clip(ξ, start, end))
        b, p0 = line_half_width(self.q, radius, self.modulus), line_peak_pressure(self.q, radius, self.modulus)
        return np.where((ξ >= start) & (ξ <= end), line_pressure(s / b, 1.0, 1.0) * p0, 0.0)

    def half_width(self, ξ: Floats) -> Floats:
        """Half-width b (n,) [mm] at roll distances ξ (n,) [mm]."""
        return line_half_width(self.q, self.pair.relative_curvature_radius(ξ), self.modulus)


def contact_points(stand: PairRotation, flank: Surface, tooth: int, line: Ridge, friction: float) -> ContactPoints:
    """Contact points of a tooth pair: three heights a layer of cells, and forty points across, exact for an ellipse."""
    pair, d = stand.pair, flank.points.shape[1]
    heights, widths = layer_points(flank)
    ξ = stand.roll_distance(tooth, heights)
    keep = (ξ >= pair.path_of_contact[0]) & (ξ <= pair.path_of_contact[1])
    z, ξ, widths = heights[keep], ξ[keep], widths[keep]
    turn = (np.arange(40) + 0.5) * np.pi / 40
    b = line.half_width(ξ)
    s = (b[:, None] * -np.cos(turn)).ravel()
    weights = (b[:, None] * np.sin(turn) * np.pi / 40 * widths[:, None]).ravel() / np.cos(pair.pinion.base_helix_angle)
    z, ξ = np.repeat(z, 40), np.repeat(ξ, 40)
    traction, rate = np.zeros((len(z), d)), np.zeros((len(z), d))
    traction[:, 0] = line.at(s, ξ)
    traction[:, 1] = friction * traction[:, 0] * np.sign(ξ)
    rate[:, 1] = (1.0 + 1.0 / pair.ratio) * ξ
    start, end = pair.path_of_contact
    edge = (ξ < start + LAST_ROW) | (ξ > end - LAST_ROW)
    slides = np.zeros(len(z), dtype=bool)
    return ContactPoints(np.full(len(z), tooth), z, ξ, s, -s, weights, traction, rate, rate[:, 1], slides, edge)


def layer_points(flank: Surface) -> tuple[Floats, Floats]:
    """Heights (n,) [mm] of three Gauss points in every layer of cells along z, and their weights (n,) [mm]; a single
    point of weight 1 in 2D."""
    if flank.points.shape[1] == 2:
        return np.zeros(1), np.ones(1)
    edges = np.unique(np.round(flank.points[:, 2], 9))[:: flank.order]
    x, w = np.polynomial.legendre.leggauss(3)
    half, middle = 0.5 * np.diff(edges), 0.5 * (edges[1:] + edges[:-1])
    return (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


def nodal(stand: PairRotation, flank: Surface, tooth: int, line: Ridge, friction: float) -> tuple[Ints, Ints, Floats]:
    """Tooth (n,), node (n,) and traction (n, d) [MPa] at the nodes near a tooth's contact line."""
    pair, d = stand.pair, flank.points.shape[1]
    z = flank.points[:, 2] if d == 3 else np.zeros(len(flank.points))
    ρ = np.sqrt(np.maximum(np.sum(flank.points[:, :2] ** 2, axis=1) - pair.pinion.base_radius**2, 0.0))
    ξ = stand.roll_distance(tooth, z)
    s = (ρ**2 - (pair.pitch_point_roll_lengths[0] + ξ) ** 2) / (2.0 * pair.pinion.base_radius)
    near = np.flatnonzero(np.abs(s) < WINDOW)
    traction = np.zeros((len(near), d))
    traction[:, 0] = line.at(s[near], ξ[near])
    traction[:, 1] = friction * traction[:, 0] * np.sign(ξ[near])
    return np.full(len(near), tooth), near, traction
