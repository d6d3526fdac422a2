"""Off-screen rendering of the gear pair in space by pyvista, which only this module and `fields` use."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.drawing.style import FAINT, OVER, PINION_BODY, PRESSURE_MAP, WHEEL_BODY
from evolvent.results.fields.flank_field import Patch, flank_field, flank_patch
from evolvent.results.fields.paraview import poly_data
from evolvent.results.fields.polygons import Polygons, all_teeth, place, placed_teeth
from evolvent.results.run_data import RunData
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.flank import action_plane_points
from evolvent_meshes.gears.member import Member

Image = NDArray[np.uint8]
"""RGB image (height, width, 3)."""
BODY = (PINION_BODY, WHEEL_BODY)
NEAR = 3
"""Number of teeth on either side of the mesh that are visible at close range."""
LIGHT = {"ambient": 0.28, "diffuse": 0.75, "specular": 0.15, "specular_power": 20.0}


@dataclass(frozen=True)
class Camera:
    """A camera of parallel projection."""

    target: tuple[float, float, float]
    """Point in the middle of the image [mm]."""
    along: tuple[float, float, float]
    """Direction from the target to the camera."""
    reach: float
    """Half the height of the visible field [mm]."""
    up: tuple[float, float, float] = (0.0, 1.0, 0.0)
    """Upward direction of the image."""


def contact_teeth(result: PositionResult) -> list[int]:
    """Tooth pairs in contact, ascending."""
    return sorted(set(result.tooth[result.pressure > 0.0].tolist()))


def pair_picture(run: RunData, result: PositionResult, top: float, size: tuple[int, int], close: float = 0.0) -> Image:
    """Image of both gears at a position; the wheel is transparent, so that the pinion's contact lines are visible.

    top: pressure at the upper end of the colour scale [MPa]; size: width and height in pixels; close: from 0 for a view
    of the whole pinion to 1 for the mesh.
    """
    pinion, pitch = run.pair.pinion, 0.5 * run.pair.working_pitch_diameters[0]
    scene = _plotter(size)
    _add_gear(scene, run, result, Member.PINION, all_teeth(run, Member.PINION), opacity=1.0)
    _add_flanks(scene, run, result, Member.PINION, top)
    _add_gear(scene, run, result, Member.WHEEL, all_teeth(run, Member.WHEEL), opacity=0.22)
    target = ((0.66 + 0.36 * close) * pitch, 0.0, 0.0)
    reach = (0.6 - 0.28 * close) * pinion.tip_diameter
    return _picture(scene, Camera(target, (0.35, 1.0, 0.6), reach))


def gear_picture(run: RunData, result: PositionResult, gear: Member, top: float, size: tuple[int, int]) -> Image:
    """Image of the loaded flanks of one gear, from the place of the other gear, which is left out. top, size: see
    `pair_picture`."""
    scene = _plotter(size)
    _add_gear(scene, run, result, gear, all_teeth(run, gear), opacity=1.0)
    _add_flanks(scene, run, result, gear, top)
    return _picture(scene, _at_the_mesh(run, gear))


def flank_picture(run: RunData, result: PositionResult, patch: Patch, values: Floats, top: float,
                  size: tuple[int, int]) -> Image:
    """Image of one gear with the same values on all its loaded flanks, without the other gear. values: (n, m) on the
    patch; top: value at the upper end of the colour scale; size: width and height in pixels."""
    scene, gear, near = _plotter(size), patch.gear, list(range(-NEAR, NEAR + 1))
    _add_gear(scene, run, result, gear, all_teeth(run, gear), 1.0, set(near))
    surface = patch.polygons(run)
    for tooth in near:
        _add_coloured(scene, place(result, gear, tooth, surface), values, top)
    return _picture(scene, _at_the_mesh(run, gear))


def _at_the_mesh(run: RunData, gear: Member) -> Camera:
    """Camera at the place of the other gear, with this gear's teeth at the pitch point as its target."""
    middle = action_plane_points(run.pair, 0.0, 0.0)
    width = max(run.pair.face_width, 6.0 * run.pair.pinion.normal_module)
    along = (0.75, 1.0, 0.3) if gear == Member.PINION else (-0.75, -1.0, 0.3)
    return Camera(tuple(middle.tolist()), along, 0.5 * width)


def _plotter(size: tuple[int, int]) -> Any:
    """An empty pyvista plotter."""
    scene = pv.Plotter(off_screen=True, window_size=list(size), lighting="light kit")
    scene.set_background("white")
    scene.enable_parallel_projection()
    scene.enable_depth_peeling(8)
    return scene


def _add_gear(
    scene: Any, run: RunData, result: PositionResult, gear: Member, teeth: list[int], opacity: float,
    bare: set[int] | None = None,
) -> None:
    """Adds the teeth of a gear. bare: teeth whose loaded flanks are left out, by default those in contact."""
    placed = placed_teeth(run, result, gear, teeth, set(contact_teeth(result)) if bare is None else bare)
    assert placed is not None
    surface = poly_data(placed).triangulate().clean(tolerance=1e-6, absolute=True)
    smooth = surface.compute_normals(split_vertices=True, feature_angle=35.0, consistent_normals=False)
    scene.add_mesh(smooth, color=BODY[gear], opacity=opacity, smooth_shading=True, **LIGHT)
    if opacity < 1.0:
        edges = surface.extract_feature_edges(feature_angle=35.0, boundary_edges=False, manifold_edges=False)
        scene.add_mesh(edges, color=BODY[gear], line_width=1.0, opacity=0.6)


def _add_flanks(scene: Any, run: RunData, result: PositionResult, gear: Member, top: float) -> None:
    """Adds the loaded flanks of the teeth in contact, coloured by pressure up to `top` [MPa]."""
    patch = flank_patch(run, gear)
    surface = patch.polygons(run)
    for tooth in contact_teeth(result):
        field = flank_field(run, result, tooth)
        _add_coloured(scene, place(result, gear, tooth, surface), patch.values(run, result, tooth, field), top)


def _add_coloured(scene: Any, surface: Polygons, values: Floats, top: float) -> None:
    """Adds a surface coloured by values at its points, without lighting: a shaded colour would represent another
    value."""
    mesh = poly_data(surface)
    mesh["values"] = values.ravel()
    scene.add_mesh(
        mesh, scalars="values", cmap=PRESSURE_MAP, clim=(0.0, top), n_colors=256, above_color=OVER,
        show_scalar_bar=False, interpolate_before_map=True, lighting=False,
    )
    rim = mesh.extract_feature_edges(feature_edges=False, manifold_edges=False, non_manifold_edges=False)
    scene.add_mesh(rim, color=FAINT, line_width=1.5, lighting=False)


def _picture(scene: Any, camera: Camera) -> Image:
    """Renders the scene and closes its plotter."""
    target, along = np.array(camera.target), np.array(camera.along)
    eye = target + 500.0 * along / np.linalg.norm(along)
    scene.camera_position = [tuple(eye), camera.target, camera.up]
    scene.camera.parallel_scale = camera.reach
    scene.reset_camera_clipping_range()
    scene.enable_anti_aliasing("ssaa")
    image = scene.screenshot(return_img=True)
    scene.close()
    return np.asarray(image)
