"""The mesh at several misalignments under one torque: transmission error and tangent stiffness, without friction.

A position is searched at the middle misalignment; at the others its search and its compliance are used again as far as
the flanks stay near, which take most of its time.
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
    """(m, 4) figures of each model (`figures_of`), position by position.

    models: m, of the same gears under the same torque, at ascending misalignments.
    angles: of the pinion [rad].

    Raises NotConverged, SearchError, BalanceError.
    """
    middle, last = len(models) // 2, None
    for angle in angles:
        searched = _searched(models[middle], float(angle), last)
        below = _outward(models[:middle][::-1], float(angle), searched)
        row = [*below[::-1], searched, *_outward(models[middle + 1 :], float(angle), searched)]
        yield np.array([figures_of(model, position) for model, position in zip(models, row)])
        last = searched


def _outward(models: Sequence[GearModel], angle: float, searched: SharedPosition) -> list[SharedPosition]:
    """A position at misalignments that are ever farther from the one at which it was searched. Where they are too far
    to use that search, the position is searched again, for those beyond too."""
    found: list[SharedPosition] = []
    for model in models:
        position = misaligned_on(model, searched)
        if position is None:
            position = searched = _searched(model, angle, found[-1] if found else searched)
        found.append(position)
    return found


def _searched(model: GearModel, angle: float, near: SharedPosition | None) -> SharedPosition:
    """A position at a misalignment. near: another one, from whose rotation and contact patch it starts."""
    beyond_nominal = equilibrium(model, near).beyond_nominal if near is not None else (0.0, 0.0)
    patch = near.patch if near is not None else None
    return shared_position(model, angle, beyond_nominal, [0.0], patch, exact=True)
