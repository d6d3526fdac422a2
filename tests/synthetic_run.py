"""A run that was never solved: Hertz pressure on the nominal contact lines of the Yang pair, load spread evenly.

Line load q is the same on all contact lines and follows from the pinion's moment, friction included (before the pitch
point it pushes against the pinion, after it with it):

    T_1 = q ∫ (r_b1 cos β_b − μ ρ_1 sign(−ξ)) dl        T_2 = u (T_1 − friction power)

so torques, energy and the friction trend are known in closed form, and every figure has something to show.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from meshes.data import Floats, MeshData
from meshes.flank import contact_lines
from meshes.sector import sector_mesh
from solver.archive import GearShape, gear_shape
from solver.estimates import hertz_estimate
from solver.gear_position import PositionResult
from solver.gear_sweep import SweepState, SweptPosition
from solver.hertz import line_half_width, line_peak_pressure, line_pressure
from solver.kinematics import Stand
from solver.resolution import sector_resolutions
from solver.run_data import RunData, run_data
from solver.scene import Scene, load_scene
from solver.skips import is_plane
from solver.surface import Surface, surface_of

PEAK_TO_PEAK = 1.6e-3  # [mm] of the made-up transmission error
NO_STATE = SweepState((0.0, 0.0), ())


def synthetic_scene(*overrides: str, file: str = "demos/yang2022.toml") -> Scene:
    """A demo's scene at level quick, with few positions unless said otherwise."""
    return load_scene(file, ["mesh.level=quick", "sweep.positions=6", *overrides])


@lru_cache(maxsize=4)
def synthetic_run(*overrides: str, file: str = "demos/yang2022.toml") -> RunData:
    """The whole run; see the module's docstring."""
    scene = synthetic_scene(*overrides, file=file)
    shapes, flank = synthetic_shapes(scene)
    return run_data(scene, shapes, synthetic_sweep(scene, flank))


def synthetic_shapes(scene: Scene) -> tuple[tuple[GearShape, GearShape], Surface]:
    """Both gears' surfaces, and the pinion's flank."""
    shape = "quadrilateral" if is_plane(scene) else "hexahedron"
    meshes: list[MeshData] = [
        sector_mesh(gear, resolution, shape)
        for gear, resolution in zip(scene.gear_pair().gears, sector_resolutions(scene))
    ]
    first, second = (surface_of(mesh, "flank") for mesh in meshes)
    return (gear_shape(meshes[0], first.nodes), gear_shape(meshes[1], second.nodes)), first


def synthetic_sweep(scene: Scene, flank: Surface) -> list[SweptPosition]:
    """One warm-up position, then the pitch."""
    step = 2.0 * np.pi / scene.pinion.teeth / scene.sweep.positions
    return [
        SweptPosition(
            k * step,
            k < 0,
            tuple(synthetic_position(scene, flank, k * step, μ) for μ in scene.contact.friction),
            NO_STATE,
        )
        for k in range(-1, scene.sweep.positions)
    ]


def even_line_load(scene: Scene, angle: float, friction: float) -> float:
    """q [N/mm of contact line]."""
    pair, estimate = scene.gear_pair(), hertz_estimate(scene)
    cos_b, arms = np.cos(pair.pinion.base_helix_angle), 0.0
    for line in contact_lines(pair, angle):
        ξ, z = line.points(2001)
        ρ = pair.curvature_radii(ξ)[0]
        arm = pair.pinion.base_radius * cos_b + friction * ρ * np.sign(ξ)
        arms += float(np.mean(arm)) * (z[-1] - z[0]) / cos_b
    return estimate.pinion_torque / arms


def synthetic_position(scene: Scene, flank: Surface, angle: float, friction: float) -> PositionResult:
    """One position."""
    pair, estimate = scene.gear_pair(), hertz_estimate(scene)
    z = flank.points[:, 2] if flank.points.shape[1] == 3 else np.zeros(len(flank.points))
    r = np.hypot(flank.points[:, 0], flank.points[:, 1])
    ρ = np.sqrt(np.maximum(r**2 - pair.pinion.base_radius**2, 0.0))
    q = even_line_load(scene, angle, friction)
    error = 0.02 + 0.5 * PEAK_TO_PEAK * np.cos(angle * pair.pinion.z)
    stand = Stand(pair, angle, (error / pair.pinion.base_radius, 0.0))
    parts = [_tooth(stand, flank, line.tooth, z, ρ, q, estimate.modulus) for line in contact_lines(pair, angle)]
    tooth, node, ξ, pressure = (np.concatenate(column) for column in zip(*parts))
    d, weights = flank.points.shape[1], flank.weights()[node]
    traction, rate = np.zeros((len(node), d)), np.zeros((len(node), d))
    traction[:, 0], traction[:, 1] = pressure, friction * pressure * np.sign(ξ)
    rate[:, 1] = (1.0 + 1.0 / pair.ratio) * ξ
    torque = estimate.pinion_torque / (pair.face_width if d == 2 else 1.0)
    loss = float(np.sum(weights[:, None] * traction[:, 1:] * rate[:, 1:]))
    placed = np.concatenate([
        flank.points[node[tooth == i]] @ stand.rotation(0, d, i).T + stand.centre(0, d) for i in np.unique(tooth)
    ])  # fmt: skip
    at_edge = (r[node] > r.max() - 1e-6) & (pressure > 0.0)
    return PositionResult(
        stand, friction, (torque, pair.ratio * (torque - loss)), tooth, node, ξ, weights, traction, rate, placed,
        np.zeros(len(node), dtype=bool), at_edge, 5, 1e-9, 0.1,
    )  # fmt: skip


def _tooth(
    stand: Stand, flank: Surface, tooth: int, z: Floats, ρ: Floats, q: float, modulus: float
) -> tuple[Floats, ...]:
    """Nodes near a tooth's contact line: tooth, node, ξ of the slice, Hertz pressure."""
    pair = stand.pair
    ξ = stand.roll_distance(tooth, z)
    start, end = pair.path_of_contact
    ρ_line = pair.pitch_point_roll_lengths[0] + ξ
    across = (ρ**2 - ρ_line**2) / (2.0 * pair.pinion.base_radius)  # profile arc, at right angles to the generators
    radius = pair.relative_curvature_radius(np.clip(ξ, start, end))
    b, p0 = line_half_width(q, radius, modulus), line_peak_pressure(q, radius, modulus)
    on_path = (ξ >= start) & (ξ <= end)
    near = np.flatnonzero(on_path & (np.abs(across) < 2.0 * b))
    pressure = line_pressure(across[near], b[near], 1.0) * p0[near]
    return np.full(len(near), tooth), near, ξ[near], pressure
