"""A pitch of positions in line contact. They have no history, so that each rank solves positions of its own."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence

from mpi4py import MPI

from evolvent.fem.parallel.ranks import together
from evolvent.gears.gear_model import GearModel
from evolvent.gears.line.line_gears import MOST_ON_EDGES, LineGears
from evolvent.gears.line.line_position import position_of
from evolvent.gears.line.line_result import EdgeContact, LineResult
from evolvent.gears.sweep.pitch_sweep import Pitch, SweepState, SweptPosition
from evolvent.gears.sweep.position_result import PositionResult


def line_sweep(
    model: GearModel, pitch: Pitch, frictions: Sequence[float], comm: MPI.Comm, begin: int = 0
) -> Iterator[SweptPosition]:
    """The positions of a pitch, from the one with the number `begin` on. Collective.

    model: condensed for line contact. Raises NotConverged, TooWide, EdgeContact, on all ranks.
    """
    gears, count = LineGears.of(model, any(frictions)), len(pitch.angles)
    for first in range(begin, count, comm.size):
        number = first + comm.rank

        def own(number: int = number) -> SweptPosition | None:
            return None if number >= count else _position(model, gears, pitch, frictions, number)

        for position in comm.allgather(together(comm, own)):
            if position is not None:
                yield position


def _position(
    model: GearModel, gears: LineGears, pitch: Pitch, frictions: Sequence[float], number: int
) -> SweptPosition:
    """A position at all friction coefficients."""
    begin, angle = time.perf_counter(), pitch.angles[number]
    force, position = model.load.at(angle) / model.base_radius, gears.position(angle)
    smooth = LineResult.of(position, force)
    results: list[PositionResult] = []
    for friction in frictions:
        found = LineResult.of(position, force, friction, gears.free) if friction else smooth
        _require_no_edges(model, found, force)
        now = time.perf_counter()
        results.append(position_of(gears, found, smooth, force, now - begin))
        begin = now
    state = SweepState((0.0, 0.0), tuple(None for _ in frictions))
    return SweptPosition(angle, tuple(results), state, closes=number == len(pitch.angles) - 1)


def _require_no_edges(model: GearModel, result: LineResult, force: float) -> None:
    """Raises EdgeContact where edges of tips bear more than `MOST_ON_EDGES` of the load."""
    part = result.position.on_edges(result.equilibrium.load)
    if part > MOST_ON_EDGES:
        torque = 1e-3 * force * model.base_radius * model.width_factor
        raise EdgeContact(
            f"line contact: wanted tips whose edges bear at most {100 * MOST_ON_EDGES:g} % of the load, found that "
            f"under {torque:.4g} N·m they bear {100 * part:.2g} % of it where the pinion is at "
            f"{result.position.stations.angle:.4f} rad; relieve the tips (tip_relief_um), lower the torque, or resolve "
            'the contact (mesh.level = "quick")'
        )
