"""A gear pair whose flanks wear: the pitch solved on worn flanks, and what a mesh passage takes away.

On several ranks each has its own positions of the pitch: it searches and condenses them, keeps them from cycle to
cycle, and gathers what they wear off; friction, which has a past, goes from rank to rank.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy.sparse as sp
from mpi4py import MPI

from evolvent.contact.newton.snes import NotConverged
from evolvent.fem.material import contact_modulus
from evolvent.fem.parallel.ranks import together
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep.parallel_sweep import division
from evolvent.gears.sweep.pitch_sweep import Pitch
from evolvent.gears.sweep.position import (
    PositionResult,
    SearchedAt,
    SharedPosition,
    searched_at,
    shared_position,
    worn_on,
)
from evolvent.scene.scene import GEARS
from evolvent.wear.archard import Archard, certify_volume
from evolvent.wear.block_stepping import TOO_LONG, Evaluated
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent.wear.gears.implicit_block import LinearBlock, Response
from evolvent.wear.gears.passage import Passage, passage
from evolvent.wear.gears.worn_sweep import RubbingSweep
from evolvent.wear.mesh_motion import WornSurface, certify_loss, worn_mesh
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.mesh.mesh_data import MeshData

HELD = "bore", "cut_low", "cut_high", "fillet", "back", "tip"
"""Groups of a sector that stay when its mesh follows the wear; end faces, which are plane, slide in themselves."""
SLOPE = 0.01
"""Of the depth over the flank that a mesh follows: half a degree. Steeper is a tip edge's doing, narrow as a cell."""
PUT_ON = 1e-7  # of a block's volume may be left out: depths below zero, a tenth of what its certificate allows


@dataclass(frozen=True)
class PitchState(Evaluated):
    """A pitch solved on worn flanks. positions: its results. work: ∫∫p|v_s| dA dt of a tooth's passage [N·mm; per mm of
    width in 2D]. shared: search and compliance of this rank's angles, for the next cycle. searched: how many were;
    refreshed: how often the meshes had followed. points, passage: of this rank's positions without friction."""

    positions: tuple[PositionResult, ...]
    work: float
    shared: tuple[SharedPosition, ...]
    searched: int
    refreshed: int
    points: tuple[ContactPoints, ...]
    passage: Passage


@dataclass(frozen=True)
class Following:
    """When the meshes follow the wear: where they lack more than `depth` [mm] of what they could follow. condensed:
    makes the model from gear 0's and 1's meshes."""

    depth: float
    condensed: Callable[[Callable[[int], MeshData]], GearModel]


