"""Rotation about the axis of a gear."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats


def turn(angle: float, d: int) -> Floats:
    """Rotation matrix (d, d) about +z by an angle [rad].

    >>> turn(np.pi / 2.0, 2).round(12)
    array([[ 0., -1.],
           [ 1.,  0.]])
    """
    c, s = np.cos(angle), np.sin(angle)
    R = np.eye(d)
    R[:2, :2] = [[c, -s], [s, c]]
    return R
