"""A pitch of gear positions on several ranks: two prepare a position each, then all solve friction.

Search, compliance and the frictionless equilibrium are most of a position. They do not depend on the friction of the
position before, and where their search starts makes no difference. Friction follows position by position, the
coefficients divided among the ranks, which read the prepared positions from the same memory. A single coefficient
cannot be divided: there one rank prepares the next positions while another solves friction at this one.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import closing, nullcontext, suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise, repeat
from typing import cast

from mpi4py import MPI

from evolvent.contact.newton.applied_compliance import AppliedCompliance
from evolvent.contact.newton.block_inverse import NearlyNormal
from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.contact.newton.jump_compliance import JumpCompliance
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.fem.parallel.background import computed_ahead
from evolvent.fem.parallel.cores import Cores
from evolvent.fem.parallel.ranks import SharedBroadcast, together
from evolvent.gears.contact.overlap_check import UnsearchedOverlap
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.pitch_sweep import NONE_KNOWN, Pitch, SweepState, SweptPosition, joined, sweep_pitch
from evolvent.gears.sweep.position_search import (
    KnownSolution,
    SharedPosition,
    course_after,
    shared_position,
    without_overlaps,
)

PREPARING = 2  # ranks: from further away a search takes longer
AHEAD, AHEAD_AGAIN = 2, 1
"""Positions that are prepared before friction is solved at them; the fewer where a pitch that is solved again may close
at any position. Positions take one and a half times as long where a search is repeated, or where friction turns."""


def sweep_on_ranks(
    model: GearModel, pitch: Pitch, frictions: Sequence[float], state: SweepState, comm: MPI.Comm, begin: int = 0,
    known: Mapping[int, KnownSolution] = NONE_KNOWN,
) -> Generator[SweptPosition, None, None]:
    """Sweep of a pitch as by `sweep_pitch`, the work divided; all ranks get all results. Raises NotConverged on all
    ranks, which must close it together where they leave it early."""
    if comm.size == 1:
        yield from sweep_pitch(model, pitch, frictions, state, begin, known=known)
        return
    broadcasts = tuple(SharedBroadcast(comm, root) for root in range(PREPARING))
    sweep = _RankedSweep(model, pitch, frictions, known, comm, Cores(comm), broadcasts)
    single = len(frictions) == 1 and model.has_friction_terms(frictions[0])
    # not closed where something failed: a rank alone with the failure would wait for the others
    with suppress(GeneratorExit):
        yield from sweep.ahead(state, begin) if single else sweep.swept(state, begin)
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

    known: number of a position -> how it was solved before.
    broadcasts: of the compliance, one for each rank that prepares a position.
    """

    model: GearModel
    pitch: Pitch
    frictions: Sequence[float]
    known: Mapping[int, KnownSolution]
    comm: MPI.Comm
    cores: Cores
    broadcasts: tuple[SharedBroadcast, ...]

    def swept(self, state: SweepState, begin: int) -> Iterator[SweptPosition]:
        """All positions from number `begin` on."""
        while begin < len(self.pitch.angles):
            numbers = range(begin, min(begin + PREPARING, len(self.pitch.angles)))
            mine = together(self.comm, partial(self._prepared, numbers, state), self.cores.lent)
            prepared = [self._sent(mine, root) for root in range(len(numbers))]
            del mine  # its compliance is in the shared memory
            solved = together(self.comm, partial(self._solved, numbers, state, prepared), self.cores.lent)
            parts = [part for part in self.comm.allgather(solved) if part]
            for position in map(joined, zip(*parts, strict=True)):
                state = position.state
                yield position
            begin = numbers.stop

    def ahead(self, state: SweepState, begin: int) -> Iterator[SweptPosition]:
        """All positions from number `begin` on, for one friction coefficient. Rank 1 prepares them in the background;
        rank 0, which has less to do, looks for contact outside the window of what is prepared, and solves friction."""
        numbers, prepares = range(begin, len(self.pitch.angles)), self.comm.rank == 1
        own = self._in_turn(numbers, state) if prepares else repeat(None)
        waiting = nullcontext if prepares else self.cores.lent  # the core of rank 1 is in use while it waits
        count = AHEAD_AGAIN if self.known else AHEAD
        with closing(computed_ahead(own, count)) if prepares else nullcontext(own) as source:
            for k in numbers:
                prepared = self._sent(together(self.comm, partial(next, source), waiting), 1)
                solved = together(self.comm, partial(self._with_friction, k, state, prepared), waiting)
                solved = self.comm.bcast(solved, 0)
                assert solved is not None
                state = solved.state
                yield solved

    def _in_turn(self, numbers: range, place: SweepState) -> Iterator[SharedPosition | None]:
        """Positions `numbers` prepared one after the other, each search started where the one before has led; None
        where there is no solution."""
        for k in numbers:
            prepared = self._without_friction(k, place, overlaps=False)
            if prepared is not None:
                course = course_after(self.model, prepared, place.course)
                found = prepared.contact.stand.beyond_nominal
                place = replace(place, beyond_nominal=found, patch=prepared.patch, course=course)
            yield prepared

    def _with_friction(self, k: int, state: SweepState, prepared: _SentPosition | None) -> SweptPosition | None:
        """Position k with friction, on rank 0."""
        if self.comm.rank != 0:
            return None
        common = None if prepared is None else self._accepted(prepared.received(self.model))
        return next(sweep_pitch(self.model, self.pitch, self.frictions, state, k, common, self.known))

    def _accepted(self, prepared: SharedPosition) -> SharedPosition | None:
        """A position prepared without a look outside its window; None where there is contact: then it is searched
        anew."""
        try:
            return without_overlaps(self.model, prepared)
        except SearchError:
            return None

    def _prepared(self, numbers: range, state: SweepState) -> SharedPosition | None:
        """The position that this rank prepares; None where it has none to prepare, or finds no solution."""
        if self.comm.rank >= len(numbers):
            return None
        return self._without_friction(numbers[self.comm.rank], state)

    def _without_friction(self, number: int, state: SweepState, overlaps: bool = True) -> SharedPosition | None:
        try:
            angle, threads = self.pitch.angles[number], self.cores.used
            known = self.known.get(number)
            predicted = state.predicted(angle)
            return shared_position(
                self.model, angle, predicted, self.frictions, state.patch, threads, known, overlaps=overlaps
            )
        except (NotConverged, SearchError):  # smaller steps may lead there
            return None

    def _solved(
        self, numbers: range, state: SweepState, prepared: list[_SentPosition | None]
    ) -> list[SweptPosition]:
        """Positions `numbers` solved with the friction coefficients of this rank, none if it has none. prepared: the
        positions without friction, None where there was no solution: then each rank searches by itself."""
        own = division(len(self.frictions), self.comm.size)[self.comm.rank]
        mine, swept = replace(state, histories=state.histories[own]), []
        for k, sent in zip(numbers, prepared) if self.frictions[own] else ():
            common = None if sent is None else sent.received(self.model)
            swept.append(next(sweep_pitch(self.model, self.pitch, self.frictions[own], mine, k, common, self.known)))
            mine = swept[-1].state
        return swept

    def _sent(self, prepared: SharedPosition | None, root: int) -> _SentPosition | None:
        """Position prepared by rank `root`, on all ranks. Its compliance goes through shared memory, or as its
        approximate matrix where all ranks can apply the compliance itself."""
        bare: tuple[GearContact, Equilibrium, tuple[UnsearchedOverlap, ...]] | None = None
        large: NearlyNormal | JumpCompliance | None = None
        if prepared is not None:
            bare = prepared.contact.without_bodies(), prepared.smooth, prepared.unsearched
            large = prepared.system.compliance
            large = large.rough if isinstance(large, AppliedCompliance) else large
        received = self.comm.bcast(bare, root)
        if received is None:
            return None
        contact, smooth, unsearched = received
        sent = cast("NearlyNormal | JumpCompliance | None", self.broadcasts[root].send(large))
        assert sent is not None
        return _SentPosition(contact, smooth, unsearched, sent)


@dataclass(frozen=True)
class _SentPosition:
    """A prepared position on its way between ranks, without the gears, which all have.

    contact, smooth, unsearched: of the `SharedPosition`.
    compliance: of its system, or the approximate matrix of that; valid until the next one is sent.
    """

    contact: GearContact
    smooth: Equilibrium
    unsearched: tuple[UnsearchedOverlap, ...]
    compliance: NearlyNormal | JumpCompliance

    def received(self, model: GearModel) -> SharedPosition:
        """The position with its gears."""
        contact, load, compliance = self.contact.with_bodies(model.bodies), model.load, self.compliance
        if isinstance(compliance, NearlyNormal):
            compliance = contact.geometry.compliance(compliance.k, rough=compliance)
        system = contact.system_with(compliance, load.on, load.at(contact.stand.angle))
        return SharedPosition(contact, system, self.smooth, self.unsearched)
