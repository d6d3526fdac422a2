"""Smooth orthonormal frames on a contact surface, one a node; local components interpolate like the frames do."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats

ALONG = 0.9  # an axis this close (cosine) to a normal of the surface gives no smooth tangent there


def tangent_frames(normals: Floats) -> Floats:
    """Frames (n, d, d) with rows n, t1[, t2], right-handed, for unit normals (n, d).

    In 3D t1 = r × n for one axis r of the whole surface, z if it can be: on a gear's flank t1 then lies in the
    transverse plane. A surface with normals near all three axes has no smooth frame; its parts should be groups of
    their own.
    """
    if normals.shape[1] == 2:
        return np.stack([normals, np.stack([-normals[:, 1], normals[:, 0]], axis=1)], axis=1)
    steepest = np.abs(normals).max(axis=0)
    axis = next((a for a in (2, 1, 0) if steepest[a] < ALONG), int(np.argmin(steepest)))
    t1 = np.cross(np.eye(3)[axis], normals)
    t1 /= np.maximum(np.linalg.norm(t1, axis=1, keepdims=True), 1e-12)
    return np.stack([normals, t1, np.cross(normals, t1)], axis=1)
