"""Meshes made bad on purpose: nodes inside moved at random until the worst cell has a wanted scaled Jacobian."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.quality import scaled_jacobians

BISECTIONS = 30


def distorted(mesh: MeshData, target: float, seed: int) -> MeshData:
    """The mesh with its inner nodes moved, all by the same share of random vectors, so far that the smallest scaled
    Jacobian is `target` times what it was. Nodes of the boundary, which is the problem's, stay.

    Raises ValueError for a mesh without inner nodes.
    """
    inner = np.setdiff1d(np.arange(len(mesh.points)), np.concatenate([f.ravel() for f in mesh.facets.values()]))
    if len(inner) == 0:
        raise ValueError("distorted: wanted a mesh with inner nodes, found none; refine it")
    moved = np.zeros_like(mesh.points)
    directions = np.random.default_rng(seed).uniform(-1.0, 1.0, (len(inner), mesh.dimension))
    moved[inner, : mesh.dimension] = directions * np.ptp(mesh.points, axis=0)[: mesh.dimension]
    wanted = target * float(scaled_jacobians(mesh).min())
    low, high = 0.0, 1.0
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        good = float(scaled_jacobians(_moved(mesh, middle * moved)).min()) >= wanted
        low, high = (middle, high) if good else (low, middle)
    return _moved(mesh, low * moved)


def _moved(mesh: MeshData, shift: Floats) -> MeshData:
    return replace(mesh, points=mesh.points + shift)
