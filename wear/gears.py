"""A gear pair whose flanks wear: the pitch solved on worn flanks, and what a mesh passage takes away."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, gmres

from meshes.data import Floats, Ints
from solver.equilibrium import normal_part
from solver.gear_model import GearModel
from solver.gear_position import (
    ContactPoints,
    PositionResult,
    SharedPosition,
    contact_points,
    shared_position,
    worn_on,
)  # fmt: skip
from solver.gear_sweep import Pitch, SweepState, initial_state, sweep_pitch
from solver.newton import NotConverged
from solver.newton_steps import RELATIVE
from solver.pressure_response import PressureResponse
from wear.blocks import Evaluated
from wear.flank_grid import FlankGrid
from wear.law import Archard
from wear.passage import Passage, line_arc, passage

KRYLOV = 1e-6  # of the right-hand side may be left of a block's equations


@dataclass(frozen=True)
class PitchState(Evaluated):
    """A pitch solved on worn flanks. positions: its results. work: ∫∫p|v_s| dA dt of a tooth's passage [N·mm; per mm of
    width in 2D]. shared: search and compliance of each angle of the pitch, for the next cycle."""

    positions: tuple[PositionResult, ...]
    work: float
    shared: tuple[SharedPosition, ...]
    searched: int


class Response:
    """How the pressures at a position's pressed points follow when the gap opens there."""

    def __init__(self, points: ContactPoints, pressed: Ints, whole: PressureResponse, size: int) -> None:
        self.points, self._pressed, self._whole, self._size = points, pressed, whole, size

    @staticmethod
    def of(shared: SharedPosition) -> Response:
        """In the frictionless state."""
        system, pressure = shared.system, shared.smooth.traction
        normal = system if system.k == 1 else normal_part(system)
        points, pressed = contact_points(shared.contact, pressure, 0.0), np.flatnonzero(pressure[:, 0] > 0.0)
        return Response(points, pressed, PressureResponse(normal, shared.smooth), len(pressure))

    def __call__(self, opening: Floats) -> Floats:
        """∂λ (p,) [MPa] of ∂g (p,) [mm] at the p pressed points."""
        whole = np.zeros(self._size)
        whole[self._pressed] = opening
        return self._whole(whole)[self._pressed]


class GearWear:
    """A gear pair at one friction coefficient; a cycle is a revolution of the pinion. law: of pinion and wheel.

    Depths (n,) are those of the pinion's flank nodes, then of the wheel's.
    """

    def __init__(self, model: GearModel, pitch: Pitch, friction: float, law: Archard) -> None:
        """Raises ValueError unless the positions are equal steps of one pitch: they are one tooth's passage."""
        angles = np.array(pitch.angles[pitch.warm_up :])
        step = 2.0 * np.pi / model.pair.pinion.z / max(len(angles), 1)
        if len(angles) < 2 or not np.allclose(np.diff(angles), step, rtol=1e-6):
            raise ValueError(
                f"wear: wanted at least two positions in equal steps over one pitch, found {len(angles)} over "
                f"{np.degrees(np.ptp(angles)) if len(angles) else 0.0:.3f}°; see gear_sweep.uniform_pitch"
            )
        self.model, self.pitch, self.friction, self.law = model, pitch, friction, law
        self.grids = FlankGrid.of(model.bodies[0]), FlankGrid.of(model.bodies[1])
        self._first = len(model.bodies[0].flank.points)

    @property
    def areas(self) -> Floats:
        """(n,) of all flank nodes [mm²; mm in 2D]."""
        return np.concatenate([grid.areas for grid in self.grids])

    @property
    def unworn(self) -> Floats:
        """Depths (n,) of flanks as made."""
        return np.zeros(self._first + len(self.model.bodies[1].flank.points))

    def by_gear(self, depth: Floats) -> tuple[Floats, Floats]:
        """Depths of the pinion's and of the wheel's flank nodes."""
        return depth[: self._first], depth[self._first :]

    def evaluate(self, depth: Floats, before: PitchState | None = None) -> PitchState:
        """One pitch at depths (n,), see `Wearable`; positions near which the gears stood in the
        cycle `before` are not searched again."""
        pinion, wheel = (replace(b, worn=own) for b, own in zip(self.model.bodies, self.by_gear(depth)))
        model, results, kept = replace(self.model, bodies=(pinion, wheel)), [], []
        state, searched = initial_state([self.friction]), 0
        for k, angle in enumerate(self.pitch.angles):
            old = before.shared[k] if before is not None else None
            shared = worn_on(model, old) if old is not None else None
            if shared is None:
                shared, searched = self._searched(model, angle, state, old), searched + 1
            kept.append(shared)
            swept = next(sweep_pitch(model, self.pitch, [self.friction], state, k, shared))
            state = swept.state
            if not swept.warm_up:
                results.append(swept.results[0])
        found = self._passage([r.contact for r in results])
        return PitchState(
            self._rates(found) @ found.pressure, self.areas, np.inf, tuple(results), found.work, tuple(kept), searched
        )

    def implicit(self, depth: Floats, now: PitchState, length: float) -> tuple[Floats, PitchState]:
        """A block by the linearised rate of its end, (1 − ΔN ∂r/∂h) Δh = ΔN r, and the pitch there, see `Wearable`. The
        pressures follow the depth as they do without friction. Raises NotConverged."""
        own = [shared for k, shared in enumerate(now.shared) if k >= self.pitch.warm_up]
        responses = [Response.of(shared) for shared in own]
        found = self._passage([r.points for r in responses])
        rates, openings = self._rates(found), sp.vstack([self._opened(r.points) for r in responses]).tocsr()
        ends = np.cumsum([len(r.points.weights) for r in responses])[:-1]

        def slope(h: Floats) -> Floats:
            parts = zip(responses, np.split(openings @ h, ends))
            return np.asarray(h - length * (rates @ np.concatenate([r(g) for r, g in parts])))

        size = (len(depth), len(depth))
        right = length * now.rate
        gained, failed = gmres(LinearOperator(size, slope), right, x0=right, atol=0.0, **{RELATIVE: KRYLOV})
        if failed:
            raise NotConverged(f"a block of {length:.6g} cycles: its equations were not solved; take a shorter one")
        return gained, self.evaluate(depth + gained, now)

    def _passage(self, positions: Sequence[ContactPoints]) -> Passage:
        return passage(self.model.pair, positions, self.grids)

    def _rates(self, found: Passage) -> sp.csr_matrix:
        """(n, q) depth per cycle [mm] of pressures (q,)."""
        often = 1.0, 1.0 / self.model.pair.ratio
        return sp.vstack([K * n * D for K, n, D in zip(self.law.both, often, found.depths)]).tocsr()

    def _opened(self, points: ContactPoints) -> sp.csr_matrix:
        """(q, n) by how much depths open the gap at points."""
        places = enumerate((points.across, points.opposite))
        arcs = [line_arc(self.model.pair, gear, points.ξ) + s for gear, s in places]
        return sp.hstack([grid.hats(u, points.z) for grid, u in zip(self.grids, arcs)]).tocsr()

    def _searched(
        self, model: GearModel, angle: float, state: SweepState, old: SharedPosition | None
    ) -> SharedPosition:
        """From where the gears stood in the cycle before, without one from the last position."""
        extra, footprint = state.extra, state.footprint
        if old is not None:
            extra, footprint = old.contact.stand.extra, old.footprint
        return shared_position(model, angle, extra, [self.friction], footprint)
