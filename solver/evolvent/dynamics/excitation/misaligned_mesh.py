"""The mesh at several misalignments under one torque: transmission error and tangent stiffness, without friction.

A position is searched at the middle misalignment; at the others its search and its compliance are used again, which
take most of its time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from evolvent.dynamics.excitation.loaded_mesh import equilibrium, figures_of
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.misaligned_position import misaligned_on
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from evolvent_meshes.arrays import Floats


def misaligned_figures(models: Sequence[GearModel], angles: Floats) -> Iterator[Floats]:
    """(m, 2) transmission error [mm] and tangent stiffness [N/mm] of each model, position by position.

    models: m, of the same gears under the same torque, at ascending misalignments.
    angles: of the pinion [rad].

    Raises NotConverged, SearchError.
    """
    middle, last = models[len(models) // 2], None
    for angle in angles:
        searched = _searched(middle, float(angle), last)
        row = [
            searched if model is middle else misaligned_on(model, searched) or _searched(model, float(angle), searched)
            for model in models
        ]
        yield np.array([figures_of(model, position) for model, position in zip(models, row)])
        last = searched


def _searched(model: GearModel, angle: float, near: SharedPosition | None) -> SharedPosition:
    """A position at a misalignment. near: another one, from whose rotation and contact patch it starts."""
    extra = equilibrium(model, near).extra if near is not None else (0.0, 0.0)
    patch = near.patch if near is not None else None
    return shared_position(model, angle, extra, [0.0], patch, exact=True)
