"""Quarters of blocks for elliptical contacts: ring meshes stretched along x, with a ring that ends at an ellipse.

x points along the major half-axis, y along the minor one, z up; both shapes touch at the origin. Parameters that are
not explained: `rings`.
"""

from __future__ import annotations

from dataclasses import replace

from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.shapes.blocks import lifted
from evolvent_meshes.shapes.lengths import check_lengths, check_tuples
from evolvent_meshes.shapes.rings import ring_block


def ellipse_block(
    half_axes: tuple[float, float],
    side: float,
    size: float,
    fine: float,
    order: int = 2,
    growth: float = 1.3,
    fine_depth: float | None = None,
) -> MeshData:
    """Quarter of an upright elliptical cylinder below z = 0, of hexahedra.

    half_axes: (a, b) of the contact, a >= b [mm]; all lengths along x are stretched by a/b.
    side: height, and half-axis along y [mm].
    size: largest cells along y and z in the contact zone [mm].
    fine: half-width of the contact zone along y [mm].
    Facet groups: symmetry_x (x = 0), symmetry_y (y = 0), side, bottom, top.
    Raises MeshError unless 0 < b <= a and b < fine < side.
    """
    check_tuples("ellipse_block", 2, half_axes=half_axes)
    a, b = half_axes
    check_lengths("ellipse_block", half_axes=a, side=side, size=size, fine=fine, growth=growth, fine_depth=fine_depth)
    check_lengths("ellipse_block", half_axes=b)
    if not 0 < b <= a:
        raise MeshError(f"ellipse block: wanted half-axes 0 < b <= a, found a = {a}, b = {b} mm; exchange them")
    mesh = ring_block(side, side, b, size, fine, order, growth, fine_depth)
    return replace(mesh, points=mesh.points * (a / b, 1.0, 1.0))


def ellipse_punch(
    half_axes: tuple[float, float],
    curvatures: tuple[float, float],
    side: float,
    size: float,
    fine: float,
    order: int = 2,
    growth: float = 1.3,
    fine_depth: float | None = None,
) -> MeshData:
    """Quarter of an upright elliptical cylinder above z = 0, its underside the paraboloid z = A x² + B y².

    curvatures: (A, B) [1/mm].
    The other parameters are those of `ellipse_block`; the flat top is at z = side.
    Facet groups: arc (the paraboloid), top, symmetry_x, symmetry_y, side.
    Raises MeshError as `ellipse_block`, and unless the paraboloid rises less than 0.7 side.
    """
    check_tuples("ellipse_punch", 2, half_axes=half_axes, curvatures=curvatures)
    for curvature in curvatures:
        check_lengths("ellipse_punch", curvatures=curvature)
    block = ellipse_block((half_axes[1], half_axes[1]), side, size, fine, order, growth, fine_depth)
    points = block.points[:, [1, 0, 2]] * (half_axes[0] / half_axes[1], 1.0, -1.0)  # turned upside down about x = y
    x, y, _ = points.T
    sag = curvatures[0] * x**2 + curvatures[1] * y**2
    if sag.max() > 0.7 * side:
        raise MeshError(
            f"ellipse punch: wanted a paraboloid that rises less than 0.7 times the height {side} mm, found "
            f"{sag.max():.4g} mm; take smaller curvatures or a smaller side"
        )
    names = {"symmetry_x": "symmetry_y", "symmetry_y": "symmetry_x", "top": "arc", "bottom": "top", "side": "side"}
    facets = {names[name]: group for name, group in block.facets.items()}
    return replace(block, points=lifted(points, sag, side), facets=facets)
