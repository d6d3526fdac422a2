"""Frames of normal and tangents at the nodes of a surface."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.fem.nodal_frames import tangent_frames


@pytest.mark.parametrize("d", [2, 3])
def test_nodal_frames_are_orthonormal_and_right_handed(d: int) -> None:
    """Frames of normals within 0.3 rad of the first axis: rows orthonormal, the normal first, determinant 1."""
    normals = np.eye(d)[0] + np.random.default_rng(d).uniform(-0.2, 0.2, (50, d))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    frames = tangent_frames(normals)
    assert np.allclose(frames @ np.swapaxes(frames, 1, 2), np.eye(d), atol=1e-14)
    assert np.allclose(np.linalg.det(frames), 1.0)
    assert np.array_equal(frames[:, 0], normals)


def test_first_tangent_lies_in_the_transverse_plane() -> None:
    """Normals of a cylinder about z and slightly tilted: t1 has no z component, as z is the reference axis."""
    angle = np.linspace(0.0, 2.0, 20)
    normals = np.column_stack([np.cos(angle), np.sin(angle), 0.3 * np.sin(3.0 * angle)])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    assert np.allclose(tangent_frames(normals)[:, 1, 2], 0.0)
