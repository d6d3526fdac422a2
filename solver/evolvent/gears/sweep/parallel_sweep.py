"""A pitch of gear positions on several ranks: two prepare a position each, then all solve friction.

Search, compliance and the frictionless equilibrium are most of a position and ask for nothing that friction made of the
one before, and where their search starts makes no difference. Friction follows position by position, the coefficients
divided among the ranks, which read what was prepared from the same memory.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

from mpi4py import MPI

from evolvent.contact.newton.snes import NotConverged
from evolvent.fem.parallel.cores import Cores
from evolvent.fem.parallel.ranks import SharedBroadcast, together
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.pitch_sweep import Pitch, SweepState, SweptPosition, joined, sweep_pitch
from evolvent.gears.sweep.position import SharedPosition, shared_position

PREPARING = 2  # ranks: from further away a search takes longer


def sweep_on_ranks(
    model: GearModel, pitch: Pitch, frictions: Sequence[float], state: SweepState, comm: MPI.Comm, begin: int = 0
) -> Generator[SweptPosition, None, None]:
    """`sweep_pitch`, the work divided; all ranks get all results. Raises NotConverged on all ranks, which must close it
    together where they leave it early."""
    if comm.size == 1:
        yield from sweep_pitch(model, pitch, frictions, state, begin)
        return
    boards = tuple(SharedBroadcast(comm, root) for root in range(PREPARING))
    # not closed where something failed: who is alone with it would wait for the others
    with suppress(GeneratorExit):
        yield from _Crew(model, pitch, frictions, comm, Cores(comm), boards).swept(state, begin)
    for board in boards:
        board.close()


def at_once(comm: MPI.Comm) -> int:
    """How many positions are solved before the first of them is handed out."""
    return min(comm.size, PREPARING)


def division(count: int, ranks: int) -> list[slice]:
    """Which of `count` friction coefficients each rank solves: neighbours together, as one helps to solve the next, and
    of the small ones more, as these take fewer iterations."""
    ends = [-(-count * rank // ranks) for rank in range(ranks + 1)]
    return [slice(a, b) for a, b in pairwise(ends)]


@dataclass(frozen=True)
class _Crew:
    """Several ranks at work on a pitch."""

    model: GearModel
    pitch: Pitch
    frictions: Sequence[float]
    comm: MPI.Comm
    cores: Cores
    boards: tuple[SharedBroadcast, ...]

    def swept(self, state: SweepState, begin: int) -> Iterator[SweptPosition]:
        """All positions from number `begin` on."""
        while begin < len(self.pitch.angles):
            numbers = range(begin, min(begin + PREPARING, len(self.pitch.angles)))
            own = together(self.comm, partial(self._prepared, numbers, state), self.cores.lent)
            prepared = [self._handed_over(own, root) for root in range(len(numbers))]
            del own  # a compliance that was handed over is not needed twice
            mine = together(self.comm, partial(self._solved, numbers, state, prepared), self.cores.lent)
            parts = [part for part in self.comm.allgather(mine) if part]
            for position in map(joined, zip(*parts, strict=True)):
                state = position.state
                yield position
            begin = numbers.stop

    def _prepared(self, numbers: range, state: SweepState) -> SharedPosition | None:
        """What all need of the position that this rank prepares; None if it has none, and where it is not found."""
        if self.comm.rank >= len(numbers):
            return None
        angle = self.pitch.angles[numbers[self.comm.rank]]
        try:
            return shared_position(self.model, angle, state.extra, self.frictions, state.footprint, self.cores.used)
        except NotConverged:  # smaller steps may lead there
            return None

    def _solved(
        self, numbers: range, state: SweepState, prepared: list[SharedPosition | None]
    ) -> list[SweptPosition]:
        """These positions with this rank's own friction coefficients, none if it has none. prepared: what all need of
        them, None where that was not found: then each rank goes there by itself."""
        own = division(len(self.frictions), self.comm.size)[self.comm.rank]
        mine, swept = replace(state, memories=state.memories[own]), []
        for k, common in zip(numbers, prepared) if self.frictions[own] else ():
            swept.append(next(sweep_pitch(self.model, self.pitch, self.frictions[own], mine, k, common)))
            mine = swept[-1].state
        return swept

    def _handed_over(self, prepared: SharedPosition | None, root: int) -> SharedPosition | None:
        """Rank `root`'s on all ranks: the gears, which all have, stay where they are, the compliance is shared."""
        bare, matrix = None, None
        if prepared is not None:
            contact = replace(prepared.contact, bodies=())
            matrix = prepared.system.compliance
            bare = replace(prepared, contact=contact, system=replace(prepared.system, compliance=matrix[:0]))
        found = self.comm.bcast(bare, root)
        if found is None:
            return None
        compliance = self.boards[root].send(matrix)
        system = replace(found.system, compliance=compliance)
        return replace(found, contact=replace(found.contact, bodies=self.model.bodies), system=system)
