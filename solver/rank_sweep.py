"""A pitch of gear positions on several ranks: rank 0 works a position ahead, the others solve with friction.

Search, compliance and the frictionless equilibrium of a position depend on the frictionless one before, not on what
friction made of it. So rank 0 prepares position k + 1 while the others solve the friction coefficients of position k,
of which it takes few itself, if any; all ranks read what it prepared from the same memory.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

from mpi4py import MPI

from solver.cores import Cores
from solver.gear_model import GearModel
from solver.gear_position import SharedPosition, shared_position
from solver.gear_sweep import Pitch, SweepState, SweptPosition, sweep_pitch
from solver.newton import NotConverged
from solver.parallel import shared, together

AHEAD = 8
"""What preparing a position costs in friction coefficients: 0.9 s to 0.11 s in a helical pair of 246,000 dofs."""


def sweep_on_ranks(
    model: GearModel, pitch: Pitch, frictions: Sequence[float], state: SweepState, comm: MPI.Comm, begin: int = 0
) -> Iterator[SweptPosition]:
    """`sweep_pitch`, the work divided; all ranks get all results. Raises NotConverged on all ranks."""
    if comm.size == 1:
        return sweep_pitch(model, pitch, frictions, state, begin)
    return _Crew(model, pitch, frictions, comm, Cores(comm)).swept(state, begin)


def division(count: int, ranks: int) -> list[slice]:
    """Which of `count` friction coefficients each rank solves: neighbours together, as one helps to solve the next."""
    if ranks == 1:
        return [slice(0, count)]
    first = max(0, round((count + AHEAD) / ranks - AHEAD))
    ends = [first + (count - first) * rank // (ranks - 1) for rank in range(ranks)]
    return [slice(0, first), *(slice(a, b) for a, b in pairwise(ends))]


@dataclass(frozen=True)
class _Crew:
    """Several ranks at work on a pitch."""

    model: GearModel
    pitch: Pitch
    frictions: Sequence[float]
    comm: MPI.Comm
    cores: Cores

    def swept(self, state: SweepState, begin: int) -> Iterator[SweptPosition]:
        """All positions from number `begin` on."""
        common = self._handed_over(together(self.comm, partial(self._ahead, begin, state), self.cores.lent))
        for k in range(begin, len(self.pitch.angles)):
            position, following = together(self.comm, partial(self._work, k, state, common), self.cores.lent)
            parts = [part for part in self.comm.allgather(position) if part is not None]
            common = self._handed_over(following)
            memories = tuple(memory for part in parts for memory in part.state.memories)
            results = tuple(result for part in parts for result in part.results)
            state = replace(parts[0].state, memories=memories)
            yield replace(parts[0], results=results, state=state)

    def _work(
        self, k: int, state: SweepState, common: SharedPosition | None
    ) -> tuple[SweptPosition | None, SharedPosition | None]:
        """This rank's own friction coefficients of position k, None if it has none, and on rank 0 what all need of the
        next one. common: what they need of this one, None if it was not found: then each rank goes there by itself."""
        own, position, following = division(len(self.frictions), self.comm.size)[self.comm.rank], None, None
        if self.frictions[own]:
            mine = replace(state, memories=state.memories[own])
            position = next(sweep_pitch(self.model, self.pitch, self.frictions[own], mine, k, common))
        if common is not None:
            after = replace(state, extra=common.contact.stand.extra, footprint=common.footprint)
            following = self._ahead(k + 1, after)
        return position, following

    def _ahead(self, k: int, state: SweepState) -> SharedPosition | None:
        """What all need of position k, on rank 0; None on others, at the end, and where it is not found."""
        if self.comm.rank > 0 or k == len(self.pitch.angles):
            return None
        angle = self.pitch.angles[k]
        try:
            return shared_position(self.model, angle, state.extra, self.frictions, state.footprint, self.cores.used)
        except NotConverged:  # smaller steps may lead there
            return None

    def _handed_over(self, prepared: SharedPosition | None) -> SharedPosition | None:
        """Rank 0's on all ranks: the gears, which all have, stay where they are, the compliance is in one memory."""
        bare, matrix = None, None
        if prepared is not None:
            contact = replace(prepared.contact, bodies=())
            matrix = prepared.system.compliance
            bare = replace(prepared, contact=contact, system=replace(prepared.system, compliance=matrix[:0]))
        found = self.comm.bcast(bare)
        compliance = shared(self.comm, matrix, 0)
        if found is None:
            return None
        system = replace(found.system, compliance=compliance)
        return replace(found, contact=replace(found.contact, bodies=self.model.bodies), system=system)
