"""A long block of wear of a gear pair: the rate of its end, linear in the depths that it takes away.

Δh = ΔN r(λ + ∂λ), ∂λ = R(Δh) at every position. Points that would pull at the end leave the contact: they lose their
pressure, the others take it over, until none pulls.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy.sparse as sp
from mpi4py import MPI
from scipy.sparse.linalg import LinearOperator, gmres

from meshes.data import Floats, Ints
from solver.equilibrium import CondensedSystem, Equilibrium, normal_part
from solver.gear_position import ContactPoints, SharedPosition, contact_points
from solver.newton import NotConverged
from solver.newton_steps import RELATIVE
from solver.parallel import together
from solver.pressure_response import PressureResponse

KRYLOV = 1e-6  # of the right-hand side may be left of a block's equations
LEAVINGS = 6  # times at most points are let go that would pull at a block's end
PULL = 1e-3  # of the largest pressure: less is left to the next block


class Response:
    """How the pressures at a position's p pressed points follow when the gap opens there: ∂λ = `released` + R ∂g.

    points: those. leaving: (p,) bool, which of them lose their pressure; that is what `released` follows.
    """

    def __init__(self, normal: CondensedSystem, state: Equilibrium, points: ContactPoints, leaving: np.ndarray) -> None:
        """About a state of a frictionless system."""
        self._normal, self._state, self.points, self.leaving = normal, state, points, leaving
        self._pressed = np.flatnonzero(state.traction[:, 0] > 0.0)
        self._whole = PressureResponse(normal, state, self._everywhere(leaving))
        self.released = self._whole.released[self._pressed]

    @staticmethod
    def of(shared: SharedPosition) -> Response:
        """Of a position's frictionless state, in which all pressed points stay."""
        points = contact_points(shared.contact, shared.smooth.traction, 0.0)
        return Response(normal_part(shared.system), shared.smooth, points, np.zeros(len(points.weights), dtype=bool))

    def __call__(self, opening: Floats) -> Floats:
        """R ∂g (p,) [MPa] of ∂g (p,) [mm]."""
        return self._whole(self._everywhere(opening))[self._pressed]

    def without(self, pulled: np.ndarray) -> Response:
        """The same when those of the p points leave the contact as well."""
        if not pulled.any():
            return self
        return Response(self._normal, self._state, self.points, self.leaving | pulled)

    def _everywhere(self, values: Floats | np.ndarray) -> np.ndarray:
        """(q,) of values (p,) at the pressed points, nothing elsewhere."""
        whole = np.zeros(len(self._state.traction), dtype=values.dtype)
        whole[self._pressed] = values
        return whole


@dataclass(frozen=True)
class LinearBlock:
    """right: ΔN r (n,) [mm] at the block's start. pressure: λ (q,) [MPa] of this rank's points there; openings: per
    position, (p, n) by how much depths open the gap at its points. worn: depths (n,) that pressures (q,) wear off in
    the block, over all ranks."""

    right: Floats
    pressure: Floats
    openings: Sequence[sp.csr_matrix]
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

    def _linear(self, responses: Sequence[Response], start: Floats) -> tuple[Floats, Floats]:
        """Δh (n,) with this contact, and ∂λ (q,) of this rank. Raises NotConverged."""

        def follow(h: Floats) -> Floats:
            return np.concatenate([r(opened @ h) for r, opened in zip(responses, self.openings)] or [np.zeros(0)])

        def slope(h: Floats) -> Floats:
            return h - self.worn(follow(h))

        released = np.concatenate([r.released for r in responses] or [np.zeros(0)])
        size, known = 2 * (len(self.right),), self.right + self.worn(released)
        found, failed = gmres(LinearOperator(size, slope), known, x0=start, atol=0.0, **{RELATIVE: KRYLOV})
        if failed:
            raise NotConverged("a block of wear: its equations were not solved; take a shorter one")
        return found, released + follow(found)


def _ends(responses: Sequence[Response]) -> Ints:
    """Where the points of each but the last end in the list of all."""
    return np.cumsum([len(r.leaving) for r in responses])[:-1]


def _without(responses: Sequence[Response], pulled: Sequence[np.ndarray]) -> list[Response]:
    """The same when the points that pull have left the contact."""
    return [response.without(own) for response, own in zip(responses, pulled)]
