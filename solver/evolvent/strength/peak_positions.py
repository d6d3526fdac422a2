"""Further positions of a pitch, where root stress is largest.

Between two of twenty positions of a spur gear stress may be larger by 9 % than at either. Positions are added where it
may be highest beside each largest value (`peak_bounds`), until none may be higher by half a per cent. A further
position starts from the friction history of the one before it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first, together
from evolvent.gears.gear_model import GearModel
from evolvent.gears.solution.certificates import certify
from evolvent.gears.sweep.pitch_sweep import Pitch, SweepState, SweptPosition, sweep_pitch
from evolvent.results.error_bars.peak_bounds import peak_bounds
from evolvent.strength.root_passage import GearRoots, root_passages
from evolvent_meshes.gears.member import Member

GAIN = 0.005
"""Rise of the largest stress between two positions that is left unresolved, over the largest stress."""
NARROWEST = 0.01
"""Narrowest interval between positions that is divided, over the pitch."""
Roots = list[tuple[GearRoots, GearRoots]]
"""Roots of pinion and wheel at each friction coefficient."""


@dataclass(frozen=True, eq=False)
class SweptRoots:
    """Positions of a pitch, and the root stress of both gears at them."""

    positions: Sequence[SweptPosition]
    """Swept positions by ascending angle."""
    roots: Roots
    """Root stress over the rotations of these positions."""


Stored = Callable[[float, Callable[[], SweptPosition]], SweptPosition]
"""Function that returns the position at a pinion rotation [rad]: a stored one, or that which the second argument
solves."""


def solved_at_once(angle: float, solve: Callable[[], SweptPosition]) -> SweptPosition:
    """The position at a pinion rotation, of which none is stored."""
    return solve()


def roots_of(model: GearModel, positions: Sequence[SweptPosition]) -> Roots:
    """Roots of both gears, condensed from meshes of `root_meshes`, at each friction coefficient."""
    found: Roots = []
    for index in range(len(positions[0].results)):
        pinion, wheel = (root_passages(body, [each.results[index] for each in positions]) for body in model.bodies)
        found.append((pinion, wheel))
    return found


def with_peaks(
    model: GearModel, known: SweptRoots, frictions: Sequence[float], comm: MPI.Comm, stored: Stored = solved_at_once
) -> SweptRoots:
    """Root stress with further positions around its largest values. Collective. Raises NotConverged, SearchError."""
    while angles := on_first(comm, partial(_further, model, known)):
        known = with_angles(model, known, angles, frictions, comm, stored)
    return known


def with_angles(
    model: GearModel, known: SweptRoots, angles: Sequence[float], frictions: Sequence[float], comm: MPI.Comm,
    stored: Stored = solved_at_once,
) -> SweptRoots:
    """Root stress with further pinion rotations [rad], each from the state of the last one that the gears pass
    before it. Collective. stored: see `Stored`.

    Raises NotConverged, SearchError, BalanceError.
    """
    if not angles:
        return known

    def solve(angle: float) -> SweptPosition:
        position = next(sweep_pitch(model, Pitch((angle,)), frictions, _before(model, known.positions, angle)))
        certify(position.results)
        return position

    def solved() -> list[SweptPosition]:
        return [stored(angle, partial(solve, angle)) for angle in angles[comm.rank :: comm.size]]

    further = [each for part in comm.allgather(together(comm, solved)) for each in part]
    every = sorted([*known.positions, *further], key=lambda each: each.angle)
    more = on_first(comm, partial(roots_of, model, further))
    joined = [(pinion.joined(a), wheel.joined(b)) for (pinion, wheel), (a, b) in zip(known.roots, more)]
    return SweptRoots(every, joined)


def _before(model: GearModel, positions: Sequence[SweptPosition], angle: float) -> SweepState:
    """State of the sweep at the last of some positions, by ascending angle, that the gears pass before an angle [rad];
    of the next pitch where the wheel drives and that is the first one there."""
    next_one = int(np.searchsorted([each.angle for each in positions], angle))
    if model.load.driving is Member.PINION:
        return positions[next_one - 1].state
    whole, number = divmod(next_one, len(positions))
    return positions[number].state.earlier(-whole)


def _further(model: GearModel, known: SweptRoots) -> list[float]:
    """Pinion rotations in [0, pitch) at which the largest stresses may be higher [rad]."""
    pitch = 2.0 * np.pi / model.pair.pinion.z
    wanted: list[float] = []
    for own in (gear for both in known.roots for gear in both):
        loaded, back = own.loaded_side, own.back_side
        for angles, stress in ((loaded.angles, loaded.largest), (back.angles, -back.smallest)):
            for peak in peak_bounds(angles, stress):
                if peak.width > NARROWEST * pitch and peak.height > (1.0 + GAIN) * stress.max():
                    wanted.append(peak.angle % pitch)
    apart: list[float] = []
    for angle in sorted(wanted):
        if not apart or angle - apart[-1] > NARROWEST * pitch:
            apart.append(angle)
    return apart
