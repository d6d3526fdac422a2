"""Words of a message on a rigid motion of a body that no contact resists."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from evolvent.fem.body import Body, RigidMotions
from evolvent_meshes.arrays import Floats

UNRESISTED = 1e-8
"""Largest jump by a motion, over that by the others, that counts as none."""


def free_motion(bodies: Sequence[Body], motions: Sequence[RigidMotions], jumps: Floats) -> str:
    """The body that is free to move, with the axis along which if it is one; empty where it cannot be told.

    motions: of each body; jumps: (n, r) normal jumps by unit amplitudes of all their free motions.
    """
    lever = np.abs(jumps).max(initial=0.0) or 1.0
    if not jumps.shape[1]:
        return ""
    *_, right = np.linalg.svd(np.vstack([jumps, np.zeros((jumps.shape[1], jumps.shape[1]))]) / lever)
    unresisted = right[-1]
    if np.abs(jumps @ unresisted).max() > UNRESISTED * lever:
        return ""
    ends = np.cumsum([len(each.free) for each in motions])[:-1]
    fields = [each.shapes[:, :, each.free] @ part for each, part in zip(motions, np.split(unresisted, ends))]
    index = int(np.argmax([np.abs(u).max(initial=0.0) for u in fields]))
    return f"body {index} ({bodies[index].name!r}) is free to move{_along(fields[index])}: add Fixed or Rigid"


def _along(u: Floats) -> str:
    """The axis along which displacements u (n, d) go; empty where they turn or go obliquely."""
    axis = int(np.argmax(np.abs(u).max(axis=0)))
    along = np.eye(u.shape[1])[axis] * u[0, axis]
    return f" in {'xyz'[axis]}" if np.abs(u - along).max() <= UNRESISTED * np.abs(u).max() else ""
