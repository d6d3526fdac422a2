"""Rigid displacements of points."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats


def rigid_modes(points: Floats) -> Floats:
    """Small rigid motions at points (n, d): (n, d, r), r = 3 in 2D (x, y, turn), 6 in 3D (x, y, z, turns)."""
    n, d = points.shape
    shift = np.broadcast_to(np.eye(d), (n, d, d))
    if d == 2:
        turn = np.stack([-points[:, 1], points[:, 0]], axis=1)[:, :, None]
    else:
        turn = np.stack([np.cross(axis, points) for axis in np.eye(3)], axis=2)
    return np.concatenate([shift, turn], axis=2)
