"""Off-screen rendering of the gear pair in space by pyvista, which only this module and `fields` use."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.drawing.style import FAINT, OVER, PINION_BODY, PRESSURE_MAP, WHEEL_BODY
from evolvent.results.fields.flank_field import POINTS, Patch, flank_field, flank_patch
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
TRANSPARENT = 0.22
"""Opacity of a wheel through which the pinion is seen."""
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


@dataclass(frozen=True)
class Flank:
    """A loaded flank, coloured by pressure."""

    tooth: int
    """Index of its tooth pair."""
    patch: Patch
    """Points on it."""
    mesh: Any
    """Surface that pyvista shows, with the pressure at these points as its array "values" [MPa]."""


@dataclass(frozen=True)
class Part:
    """A part of a gear in a plotter, which is built once and turns with the gear."""

    gear: Member
    """Pinion or wheel."""
    built: PositionResult
    """Position at which its points lie."""
    actors: list[Any]
    """Actors of its surface and of lines on it."""
    flank: Flank | None = None
    """The loaded flank that it is; None for the body with its other surfaces."""

    def turn(self, run: RunData, result: PositionResult) -> None:
        """Shows it where the gear stands at a position, with the pressure there."""
        motion, then, now = np.eye(4), self.built.stand, result.stand
        motion[:3, :3] = now.rotation(self.gear, 3) @ then.rotation(self.gear, 3).T
        motion[:3, 3] = now.centre(self.gear, 3) - motion[:3, :3] @ then.centre(self.gear, 3)
        for actor in self.actors:
            actor.user_matrix = motion
        if self.flank is not None:
            self.flank.mesh["values"] = _pressure(run, result, self.flank.patch, self.flank.tooth).ravel()


def contact_teeth(result: PositionResult) -> list[int]:
    """Tooth pairs in contact, ascending."""
    return sorted(set(result.tooth[result.pressure > 0.0].tolist()))


def pair_pictures(
    run: RunData, results: Iterable[PositionResult], top: float, size: tuple[int, int], close: float = 0.0,
    points: tuple[int, int] = POINTS,
) -> Generator[Image, None, None]:
    """Images of both gears at one position after the other; the wheel is transparent, so that the pinion's contact
    lines are visible. From image to image the gears turn; they are built again where other teeth are in contact.

    top: pressure at the upper end of the colour scale [MPa]; size: width and height in pixels; close: from 0 for a view
    of the whole pinion to 1 for the mesh; points: on a flank, along the profile and across the face.

    The generator holds a window. A caller that does not take all images must close it.
    """
    scene, pitch = _plotter(size), 0.5 * run.pair.working_pitch_diameters[0]
    target, reach = ((0.66 + 0.36 * close) * pitch, 0.0, 0.0), (0.6 - 0.28 * close) * run.pair.pinion.tip_diameter
    patch, shown = flank_patch(run, Member.PINION, points), dict[str, Part]()
    try:
        for result in results:
            shown = _turned(scene, shown, run, result, patch, top)
            yield _image(scene, Camera(target, (0.35, 1.0, 0.6), reach))
    finally:
        scene.close()


def _turned(
    scene: Any, shown: dict[str, Part], run: RunData, result: PositionResult, patch: Patch, top: float
) -> dict[str, Part]:
    """Parts of the pair at a position by name: both bodies, and the pinion's flanks in contact. shown: those of the
    position before, of which those that are needed are turned and the others removed."""
    teeth = contact_teeth(result)
    build: dict[str, Callable[[], Part]] = {
        f"pinion without flanks {teeth}": partial(_body, scene, run, result, Member.PINION, 1.0),
        **{f"flank {tooth}": partial(_flank, scene, run, result, patch, tooth, top) for tooth in teeth},
        f"wheel without flanks {teeth}": partial(_body, scene, run, result, Member.WHEEL, TRANSPARENT),
    }
    for name in shown.keys() - build.keys():
        scene.remove_actor(shown[name].actors, render=False)
    for name in shown.keys() & build.keys():
        shown[name].turn(run, result)
    return {name: shown[name] if name in shown else new() for name, new in build.items()}


def gear_picture(run: RunData, result: PositionResult, gear: Member, top: float, size: tuple[int, int]) -> Image:
    """Image of the loaded flanks of one gear, from the place of the other gear, which is left out. top, size: see
    `pair_pictures`."""
    scene, patch = _plotter(size), flank_patch(run, gear)
    _body(scene, run, result, gear, 1.0)
    for tooth in contact_teeth(result):
        _flank(scene, run, result, patch, tooth, top)
    return _picture(scene, _at_the_mesh(run, gear))


def flank_picture(run: RunData, result: PositionResult, patch: Patch, values: Floats, top: float,
                  size: tuple[int, int]) -> Image:
    """Image of one gear with the same values on all its loaded flanks, without the other gear. values: (n, m) on the
    patch; top: value at the upper end of the colour scale; size: width and height in pixels."""
    scene, gear, near = _plotter(size), patch.gear, list(range(-NEAR, NEAR + 1))
    _add_gear(scene, run, result, gear, 1.0, set(near))
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
    scene.enable_anti_aliasing("ssaa")
    return scene


def _body(scene: Any, run: RunData, result: PositionResult, gear: Member, opacity: float) -> Part:
    """Adds all teeth of a gear at a position, those in contact without their loaded flanks."""
    bare = set(contact_teeth(result))
    return Part(gear, result, _add_gear(scene, run, result, gear, opacity, bare))


def _flank(scene: Any, run: RunData, result: PositionResult, patch: Patch, tooth: int, top: float) -> Part:
    """Adds the loaded flank of a tooth at a position, coloured by pressure up to `top` [MPa]."""
    surface = place(result, patch.gear, tooth, patch.polygons(run))
    mesh, actors = _add_coloured(scene, surface, _pressure(run, result, patch, tooth), top)
    return Part(patch.gear, result, actors, Flank(tooth, patch, mesh))


def _pressure(run: RunData, result: PositionResult, patch: Patch, tooth: int) -> Floats:
    """Pressure (n, m) on the loaded flank of a tooth at a position [MPa]."""
    return patch.values(run, result, tooth, flank_field(run, result, tooth))


def _add_gear(
    scene: Any, run: RunData, result: PositionResult, gear: Member, opacity: float, bare: set[int]
) -> list[Any]:
    """Adds all teeth of a gear; gives the actors. bare: teeth whose loaded flanks are left out."""
    placed = placed_teeth(run, result, gear, all_teeth(run, gear), bare)
    assert placed is not None
    surface = poly_data(placed).triangulate().clean(tolerance=1e-6, absolute=True)
    smooth = surface.compute_normals(split_vertices=True, feature_angle=35.0, consistent_normals=False)
    body = scene.add_mesh(smooth, color=BODY[gear], opacity=opacity, smooth_shading=True, render=False, **LIGHT)
    if opacity == 1.0:
        return [body]
    edges = surface.extract_feature_edges(feature_angle=35.0, boundary_edges=False, manifold_edges=False)
    return [body, scene.add_mesh(edges, color=BODY[gear], line_width=1.0, opacity=0.6, render=False)]


def _add_coloured(scene: Any, surface: Polygons, values: Floats, top: float) -> tuple[Any, list[Any]]:
    """Adds a surface coloured by values at its points, without lighting: a shaded colour would represent another
    value. Gives its mesh, whose array "values" is shown, and the actors."""
    mesh = poly_data(surface)
    mesh["values"] = values.ravel()
    coloured = scene.add_mesh(
        mesh, scalars="values", cmap=PRESSURE_MAP, clim=(0.0, top), n_colors=256, above_color=OVER,
        show_scalar_bar=False, interpolate_before_map=True, lighting=False, render=False,
    )
    rim = mesh.extract_feature_edges(feature_edges=False, manifold_edges=False, non_manifold_edges=False)
    return mesh, [coloured, scene.add_mesh(rim, color=FAINT, line_width=1.5, lighting=False, render=False)]


def _picture(scene: Any, camera: Camera) -> Image:
    """Renders the scene and closes its plotter."""
    image = _image(scene, camera)
    scene.close()
    return image


def _image(scene: Any, camera: Camera) -> Image:
    """Renders the scene."""
    target, along = np.array(camera.target), np.array(camera.along)
    eye = target + 500.0 * along / np.linalg.norm(along)
    scene.camera_position = [tuple(eye), camera.target, camera.up]
    scene.camera.parallel_scale = camera.reach
    scene.reset_camera_clipping_range()
    scene.render()  # a screenshot alone renders the first time only
    return np.asarray(scene.screenshot(return_img=True))
