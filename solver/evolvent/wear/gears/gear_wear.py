"""Wear of a gear pair: the pitch solved on worn flanks, and the depth that a mesh passage wears off.

Each rank has its own positions of the pitch: it searches and condenses them, keeps them from cycle to cycle, and
computes what they wear off. Friction depends on the history, so the friction state goes from rank to rank.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import scipy.sparse as sp
from mpi4py import MPI

from evolvent.contact.newton.snes import NotConverged
from evolvent.dynamics.operating_point import OperatingPoint, Operation, Start
from evolvent.fem.material import contact_modulus
from evolvent.fem.parallel.ranks import together
from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.gear_model import GearModel
from evolvent.gears.problem.flank_deviations import FlankChart
from evolvent.gears.sweep.parallel_sweep import division
from evolvent.gears.sweep.pitch_sweep import Pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.gears.sweep.position_search import SearchedAt, SharedPosition, searched_at, shared_position
from evolvent.gears.sweep.worn_position import worn_on
from evolvent.wear.archard import Archard, certify_volume
from evolvent.wear.block_stepping import RETRIED_ERRORS
from evolvent.wear.gears.flank_grid import FlankGrid, line_arc
from evolvent.wear.gears.implicit_block import LinearBlock, PositionResponse
from evolvent.wear.gears.meshed_pair import GearMeshMotion, MeshedPair
from evolvent.wear.gears.passage import MeshPassage, mesh_passage
from evolvent.wear.gears.pitch_state import PitchState, Vibration
from evolvent.wear.gears.worn_sweep import WornSweep
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.member import Member

NEGATIVE_VOLUME = 1e-7
"""Negative volume over the positive one of a block up to which negative depths are cut off; a tenth of the tolerance of
the volume's certificate."""


