"""A pitch that is a result: swept until friction is periodic, certified, on deflected flanks where it has to be.

Flanks before deflection are quicker to search, and nearly always good enough. Where the energy of a pitch does not
balance on them (`certificates.certify_pitch`), the whole pitch is solved again on deflected flanks, with the same
condensed gears. It is then the pitch of a problem that asks for deflected flanks, and refused where it still loses
energy.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from mpi4py import MPI

from evolvent.gears.gear_model import GearModel
from evolvent.gears.solution.certificates import PitchImbalance, certify, certify_pitch
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import Pitch, SweptPosition, initial_state
from evolvent.gears.sweep.position_result import PositionResult

LOG = logging.getLogger("evolvent")
ON_DEFLECTED = "The pitch was solved on deflected flanks: before deflection its energy does not balance."
"""Sentence printed where deflected flanks were not asked for."""
T = TypeVar("T")
Observer = Callable[[SweptPosition], object]
"""Function called with each position once it is certified: it archives the position, or shows progress."""


@dataclass(frozen=True, eq=False)
class CertifiedPitch:
    """The positions of a pitch, on all ranks."""

    positions: tuple[SweptPosition, ...]
    """Positions in the order of their angles, each as it was solved last at each friction coefficient."""
    deflected: bool
    """Whether contact was searched again on deflected flanks."""

    @property
    def by_friction(self) -> list[tuple[PositionResult, ...]]:
        """Results of all positions at each friction coefficient."""
        return list(zip(*(position.results for position in self.positions), strict=True))


def certified_pitch(
    gears: GearModel, pitch: Pitch, frictions: Sequence[float], comm: MPI.Comm, observe: Observer = lambda _: None
) -> CertifiedPitch:
    """Solves a pitch of condensed gears. Collective.

    pitch: whole angular pitches in equal steps.
    observe: see `Observer`; after a pitch that does not balance it sees all positions again.

    Raises NotConverged, SearchError, BalanceError, on all ranks.
    """

    def swept(deflected: bool) -> Iterable[SweptPosition]:
        model = replace(gears, deflected=deflected)
        return sweep_until_periodic(model, pitch, frictions, initial_state(frictions), comm)

    return certified(swept, gears.deflected, observe)


def certified(
    swept: Callable[[bool], Iterable[SweptPosition]], deflected: bool, observe: Observer
) -> CertifiedPitch:
    """A pitch that is certified, however it is swept.

    swept: all positions of a `sweep_until_periodic`, on deflected flanks or not.
    deflected: whether the first sweep is on deflected flanks; there is no second one then.

    Raises what `swept` does, and BalanceError.
    """

    def solved(deflected: bool) -> CertifiedPitch:
        found: list[SweptPosition] = []
        for position in swept(deflected):
            certify(position.results)
            observe(position)
            found.append(position)
        positions = one_pitch(found)
        certify_pitch(position.results for position in positions)
        return CertifiedPitch(tuple(positions), deflected)

    return balanced(solved, deflected)


def balanced(solve: Callable[[bool], T], deflected: bool) -> T:
    """Result of `solve`, repeated on deflected flanks where it raises PitchImbalance without. deflected: whether the
    first solution is on deflected flanks; there is no second one then."""
    try:
        return solve(deflected)
    except PitchImbalance as imbalance:
        if deflected:
            raise
        LOG.info("%s; solved again, on deflected flanks", imbalance)
    return solve(True)
