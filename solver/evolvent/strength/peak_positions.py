"""Further positions of a pitch, where root stress is largest.

Stress rises steeply where a tooth takes over the load of its neighbour: between two of twenty positions of a spur gear
it may be larger by 6 % than at either. The intervals beside each largest value are halved until they are a hundredth of
a pitch. A further position starts from the friction history of the one before it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np
from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first, together
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.pitch_sweep import Pitch, SweptPosition, sweep_pitch
from evolvent.strength.root_passage import GearRoots, root_passages
from evolvent_meshes.arrays import Floats

NARROWEST = 0.01
"""Largest interval beside a peak, over the pitch."""
Roots = list[tuple[GearRoots, GearRoots]]
"""Of pinion and wheel at each friction coefficient."""


def roots_of(model: GearModel, positions: Sequence[SweptPosition]) -> Roots:
    """Of both gears, condensed from meshes of `root_meshes`, at each friction coefficient."""
    found: Roots = []
    for index in range(len(positions[0].results)):
        pinion, wheel = (root_passages(body, [each.results[index] for each in positions]) for body in model.bodies)
        found.append((pinion, wheel))
    return found


def with_peaks(
    model: GearModel, positions: Sequence[SweptPosition], frictions: Sequence[float], comm: MPI.Comm
) -> list[SweptPosition]:
    """The positions of a pitch and those around the largest stresses, by ascending angle. Collective.

    Raises NotConverged, SearchError.
    """
    every = list(positions)
    for _ in range(math.ceil(math.log2(max(1.0, 1.0 / (NARROWEST * len(positions)))))):
        angles = on_first(comm, partial(_middles, model, every))
        every = with_angles(model, every, angles, frictions, comm)
    return every


def with_angles(
    model: GearModel, positions: Sequence[SweptPosition], angles: Sequence[float], frictions: Sequence[float],
    comm: MPI.Comm,
) -> list[SweptPosition]:  # fmt: skip
    """The positions and those at further pinion rotations [rad], each from the state of the last one before it.
    Collective. Raises NotConverged, SearchError."""
    known = np.array([each.angle for each in positions])

    def solved() -> list[SweptPosition]:
        own = angles[comm.rank :: comm.size]
        states = (positions[int(np.searchsorted(known, angle)) - 1].state for angle in own)
        return [next(sweep_pitch(model, Pitch((angle,)), frictions, state)) for angle, state in zip(own, states)]

    further = [each for part in comm.allgather(together(comm, solved)) for each in part]
    return sorted([*positions, *further], key=lambda each: each.angle)


def _middles(model: GearModel, positions: Sequence[SweptPosition]) -> list[float]:
    """Pinion rotations in [0, pitch) midway between those of the largest stresses and the ones beside them [rad]."""
    pitch, middles = 2.0 * np.pi / model.pair.pinion.z, set[float]()
    for own in (gear for both in roots_of(model, positions) for gear in both):
        loaded, back = own.loaded_side, own.back_side
        for angles, stress in ((loaded.angles, loaded.largest), (back.angles, -back.smallest)):
            middles |= {round(float(middle % pitch), 12) for middle in _beside_peak(angles, stress)}
    return sorted(middles)


def _beside_peak(angles: Floats, stress: Floats) -> Iterator[float]:
    """Midway between the angle of the largest stress and those before and after it [rad]."""
    k = int(np.argmax(stress))
    for a, b in ((k - 1, k), (k, k + 1)):
        if a >= 0 and b < len(stress):
            yield 0.5 * float(angles[a] + angles[b])
