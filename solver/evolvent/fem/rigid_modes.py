"""Displacements by small rigid motions."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats


def rigid_modes(points: Floats) -> Floats:
    """Displacements (n, d, r) of points (n, d) by small unit rigid motions, about the origin.

    2D: r = 3 motions x, y, rz; 3D: r = 6 motions x, y, z, rx, ry, rz.
    """
    n, d = points.shape
    shift = np.broadcast_to(np.eye(d), (n, d, d))
    if d == 2:
        turn = np.stack([-points[:, 1], points[:, 0]], axis=1)[:, :, None]
    else:
        turn = np.stack([np.cross(axis, points) for axis in np.eye(3)], axis=2)
    return np.concatenate([shift, turn], axis=2)
