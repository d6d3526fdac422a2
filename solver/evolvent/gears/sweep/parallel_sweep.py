"""A pitch of gear positions on several ranks: two prepare a position each, then all solve friction.

Search, compliance and the frictionless equilibrium are most of a position. They do not depend on the friction of the
position before, and where their search starts makes no difference. Friction follows position by position, the
coefficients divided among the ranks, which read the prepared positions from the same memory.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

from mpi4py import MPI

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.fem.parallel.cores import Cores
from evolvent.fem.parallel.ranks import SharedBroadcast, together
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.pitch_sweep import Pitch, SweepState, SweptPosition, joined, sweep_pitch
from evolvent.gears.sweep.position_search import SharedPosition, shared_position

PREPARING = 2  # ranks: from further away a search takes longer


def sweep_on_ranks(
    model: GearModel, pitch: Pitch, frictions: Sequence[float], state: SweepState, comm: MPI.Comm, begin: int = 0
) -> Generator[SweptPosition, None, None]:
    """`sweep_pitch`, the work divided; all ranks get all results. Raises NotConverged on all ranks, which must close it
    together where they leave it early."""
    if comm.size == 1:
        yield from sweep_pitch(model, pitch, frictions, state, begin)
        return
    broadcasts = tuple(SharedBroadcast(comm, root) for root in range(PREPARING))
    # not closed where something failed: a rank alone with the failure would wait for the others
    with suppress(GeneratorExit):
        yield from _RankedSweep(model, pitch, frictions, comm, Cores(comm), broadcasts).swept(state, begin)
    for broadcast in broadcasts:
        broadcast.close()


def positions_at_once(comm: MPI.Comm) -> int:
    """Number of positions that are solved before the first of them is yielded."""
    return min(comm.size, PREPARING)


def division(count: int, ranks: int) -> list[slice]:
    """The friction coefficients of `count` that each rank solves: neighbours together, as one helps to solve the next,
    and more of the small ones, as these take fewer iterations."""
    ends = [-(-count * rank // ranks) for rank in range(ranks + 1)]
    return [slice(a, b) for a, b in pairwise(ends)]


@dataclass(frozen=True)
class _RankedSweep:
    """A sweep by several ranks.

    broadcasts: of the compliance, one for each rank that prepares a position.
    """

    model: GearModel
    pitch: Pitch
    frictions: Sequence[float]
    comm: MPI.Comm
    cores: Cores
    broadcasts: tuple[SharedBroadcast, ...]

    def swept(self, state: SweepState, begin: int) -> Iterator[SweptPosition]:
        """All positions from number `begin` on."""
        while begin < len(self.pitch.angles):
            numbers = range(begin, min(begin + PREPARING, len(self.pitch.angles)))
            mine = together(self.comm, partial(self._prepared, numbers, state), self.cores.lent)
            prepared = [self._broadcast(mine, root) for root in range(len(numbers))]
            del mine  # its compliance is in the shared memory
            solved = together(self.comm, partial(self._solved, numbers, state, prepared), self.cores.lent)
            parts = [part for part in self.comm.allgather(solved) if part]
            for position in map(joined, zip(*parts, strict=True)):
                state = position.state
                yield position
            begin = numbers.stop

    def _prepared(self, numbers: range, state: SweepState) -> SharedPosition | None:
        """The position that this rank prepares; None where it has none to prepare, or finds no solution."""
        if self.comm.rank >= len(numbers):
            return None
        angle = self.pitch.angles[numbers[self.comm.rank]]
        try:
            return shared_position(self.model, angle, state.extra, self.frictions, state.patch, self.cores.used)
        except (NotConverged, SearchError):  # smaller steps may lead there
            return None

    def _solved(
        self, numbers: range, state: SweepState, prepared: list[SharedPosition | None]
    ) -> list[SweptPosition]:
        """These positions with the friction coefficients of this rank, none if it has none. prepared: the positions
        without friction, None where there was no solution: then each rank searches by itself."""
        own = division(len(self.frictions), self.comm.size)[self.comm.rank]
        mine, swept = replace(state, histories=state.histories[own]), []
        for k, common in zip(numbers, prepared) if self.frictions[own] else ():
            swept.append(next(sweep_pitch(self.model, self.pitch, self.frictions[own], mine, k, common)))
            mine = swept[-1].state
        return swept

    def _broadcast(self, prepared: SharedPosition | None, root: int) -> SharedPosition | None:
        """Rank `root`'s position on all ranks: without the gears, which all have, its compliance in shared memory."""
        bare, matrix = None, None
        if prepared is not None:
            matrix = prepared.system.compliance
            system = replace(prepared.system, compliance=matrix[:0])
            bare = replace(prepared, contact=prepared.contact.without_bodies(), system=system)
        received = self.comm.bcast(bare, root)
        if received is None:
            return None
        system = replace(received.system, compliance=self.broadcasts[root].send(matrix))
        return replace(received, contact=received.contact.with_bodies(self.model.bodies), system=system)