class GearWear:
    """Wear of a gear pair at one friction coefficient, a `WearModel`; a cycle is one revolution of the pinion.

    pitch: the positions of one pitch, ascending whichever gear drives.
    friction: friction coefficient of the contact solutions.
    law: Archard's coefficients of pinion and wheel.
    mesh_motion: when and how the meshes follow the wear; None: never.
    operating: speed under whose mesh force the pair wears; None: under the constant torque.
    geometry: the gears as meshed at present.
    begin: (n,) depths of the flanks as charted at the beginning [mm].

    Depths (n,) are those of the pinion's flank nodes, then of the wheel's. All ranks of `comm` call every method.
    """

    def __init__(
        self, model: GearModel, pitch: Pitch, friction: float, law: Archard, comm: MPI.Comm = MPI.COMM_SELF,
        mesh_motion: GearMeshMotion | None = None, operating: OperatingPoint | None = None,
    ) -> None:
        """Raises InputError unless the positions are equal steps of one pitch, which make up one tooth's passage."""
        angles = np.array(pitch.angles)
        step = 2.0 * np.pi / model.pair.pinion.z / max(len(angles), 1)
        if len(angles) < 2 or not np.allclose(np.diff(angles), step, rtol=1e-6):
            raise InputError(
                f"wear: wanted at least two positions in equal steps over one pitch, found {len(angles)} over "
                f"{np.degrees(np.ptp(angles)) if len(angles) else 0.0:.3f}°; take those of uniform_pitch"
            )
        self.pitch, self.friction, self.law, self.mesh_motion = pitch, friction, law, mesh_motion
        self.operating, self.geometry = operating, MeshedPair.of(model)
        charted = [b.worn if b.worn is not None else np.zeros(len(b.flank.points)) for b in model.bodies]
        self.begin = np.concatenate(charted)
        self._comm, self._step = comm, step
        self._passages = 1.0, 1.0 / model.pair.ratio  # of a tooth of each gear in a cycle
        self._numbers = range(len(pitch.angles))[division(len(pitch.angles), comm.size)[comm.rank]]
        self._sweep = WornSweep(pitch, friction, self.grids, step, comm, self._numbers)

    @property
    def model(self) -> GearModel:
        """The condensed gears on the present meshes."""
        return self.geometry.model

    @property
    def grids(self) -> tuple[FlankGrid, FlankGrid]:
        """The grids of pinion and wheel flank."""
        return self.geometry.grids

    @property
    def areas(self) -> Floats:
        """(n,) areas of all flank nodes [mm²; mm in 2D]."""
        return self.geometry.areas

    @property
    def mesh_depth(self) -> Floats:
        """(n,) depth that the meshes include [mm]."""
        return self.geometry.mesh_depth

    @property
    def mesh_updates(self) -> int:
        """Number of times that the meshes have followed the wear."""
        return self.geometry.mesh_updates

    def by_gear(self, depth: Floats) -> tuple[Floats, Floats]:
        """Depths of the pinion's and of the wheel's flank nodes."""
        return self.geometry.by_gear(depth)

    def update_meshes(self, depth: Floats) -> None:
        """Moves both meshes to what they can follow of depths (n,) and condenses the gears anew.

        Raises MeshInverted, MeshVolumeLost.
        """
        assert self.mesh_motion is not None
        self.geometry = self.geometry.moved(depth, self.mesh_motion)

    def evaluate(self, depth: Floats, previous: PitchState | None = None) -> PitchState:
        """One pitch at depths (n,), see `WearModel`. Positions near which the gears stood in the evaluation `previous`
        are not searched again. Raises VolumeLost as well."""
        return self._evaluate(depth, previous, {})

    def resumed(
        self, depth: Floats, searches: Sequence[SearchedAt], vibration: Vibration | None = None
    ) -> PitchState:
        """The pitch at depths (n,) with the contact searched at the places `searches`, one for each position.
        vibration: its state there."""
        start = None
        if vibration is not None and self.operating is not None:
            model, places, positions = self.geometry.with_gap(depth), vibration.searches, None
            if places:
                positions = self.operating.searched(model, vibration.torques, places, self._comm)
            start = Start(vibration.state, vibration.forces, positions)
        operation, model = self._loaded(depth, start)
        frictions = [self.friction]
        shared = together(self._comm, lambda: [searched_at(model, searches[k], frictions) for k in self._numbers])
        return self._solve(model, shared, 0, operation)

    def chart(self, gear: Member, depth: Floats) -> FlankChart:
        """The chart over diameter and height of depths [mm] at a gear's flank nodes."""
        return self.grids[gear].chart(self.model.pair.gears[gear], depth)

    def vibration(self, state: PitchState) -> Vibration | None:
        """Vibration of the pitch with the searches of all ranks; None under a constant torque. Collective."""
        operation = state.operation
        if operation is None:
            return None
        rows = operation.positions or ()
        mine = [position.searched for row in rows for position in row.values()]
        torques = self._comm.bcast(tuple(rows[0]) if rows else ())
        searches = tuple(search for part in self._comm.allgather(mine) for search in part)
        return Vibration(operation.state, operation.forces, torques, searches)

    def _loaded(self, depth: Floats, before: Start | None) -> tuple[Operation | None, GearModel]:
        """The gears at depths (n,) under their load, and the operation that a varying load comes from. before: start of
        the operation on nearly the same flanks."""
        model = self.geometry.with_gap(depth)
        if self.operating is None:
            return None, model
        pinion, wheel = (self.chart(gear, nodal) for gear, nodal in zip(Member, self.by_gear(depth)))
        operation = self.operating.on(model, (pinion, wheel), self._comm, before)
        return operation, replace(model, load=operation.load)

    def searches(self, state: PitchState) -> list[SearchedAt]:
        """Places where the contact of each position was searched, of all ranks."""
        mine = [shared.searched for shared in state.shared]
        return [search for part in self._comm.allgather(mine) for search in part]

    def implicit_block(self, depth: Floats, start: PitchState, length: float) -> tuple[Floats, PitchState]:
        """A block by the linearised rate of its end, (1 − ΔN ∂r/∂h) Δh = ΔN r, and the pitch there, see `WearModel`.

        The pressures respond to the depth as they do without friction. Raises NotConverged; InputError for a start on
        other meshes.
        """
        if start.mesh_updates != self.mesh_updates:
            raise InputError("wear block: wanted a pitch on the present meshes, found one on others; evaluate it again")
        pairs = zip(start.shared, start.points)
        responses = together(self._comm, lambda: [PositionResponse.of(*each) for each in pairs])
        passage, openings = start.passage, self._openings([r.points for r in responses])
        worn_off = partial(self._worn_off, length, passage)
        block = LinearBlock(length * start.rate, passage.pressure, openings, worn_off)
        gained, change = block.solve(responses, self._comm)
        # with friction a point that leaves the contact may have had a lower pressure than without
        positive, negative = np.maximum(gained, 0.0), np.maximum(-gained, 0.0)
        if not float(self.areas @ negative) <= NEGATIVE_VOLUME * float(self.areas @ positive):
            raise NotConverged(
                f"wear: wanted no negative depth from a block of {length:.6g} cycles, found {gained.min():.2g} mm; "
                "take a shorter block"
            )
        work = start.work + sum(self._comm.allgather(float(passage.swept_volumes @ change)))
        self._certify(positive, length * work)
        pressed = dict(zip(self._numbers, block.pressed_at_end(responses, change)))
        return positive, self._evaluate(depth + positive, start, pressed)

    def accept(self, depth: Floats, end: PitchState) -> PitchState:
        """The pitch after an update of meshes that lack too much of depths (n,), see `WearModel`."""
        if self.mesh_motion is None or self.geometry.lacking(depth) <= self.mesh_motion.depth:
            return end
        before = self.geometry
        try:
            self.update_meshes(depth)
            return self.evaluate(depth)
        except RETRIED_ERRORS:
            self.geometry = before
            raise

    def _evaluate(self, depth: Floats, previous: PitchState | None, pressed: Mapping[int, Bools]) -> PitchState:
        """One pitch at depths (n,). pressed: by number of this rank's positions, (q,) which points are likely to be
        pressed."""
        reusable = previous is not None and previous.mesh_updates == self.mesh_updates
        start = None if previous is None or previous.operation is None else previous.operation.start
        if start is not None and not reusable:
            start = start.without_positions()
        operation, model = self._loaded(depth, start)
        kept = previous.shared if previous is not None and reusable else ()
        shared, searched = together(self._comm, lambda: self._prepared(model, kept, pressed))
        return self._solve(model, shared, self._comm.allreduce(searched), operation)

    def _prepared(
        self, model: GearModel, kept: Sequence[SharedPosition], pressed: Mapping[int, Bools]
    ) -> tuple[list[SharedPosition], int]:
        """This rank's positions without friction, and how many of them were searched anew."""
        positions: list[SharedPosition] = []
        searched = 0
        for i, k in enumerate(self._numbers):
            old = kept[i] if kept else None
            shared = worn_on(model, old, pressed.get(k)) if old is not None else None
            if shared is None:
                near = old or (positions[-1] if positions else None)
                known = (0.0, 0.0) if near is None else near.contact.stand.beyond_nominal
                patch = None if near is None else near.patch
                shared = shared_position(model, self.pitch.angles[k], known, [self.friction], patch, exact=True)
                searched += 1
            positions.append(shared)
        return positions, searched

    def _solve(
        self, model: GearModel, shared: Sequence[SharedPosition], searched: int, operation: Operation | None
    ) -> PitchState:
        """The pitch with friction, and its wear rate."""
        swept = self._sweep.solve(model, shared)
        passage = self._passage([result.contact for result in swept.results])
        smooth = self._passage(swept.smooth) if model.has_friction_terms(self.friction) else passage
        rate, work = self._rate(passage, passage.pressure), sum(self._comm.allgather(passage.work))
        self._certify(rate, work)
        positions = tuple(result for part in self._comm.allgather(swept.results) for result in part)
        return PitchState(
            rate=rate, areas=self.areas, deformation=np.inf, ripple_decay=self._ripple_decay(rate, positions),
            positions=positions, work=work, shared=tuple(shared), searched=searched, mesh_updates=self.mesh_updates,
            points=tuple(swept.smooth), passage=smooth, operation=operation,
        )

    def _ripple_decay(self, rate: Floats, positions: Sequence[PositionResult]) -> float:
        """Cycles in which a ripple of two nodes along the profile decays to 1/e, 1/((K/H)(πE*/ℓ) s), where the flanks
        wear fastest between the edge margins; the sliding distance s of a passage from the rate (K/H) p̄ s."""
        points = ContactPoints.joined([position.contact for position in positions])
        mean = float(points.weights @ points.pressure**2) / float(points.weights @ points.pressure)
        wavelength = 2.0 * min(float(np.median(np.diff(grid.arcs))) for grid in self.grids)
        modulus = contact_modulus(*(body.material for body in self.model.bodies))
        inner = [grid.inner_nodes(self.model.pair, gear) for gear, grid in zip(Member, self.grids)]
        fastest = sum(float(depth[nodes].max(initial=0.0)) for depth, nodes in zip(self.by_gear(rate), inner))
        return mean * wavelength / (np.pi * modulus * fastest) if fastest > 0.0 else np.inf

    def _certify(self, depth: Floats, work: float) -> None:
        """Raises VolumeLost unless depths (n,) are what this work wears off both gears."""
        pairs = zip(Member, self.by_gear(self.areas), self.by_gear(depth), self.law.coefficients, self._passages)
        for gear, areas, nodal, K, passages in pairs:
            certify_volume(gear.label, float(areas @ nodal), K * passages * work)

    def _passage(self, positions: Sequence[ContactPoints]) -> MeshPassage:
        return mesh_passage(self.model.pair, positions, self.grids, self._step)

    def _rate(self, passage: MeshPassage, pressure: Floats) -> Floats:
        """Depths (n,) per cycle [mm] of this rank's pressures (q,), summed over all ranks; the same on each to the last
        bit."""
        parts = zip(self.law.coefficients, self._passages, passage.depths)
        mine = [K * passages * (depths @ pressure) for K, passages, depths in parts]
        return np.asarray(np.sum(self._comm.allgather(np.concatenate(mine)), axis=0))

    def _worn_off(self, length: float, passage: MeshPassage, pressure: Floats) -> Floats:
        """Depths (n,) of `length` cycles [mm]."""
        return length * self._rate(passage, pressure)

    def _openings(self, positions: Sequence[ContactPoints]) -> sp.csr_matrix:
        """Opening (q, n) of the gap at the points of positions, per depth."""
        if not positions:
            return sp.csr_matrix((0, len(self.areas)))
        points = ContactPoints.joined(positions)
        places = zip(Member, (points.across, points.opposite))
        arcs = [line_arc(self.model.pair, gear, points.roll_distance) + s for gear, s in places]
        return sp.hstack([grid.hats(u, points.z) for grid, u in zip(self.grids, arcs)]).tocsr()
