"""A long block of wear of a gear pair: the rate of its end, linear in the depths that it takes away.

Δh = ΔN r(λ + ∂λ), ∂λ = R(Δh) at every position. Points that would pull at the end leave the contact: they lose their
pressure, the others take it over, until none pulls.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
import scipy.sparse as sp
from mpi4py import MPI
from scipy.sparse.linalg import LinearOperator, gmres

from evolvent.contact.newton.equilibrium import CondensedSystem, Equilibrium, normal_part
from evolvent.contact.newton.newton_steps import RELATIVE
from evolvent.contact.newton.pressure_sensitivity import PressureResponse
from evolvent.contact.newton.snes import NotConverged
from evolvent.fem.parallel.ranks import together
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.sweep.position import SharedPosition
from evolvent_meshes.arrays import Floats, Ints

KRYLOV = 1e-6  # of the right-hand side may be left of a block's equations
LEAVINGS = 6  # times at most points are let go that would pull at a block's end
SMALL = 200  # points of a position at most, whose response is then kept as a matrix
PULL = 1e-3  # of the largest pressure: less is left to the next block


class Response:
    """How the pressures at a position's p pressed points follow when the gap opens there: ∂λ = `released` + R ∂g.

    points: those. leaving: (p,) bool, which of them lose their pressure; that is what `released` follows.
    """

    def __init__(
        self, normal: CondensedSystem, state: Equilibrium, points: ContactPoints, leaving: np.ndarray,
        staying: Response | None = None,
    ) -> None:  # fmt: skip
        """About a state of a frictionless system. staying: the response in which all points stay, where the matrix is
        to follow from its matrix."""
        self._normal, self._state, self.points, self.leaving = normal, state, points, leaving
        self._pressed, self._staying = np.flatnonzero(state.traction[:, 0] > 0.0), staying

    @staticmethod
    def of(shared: SharedPosition, points: ContactPoints) -> Response:
        """Of a position's frictionless state, in which all its pressed points stay. Raises NotConverged."""
        none = np.zeros(len(points.weights), dtype=bool)
        return Response(normal_part(shared.system), shared.smooth, points, none)._ready()

    def __call__(self, opening: Floats) -> Floats:
        """R ∂g (p,) or (p, c) [MPa] of ∂g (p,) or (p, c) [mm]."""
        return self._whole(self.everywhere(opening))[self._pressed]

    def _ready(self) -> Response:
        """With all that may fail done: a rank that fails later would fail alone."""
        _ = self.released, self.matrix if self.few else None
        return self

    @cached_property
    def _whole(self) -> PressureResponse:
        return PressureResponse(self._normal, self._state, self.everywhere(self.leaving))

    @cached_property
    def matrix(self) -> Floats:
        """R (p, p) [MPa/mm]."""
        if self._staying is None:
            return self(np.eye(len(self.leaving)))
        R = self._staying.matrix
        return R + self._held(-R[self.leaving])

    @cached_property
    def released(self) -> Floats:
        """(p,) [MPa]."""
        if self._staying is None:
            return self._whole.released[self._pressed]
        return self._held(-self.points.pressure[self.leaving])

    def _held(self, change: Floats) -> Floats:
        """∂λ (p, ...) when the leaving points' pressures change so: by openings there, R_LL ∂g = change."""
        assert self._staying is not None
        R, left = self._staying.matrix, self.leaving
        if left.all():
            raise NotConverged("a block of wear: all points of a position would pull; take a shorter one")
        try:
            return np.asarray(R[:, left] @ np.linalg.solve(R[np.ix_(left, left)], change))
        except np.linalg.LinAlgError as error:
            raise NotConverged(f"a block of wear: points cannot leave ({error}); take a shorter one") from error

    def without(self, pulled: np.ndarray) -> Response:
        """The same when those of the p points leave the contact as well. Raises NotConverged."""
        if not pulled.any():
            return self
        staying = (self._staying or self) if self.few else None
        return Response(self._normal, self._state, self.points, self.leaving | pulled, staying)._ready()

    @property
    def few(self) -> bool:
        """Whether its matrix is worth having."""
        return len(self.leaving) <= SMALL

    def everywhere(self, values: Floats | np.ndarray) -> np.ndarray:
        """(q, ...) of values (p, ...) at the pressed points, nothing elsewhere."""
        whole = np.zeros((len(self._state.traction), *values.shape[1:]), dtype=values.dtype)
        whole[self._pressed] = values
        return whole


@dataclass(frozen=True)
class LinearBlock:
    """right: ΔN r (n,) [mm] at the block's start. pressure: λ (q,) [MPa] of this rank's points there; openings:
    (q, n) by how much depths open the gap there. worn: depths (n,) that pressures (q,) wear off in
    the block, over all ranks."""

    right: Floats
    pressure: Floats
    openings: sp.csr_matrix
    worn: Callable[[Floats], Floats]

    def solved(self, responses: Sequence[Response], comm: MPI.Comm) -> tuple[Floats, Floats]:
        """Δh (n,), and ∂λ (q,) of this rank, with no pressure below zero at the end: from these ∂λ once more, so that
        the depths are to rounding what they wear off. Raises NotConverged."""
        depth, more = self.right, np.zeros_like(self.pressure)
        for _ in range(LEAVINGS):
            depth, more = self._linear(responses, depth)
            pulled = np.split(self.pressure + more < -PULL * self.pressure.max(initial=0.0), _ends(responses))
            if not comm.allreduce(sum(int(own.sum()) for own in pulled)):
                break
            responses = together(comm, partial(_without, responses, pulled))
        more = np.maximum(more, -self.pressure)
        return self.right + self.worn(more), more

    def pressed(self, responses: Sequence[Response], more: Floats) -> list[np.ndarray]:
        """(q,) bool of each position: the points that still press at the block's end."""
        ends = np.split(self.pressure + more > 0.0, _ends(responses))
        return [response.everywhere(own) for response, own in zip(responses, ends)]

    def _linear(self, responses: Sequence[Response], start: Floats) -> tuple[Floats, Floats]:
        """Δh (n,) with this contact, and ∂λ (q,) of this rank. Raises NotConverged."""
        responded = _joined(responses)

        def follow(h: Floats) -> Floats:
            return responded(self.openings @ h)

        def slope(h: Floats) -> Floats:
            return h - self.worn(follow(h))

        released = np.concatenate([r.released for r in responses] or [np.zeros(0)])
        size, known = 2 * (len(self.right),), self.right + self.worn(released)
        found, failed = gmres(LinearOperator(size, slope), known, x0=start, atol=0.0, **{RELATIVE: KRYLOV})
        if failed:
            raise NotConverged("a block of wear: its equations were not solved; take a shorter one")
        return found, released + follow(found)


def _joined(responses: Sequence[Response]) -> Callable[[Floats], Floats]:
    """R of all positions, (q,) of (q,). Where they are small as one sparse matrix: forty small products take longer to
    be called than to be made."""
    if responses and all(r.few for r in responses):
        whole = sp.block_diag([r.matrix for r in responses], format="csr")
        return lambda opening: np.asarray(whole @ opening)
    ends = _ends(responses)
    return lambda opening: np.concatenate([r(own) for r, own in zip(responses, np.split(opening, ends))] or [opening])


def _ends(responses: Sequence[Response]) -> Ints:
    """Where the points of each but the last end in the list of all."""
    return np.cumsum([len(r.leaving) for r in responses])[:-1]


def _without(responses: Sequence[Response], pulled: Sequence[np.ndarray]) -> list[Response]:
    """The same when the points that pull have left the contact."""
    return [response.without(own) for response, own in zip(responses, pulled)]