class GearWear:
    """A gear pair at one friction coefficient; a cycle is a revolution of the pinion. law: of pinion and wheel.

    Depths (n,) are those of the pinion's flank nodes, then of the wheel's. begin: as made or as charted; known: what
    the meshes have of them, after so many times that they were `refreshed`, without `following` never. All ranks of
    `comm` call every method.
    """

    def __init__(
        self, model: GearModel, pitch: Pitch, friction: float, law: Archard, comm: MPI.Comm = MPI.COMM_SELF,
        following: Following | None = None,
    ) -> None:  # fmt: skip
        """Raises InputError unless the positions are equal steps of one pitch: they are one tooth's passage."""
        angles = np.array(pitch.angles)
        step = 2.0 * np.pi / model.pair.pinion.z / max(len(angles), 1)
        if len(angles) < 2 or not np.allclose(np.diff(angles), step, rtol=1e-6):
            raise InputError(
                f"wear: wanted at least two positions in equal steps over one pitch, found {len(angles)} over "
                f"{np.degrees(np.ptp(angles)) if len(angles) else 0.0:.3f}°; see gear_sweep.uniform_pitch"
            )
        self.model, self.pitch, self.friction, self.law = model, pitch, friction, law
        self.grids = FlankGrid.of(model.bodies[0]), FlankGrid.of(model.bodies[1])
        self._first, self._comm, self._step = len(model.bodies[0].flank.points), comm, step
        self._often = 1.0, 1.0 / model.pair.ratio  # a tooth of each gear meets in a cycle
        self.following = following
        self._made = tuple((body.mesh, body.flank) for body in model.bodies)
        charted = [b.worn if b.worn is not None else np.zeros(len(b.flank.points)) for b in model.bodies]
        self.begin = np.concatenate(charted)
        self.known, self.refreshed = np.zeros(len(self.areas)), 0
        self._own = range(len(pitch.angles))[division(len(pitch.angles), comm.size)[comm.rank]]
        self._sweep = RubbingSweep(pitch, friction, self.grids, step, comm, self._own)

    @property
    def areas(self) -> Floats:
        """(n,) of all flank nodes [mm²; mm in 2D]."""
        return np.concatenate([grid.areas for grid in self.grids])

    def by_gear(self, depth: Floats) -> tuple[Floats, Floats]:
        """Depths of the pinion's and of the wheel's flank nodes."""
        return depth[: self._first], depth[self._first :]

    def gentle(self, depth: Floats) -> Floats:
        """What of depths (n,) meshes can follow: where it is steeper than SLOPE, as in the pits of tip edges, the rest
        stays a matter of the gap."""
        return np.concatenate([grid.gentle(own, SLOPE) for grid, own in zip(self.grids, self.by_gear(depth))])

    def lacking(self, depth: Floats) -> float:
        """How much [mm] of these depths the meshes lack at most of what they can follow."""
        return float(np.abs(self.gentle(depth) - self.known).max())

    def follow(self, depth: Floats) -> None:
        """Moves both gears' meshes as they were made to what is gentle of these depths, and condenses them anew. Raises
        MeshInverted, MeshVolumeLost."""
        assert self.following is not None
        known = self.gentle(depth)
        lost = self.by_gear(known)

        def moved(gear: int) -> MeshData:
            made, flank = self._made[gear]
            mesh = worn_mesh(made, [WornSurface(flank, lost[gear])], HELD)
            certify_loss(made, mesh, float(flank.weights() @ lost[gear]))
            return mesh

        self.model, self.known, self.refreshed = self.following.condensed(moved), known, self.refreshed + 1

    def evaluate(self, depth: Floats, before: PitchState | None = None) -> PitchState:
        """One pitch at depths (n,), see `Wearable`; positions near which the gears stood in the
        cycle `before` are not searched again."""
        return self._evaluated(depth, before, {})

    def _evaluated(self, depth: Floats, before: PitchState | None, foreseen: Mapping[int, np.ndarray]) -> PitchState:
        """foreseen: of this rank's angles, (q,) bool, which points are likely to be pressed."""
        usable = before is not None and before.refreshed == self.refreshed  # on the same meshes
        model, kept = self._worn(depth), before.shared if before is not None and usable else ()
        shared, searched = together(self._comm, lambda: self._prepared(model, kept, foreseen))
        return self._solved(model, shared, self._comm.allreduce(searched))

    def resumed(self, depth: Floats, searches: Sequence[SearchedAt]) -> PitchState:
        """The pitch at depths (n,), from searches made where `searched` says that they were."""
        model = self._worn(depth)
        frictions = [self.friction]
        shared = together(self._comm, lambda: [searched_at(model, searches[k], frictions) for k in self._own])
        return self._solved(model, shared, 0)

    def searches(self, state: PitchState) -> list[SearchedAt]:
        """Where each angle's search was made, on all ranks."""
        own = [SearchedAt(s.contact.stand.angle, s.contact.stand.extra, s.contact.half_width) for s in state.shared]
        return [search for part in self._comm.allgather(own) for search in part]

    def implicit(self, depth: Floats, now: PitchState, length: float) -> tuple[Floats, PitchState]:
        """A block by the linearised rate of its end, (1 − ΔN ∂r/∂h) Δh = ΔN r, and the pitch there, see `Wearable`. The
        pressures follow the depth as they do without friction. Raises NotConverged."""
        if now.refreshed != self.refreshed:
            raise InputError("a block of wear: wanted a pitch solved on the meshes of now, found one on others")
        responses = together(self._comm, lambda: [Response.of(*each) for each in zip(now.shared, now.points)])
        found, openings = now.passage, self._opened([r.points for r in responses])
        block = LinearBlock(length * now.rate, found.pressure, openings, partial(self._worn_in, length, found))
        gained, more = block.solved(responses, self._comm)
        # with friction a point that leaves may have pressed less than without it
        gone, put = np.maximum(gained, 0.0), np.maximum(-gained, 0.0)
        if not float(self.areas @ put) <= PUT_ON * float(self.areas @ gone):
            raise NotConverged(f"a block of {length:.6g} cycles would put {put.max():.2g} mm of material on")
        self._certify(gone, length * (now.work + sum(self._comm.allgather(float(found.works @ more)))))
        foreseen = dict(zip(self._own, block.pressed(responses, more)))
        return gone, self._evaluated(depth + gone, now, foreseen)

    def accepted(self, depth: Floats, now: PitchState) -> PitchState:
        """The pitch once the meshes have followed where they lack too much of depths (n,), see `Wearable`."""
        if self.following is None or self.lacking(depth) <= self.following.depth:
            return now
        before = self.model, self.known, self.refreshed
        try:
            self.follow(depth)
            return self.evaluate(depth)
        except TOO_LONG:
            self.model, self.known, self.refreshed = before
            raise

    def _worn(self, depth: Floats) -> GearModel:
        pinion, wheel = (replace(b, worn=own) for b, own in zip(self.model.bodies, self.by_gear(depth - self.known)))
        return replace(self.model, bodies=(pinion, wheel))

    def _prepared(
        self, model: GearModel, kept: Sequence[SharedPosition], foreseen: Mapping[int, np.ndarray]
    ) -> tuple[list[SharedPosition], int]:
        """This rank's positions without friction, and how many of them had to be searched."""
        found: list[SharedPosition] = []
        searched = 0
        for i, k in enumerate(self._own):
            old = kept[i] if kept else None
            shared = worn_on(model, old, foreseen.get(k)) if old is not None else None
            if shared is None:
                near = old or (found[-1] if found else None)  # where the gears stood in the cycle before
                extra = (0.0, 0.0) if near is None else near.contact.stand.extra
                footprint = None if near is None else near.footprint
                shared = shared_position(model, self.pitch.angles[k], extra, [self.friction], footprint)
                searched += 1
            found.append(shared)
        return found, searched

    def _solved(self, model: GearModel, shared: Sequence[SharedPosition], searched: int) -> PitchState:
        """The pitch with friction, and what it wears off."""
        rubbed = self._sweep.rubbed(model, shared)
        found = self._passage([own.contact for own in rubbed.results])
        smooth = self._passage(rubbed.smooth) if model.has_friction_terms(self.friction) else found
        rate, work = self._rate(found, found.pressure), sum(self._comm.allgather(found.work))
        self._certify(rate, work)
        positions = tuple(result for part in self._comm.allgather(rubbed.results) for result in part)
        decay = self._decay(rate, positions)
        return PitchState(
            rate, self.areas, np.inf, decay, positions, work, tuple(shared), searched, self.refreshed,
            tuple(rubbed.smooth), smooth,
        )  # fmt: skip

    def _decay(self, rate: Floats, positions: Sequence[PositionResult]) -> float:
        """Cycles in which a ripple of two nodes along the profile decays to 1/e where flanks wear fastest: 1/(K/H
        πE*/ℓ s), the sliding distance s of a passage being that of the rate (K/H) p̄ s. Between the tip-edge zones: the
        pits of edges are as deep as the mesh makes them."""
        points = ContactPoints.joined([position.contact for position in positions])
        mean = float(points.weights @ points.pressure**2) / float(points.weights @ points.pressure)
        ripple = 2.0 * min(float(np.median(np.diff(grid.arcs))) for grid in self.grids)
        modulus = contact_modulus(*(body.material for body in self.model.bodies))
        inner = [grid.inner(self.model.pair, gear) for gear, grid in enumerate(self.grids)]
        fastest = sum(float(own[nodes].max(initial=0.0)) for own, nodes in zip(self.by_gear(rate), inner))
        return mean * ripple / (np.pi * modulus * fastest) if fastest > 0.0 else np.inf

    def _certify(self, depth: Floats, work: float) -> None:
        """Raises VolumeLost unless depths (n,) are what this work takes off both gears."""
        pairs = zip(GEARS, self.by_gear(self.areas), self.by_gear(depth), self.law.both, self._often)
        for name, areas, own, K, often in pairs:
            certify_volume(name, float(areas @ own), K * often * work)

    def _passage(self, positions: Sequence[ContactPoints]) -> Passage:
        return passage(self.model.pair, positions, self.grids, self._step)

    def _rate(self, found: Passage, pressure: Floats) -> Floats:
        """Depths (n,) per cycle [mm] of this rank's pressures (q,), over all ranks, to the last bit alike."""
        own = [K * n * (D @ pressure) for K, n, D in zip(self.law.both, self._often, found.depths)]
        return np.asarray(np.sum(self._comm.allgather(np.concatenate(own)), axis=0))

    def _worn_in(self, length: float, found: Passage, pressure: Floats) -> Floats:
        """Depths (n,) of so many cycles."""
        return length * self._rate(found, pressure)

    def _opened(self, positions: Sequence[ContactPoints]) -> sp.csr_matrix:
        """(q, n) by how much depths open the gap at the points of positions."""
        if not positions:
            return sp.csr_matrix((0, len(self.areas)))
        points = ContactPoints.joined(positions)
        places = enumerate((points.across, points.opposite))
        arcs = [line_arc(self.model.pair, gear, points.ξ) + s for gear, s in places]
        return sp.hstack([grid.hats(u, points.z) for grid, u in zip(self.grids, arcs)]).tocsr()
