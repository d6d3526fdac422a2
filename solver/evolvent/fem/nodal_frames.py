"""Orthonormal frames of normal and tangents at the nodes of a contact surface, which vary smoothly along it."""

from __future__ import annotations

import numpy as np

from evolvent_meshes.arrays import Floats

ALONG = 0.9  # cosine between an axis and a normal from which on the axis gives no smooth tangent


def tangent_frames(normals: Floats) -> Floats:
    """Right-handed frames (n, d, d) with rows n, t1 and, in 3D, t2 for unit normals (n, d).

    In 3D t1 = r × n with one axis r for the whole surface, z if possible: on a gear flank t1 lies in the transverse
    plane. A surface with normals along all three axes has no smooth frame; divide it into several facet groups.
    """
    if normals.shape[1] == 2:
        return np.stack([normals, np.stack([-normals[:, 1], normals[:, 0]], axis=1)], axis=1)
    steepest = np.abs(normals).max(axis=0)
    axis = next((a for a in (2, 1, 0) if steepest[a] < ALONG), int(np.argmin(steepest)))
    t1 = np.cross(np.eye(3)[axis], normals)
    t1 /= np.maximum(np.linalg.norm(t1, axis=1, keepdims=True), 1e-12)
    return np.stack([normals, t1, np.cross(normals, t1)], axis=1)
