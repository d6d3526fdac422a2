"""An implicit block of a gear pair's wear: the rate at its end, linearised in the depths that it wears off.

Δh = ΔN r(λ + ∂λ), ∂λ = R(Δh) at every position. Points whose pressure would be negative at the block's end leave the
contact, and the others take over their load, until no pressure is negative.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from inspect import signature
from typing import Any

import numpy as np
import scipy.sparse as sp
from mpi4py import MPI
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, gmres

from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.equilibrium import Equilibrium, normal_part
from evolvent.contact.newton.pressure_sensitivity import PressureSensitivity
from evolvent.contact.newton.snes import NotConverged
from evolvent.fem.parallel.ranks import together
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.sweep.position_search import SharedPosition
from evolvent_meshes.arrays import Bools, Floats, Ints

RELATIVE = "rtol" if "rtol" in signature(gmres).parameters else "tol"  # SciPy's name of the argument until 1.11
GMRES_TOLERANCE = 1e-6  # residual of a block's equations over their right-hand side
MAX_SEPARATIONS = 6  # rounds in which points with a negative pressure leave the contact
SMALL = 200  # pressed points of a position up to which its response is stored as a matrix
NEGATIVE_PRESSURE = 1e-3  # of the largest pressure: smaller negative pressures are cut off


class PositionResponse:
    """Linear response of the pressures at a position's p pressed points to an opening of their gaps, ∂λ =
    `separation` + R ∂g.

    points: the pressed points.
    separating: (p,) which of them leave the contact; `separation` is the response to the loss of their pressure.
    """

    def __init__(
        self, normal: CondensedSystem, state: Equilibrium, points: ContactPoints, separating: Bools,
        full: PositionResponse | None = None,
    ) -> None:
        """Response about a state of a frictionless system. full: the response in which no point separates, from whose
        matrix this one's is computed; None: from the system."""
        self._normal, self._state, self.points, self.separating = normal, state, points, separating
        self._pressed, self._full = np.flatnonzero(state.traction[:, 0] > 0.0), full

    @staticmethod
    def of(shared: SharedPosition, points: ContactPoints) -> PositionResponse:
        """The response of a position's frictionless state in which no point separates. Raises NotConverged."""
        none = np.zeros(len(points.weights), dtype=bool)
        return PositionResponse(normal_part(shared.system), shared.smooth, points, none)._factored()

    def __call__(self, opening: Floats) -> Floats:
        """R ∂g (p,) or (p, c) [MPa] of openings ∂g (p,) or (p, c) [mm]."""
        return self._at_all_points(self.at_all_points(opening))[self._pressed]

    def _factored(self) -> PositionResponse:
        """The response, with all its parts computed that may fail, so that all ranks fail together."""
        _ = self.separation, self.matrix if self.is_small else None
        return self

    @cached_property
    def _at_all_points(self) -> PressureSensitivity:
        return PressureSensitivity(self._normal, self._state, self.at_all_points(self.separating))

    @cached_property
    def matrix(self) -> Floats:
        """Matrix R (p, p) of the pressure response [MPa/mm]."""
        if self._full is None:
            return self(np.eye(len(self.separating)))
        R = self._full.matrix
        return R + self._to_pressures(-R[self.separating])

    @cached_property
    def separation(self) -> Floats:
        """Response (p,) [MPa] to the loss of the separating points' pressure."""
        if self._full is None:
            return self._at_all_points.released[self._pressed]
        return self._to_pressures(-self.points.pressure[self.separating])

    def _to_pressures(self, change: Floats) -> Floats:
        """Response ∂λ (p, ...) to given changes of the separating points' pressures S, by openings R_SS ∂g = change.

        Raises NotConverged.
        """
        assert self._full is not None
        R, separating = self._full.matrix, self.separating
        if separating.all():
            raise NotConverged(
                "wear block: wanted pressures above zero at each position of its end, found none; take a shorter one"
            )
        try:
            return np.asarray(R[:, separating] @ np.linalg.solve(R[np.ix_(separating, separating)], change))
        except np.linalg.LinAlgError as error:
            raise NotConverged(
                f"wear block: wanted the response to points that leave the contact, found {error}; take a shorter one"
            ) from error

    def without(self, pulling: Bools) -> PositionResponse:
        """The response when more of the p points leave the contact. Raises NotConverged."""
        if not pulling.any():
            return self
        full = (self._full or self) if self.is_small else None
        return PositionResponse(self._normal, self._state, self.points, self.separating | pulling, full)._factored()

    @property
    def is_small(self) -> bool:
        """Whether its matrix is stored."""
        return len(self.separating) <= SMALL

    def at_all_points(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values (q, ...) at all points of the position, from values (p, ...) at the pressed ones; zero elsewhere."""
        everywhere = np.zeros((len(self._state.traction), *values.shape[1:]), dtype=values.dtype)
        everywhere[self._pressed] = values
        return everywhere


@dataclass(frozen=True)
class LinearBlock:
    """The linearised equations of a block.

    explicit: (n,) depths ΔN r at the rate of the block's start [mm].
    pressure: (q,) pressures of this rank's points at the start [MPa].
    openings: (q, n) opening of the gap at these points per depth.
    worn_off: depths (n,) [mm] that pressures (q,) wear off in the block, summed over all ranks.
    """

    explicit: Floats
    pressure: Floats
    openings: sp.csr_matrix
    worn_off: Callable[[Floats], Floats]

    def solve(self, responses: Sequence[PositionResponse], comm: MPI.Comm) -> tuple[Floats, Floats]:
        """Depths Δh (n,) [mm] and pressure changes ∂λ (q,) [MPa] of this rank, with no negative pressure at the end.

        The depths are recomputed from the final ∂λ, so that they are what these pressures wear off to rounding.
        Raises NotConverged.
        """
        depth, change = self.explicit, np.zeros_like(self.pressure)
        for _ in range(MAX_SEPARATIONS):
            depth, change = self._solve_linear(responses, depth)
            negative = self.pressure + change < -NEGATIVE_PRESSURE * self.pressure.max(initial=0.0)
            pulling = np.split(negative, _ends(responses))
            if not comm.allreduce(sum(int(each.sum()) for each in pulling)):
                break
            responses = together(comm, partial(_without, responses, pulling))
        change = np.maximum(change, -self.pressure)
        return self.explicit + self.worn_off(change), change

    def pressed_at_end(self, responses: Sequence[PositionResponse], change: Floats) -> list[Bools]:
        """Per position (q,), which of its points are pressed at the block's end."""
        pressed = np.split(self.pressure + change > 0.0, _ends(responses))
        return [response.at_all_points(each) for response, each in zip(responses, pressed)]

    def _solve_linear(self, responses: Sequence[PositionResponse], start: Floats) -> tuple[Floats, Floats]:
        """Δh (n,) and ∂λ (q,) of this rank with a given set of points in contact. Raises NotConverged."""
        respond = _joined(responses)

        def pressure_change(h: Floats) -> Floats:
            return respond(self.openings @ h)

        def equations(h: Floats) -> Floats:
            return h - self.worn_off(pressure_change(h))

        separation = np.concatenate([r.separation for r in responses] or [np.zeros(0)])
        size, right = 2 * (len(self.explicit),), self.explicit + self.worn_off(separation)
        tolerance = {RELATIVE: GMRES_TOLERANCE}
        depth, failed = gmres(LinearOperator(size, equations), right, x0=start, atol=0.0, **tolerance)
        if failed:
            raise NotConverged(
                f"wear block: wanted a residual below {GMRES_TOLERANCE:g}, found no convergence; take a shorter one"
            )
        return depth, separation + pressure_change(depth)


def _joined(responses: Sequence[PositionResponse]) -> Callable[[Floats], Floats]:
    """R of all positions, (q,) to (q,); small ones as one sparse matrix, since many small products are slower."""
    if responses and all(r.is_small for r in responses):
        matrix = sp.block_diag([r.matrix for r in responses], format="csr")
        return lambda opening: np.asarray(matrix @ opening)
    ends = _ends(responses)
    return lambda opening: np.concatenate(
        [response(each) for response, each in zip(responses, np.split(opening, ends))] or [opening]
    )


def _ends(responses: Sequence[PositionResponse]) -> Ints:
    """Indices in the list of all points at which the points of each position but the last end."""
    return np.cumsum([len(r.separating) for r in responses])[:-1]


def _without(responses: Sequence[PositionResponse], pulling: Sequence[Bools]) -> list[PositionResponse]:
    """The responses when the pulling points have left the contact. Raises NotConverged."""
    return [response.without(each) for response, each in zip(responses, pulling)]
