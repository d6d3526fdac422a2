"""A wear study of a problem of the public API: blocks of cycles, the mesh following, every block's volume certified.

    study = WearStudy(problem, (Archard(first=1.4e-10),), Cycle((Step(),), (Travel(1, translation=(1e3, 0, 0)),)))
    for block in study.blocks(1000.0, BlockSettings(first=10.0)): ...

In the example a cycle is 1 m of sliding.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from meshes.data import Floats, MeshData
from solver.body import Body
from solver.position import reach_of
from solver.prepared import PreparedBody, prepare
from solver.search import SearchError
from solver.statement import Contact, Problem, Side
from solver.surface import Surface
from wear.blocks import TOO_LONG, Block, BlockSettings, Evaluated, WearState, next_block, unworn
from wear.cycle import Cycle, Depths, Rubbing, Worn, added, rubbings
from wear.law import Archard, certify_volume
from wear.motion import Follow, MeshVolumeLost, WornSurface, mesh_volume, smallest_edge, worn_mesh

SHALLOW = 0.25
"""Of the shortest edge of the cells at a surface: a gap so deep changes no more of the body than the mesh resolves."""
MESH_VOLUME = 1e-2
"""How far what a moved mesh has lost may be from Σ m h. On a curved surface the two differ by half the depth over the
radius; 6e-4 was found on worn spheres and cylinders."""


@dataclass(frozen=True)
class Refresh:
    """When the mesh follows: where depth [mm] is more than this that the mesh does not know of, and in any case where
    it is more than SHALLOW cells or half of a contact's reach; how its interior does, and the least scaled Jacobian it
    may have."""

    depth: float = np.inf
    follow: Follow = "harmonic"
    least_quality: float = 0.05


@dataclass(frozen=True)
class CycleState(Evaluated):
    """A cycle solved on worn bodies: the contacts as they rub, volumes per cycle of every side that wears [mm³; mm² in
    2D]: at the nodes, and K/H·∫∫p|v_s| dA dt at the contact points."""

    rubbing: tuple[tuple[Rubbing, ...], ...]
    volumes: dict[Side, float]
    integrals: dict[Side, float]


@dataclass(frozen=True)
class Geometry:
    """Bodies as meshed and condensed, and the depth (n,) [mm] that these meshes know of."""

    problem: Problem
    prepared: tuple[PreparedBody, ...]
    known: Floats


class WearStudy:
    """A problem that wears, cycle after cycle. laws: one a contact. Raises ValueError."""

    def __init__(
        self, problem: Problem, laws: Sequence[Archard], cycle: Cycle, refresh: Refresh | None = None
    ) -> None:
        if len(laws) != len(problem.contacts):
            raise ValueError(f"wear: wanted a law for each of {len(problem.contacts)} contacts, found {len(laws)}")
        self.laws, self.cycle, self.refresh = tuple(laws), cycle, refresh or Refresh()
        self.sides = _wearing_sides(problem, self.laws)
        if not self.sides:
            raise ValueError("wear: wanted a K/H above zero on some surface, found none; nothing would wear")
        _refuse_tracks(self.sides, cycle, len(problem.bodies))
        prepared = prepare(problem)
        self._ends = np.cumsum([0] + [len(prepared[b].surfaces[g].points) for b, g in self.sides])
        self.geometry = Geometry(problem, prepared, np.zeros(self._ends[-1]))
        self.refreshed, self._share = 0, SHALLOW

    def evaluate(self, depth: Floats, before: CycleState | None = None) -> CycleState:
        """One cycle at depths (n,), its volume certified, see `Wearable`. Raises VolumeLost as well, which shorter
        blocks do not help."""
        return self._solved(depth, 0.0)

    def implicit(self, depth: Floats, now: CycleState, length: float) -> tuple[Floats, CycleState]:
        """A block with the contact law itself wearing, see `Wearable`. Only for cycles with travel."""
        end = self._solved(depth, length)
        return length * end.rate, end

    def _solved(self, depth: Floats, ahead: float) -> CycleState:
        own = self.geometry
        worn = Worn(own.problem, self.laws, self.cycle, self.by_side(depth - own.known), ahead)
        states = rubbings(worn, own.prepared)
        rates = added(self.laws, own.problem, states)
        rate = np.concatenate([rates[side] for side in self.sides])
        state = CycleState(
            rate, self.areas, _deformation(own.problem, states), self._decay(states),
            tuple(map(tuple, states)), self._volumes(rates), self._integrals(states),
        )  # fmt: skip
        _certify(state)
        return state

    def blocks(
        self, cycles: float, settings: BlockSettings, begin: Floats | None = None
    ) -> Iterator[Block[CycleState]]:
        """Blocks until so many cycles are done; begin: depths to start from. Raises WearStopped, VolumeLost."""
        state: WearState[CycleState] = unworn(self, np.zeros(self._ends[-1]) if begin is None else begin, settings)
        while state.cycles < cycles * (1.0 - 1e-12):
            block = next_block(self, state, cycles, settings)
            state = block.state
            yield block

    def accepted(self, depth: Floats, now: CycleState) -> CycleState:
        """Lets the meshes follow where they have to, see `Wearable`."""
        self._refuse_beyond_reach(depth)
        if (depth - self.geometry.known).max() <= self._shallow():
            return now
        before = self.geometry, self.refreshed
        try:
            self.follow(depth)
            return self.evaluate(depth)
        except TOO_LONG as error:
            self.geometry, self.refreshed = before
            if isinstance(error, MeshVolumeLost):  # of curved surfaces: the more the deeper
                self._share *= 0.5
            raise

    def follow(self, depth: Floats) -> None:
        """Moves the meshes to these depths, and condenses the bodies anew. Raises MeshInverted, MeshVolumeLost."""
        old, new = self.geometry, self._moved_problem(depth)
        wanted = float(self.areas @ (depth - old.known))
        pairs = zip(old.problem.bodies, new.bodies)
        lost = sum(mesh_volume(a.mesh) - mesh_volume(b.mesh) for a, b in pairs if a is not b)
        if not abs(lost - wanted) <= MESH_VOLUME * wanted:
            raise MeshVolumeLost(
                f"mesh motion: wanted meshes that lose {wanted:.6g}, found {lost:.6g}; put all facets that may touch "
                "into the worn surface, refine it, or let the mesh follow more often"
            )
        self.geometry, self.refreshed = Geometry(new, prepare(new), depth.copy()), self.refreshed + 1

    @property
    def areas(self) -> Floats:
        """(n,) of all nodes that wear [mm²; mm in 2D]."""
        return np.concatenate([self.geometry.prepared[b].surfaces[g].weights() for b, g in self.sides])

    def by_side(self, depth: Floats) -> Depths:
        """Depths (n,) as one array a side."""
        return {side: depth[a:b] for side, a, b in zip(self.sides, self._ends, self._ends[1:])}

    def meshes(self, depth: Floats) -> tuple[MeshData, ...]:
        """The bodies' meshes moved to these depths. Raises MeshInverted."""
        return tuple(body.mesh for body in self._moved_problem(depth).bodies)

    def _moved_problem(self, depth: Floats) -> Problem:
        """What a body has lost the other one comes after: the contacts' reach grows by it."""
        new, own = self.by_side(depth - self.geometry.known), self.geometry
        bodies = tuple(self._moved_body(i, body, new) for i, body in enumerate(own.problem.bodies))
        reaches = zip(own.problem.contacts, self._reaches(), self._opened(depth))
        contacts = tuple(replace(contact, reach=reach + opened) for contact, reach, opened in reaches)
        return replace(own.problem, bodies=bodies, contacts=contacts)

    def _refuse_beyond_reach(self, depth: Floats) -> None:
        """Raises SearchError where surfaces have lost so much that they may touch where no contact is looked for."""
        for contact, reach, opened in zip(self.geometry.problem.contacts, self._reaches(), self._opened(depth)):
            if not opened <= reach:
                (one, first), (other, second) = contact.first, contact.second
                raise SearchError(
                    f"wear between {first!r} of body {one} and {second!r} of body {other}: wanted a block that opens "
                    f"the gap by less than the contact's reach, {reach:.3g} mm, found {opened:.3g} mm; give the "
                    "contact a larger reach, or take shorter blocks"
                )

    def _reaches(self) -> list[float]:
        """Of the contacts [mm]."""
        return [reach_of(contact, self._surface(contact.first)) for contact in self.geometry.problem.contacts]

    def _opened(self, depth: Floats) -> list[float]:
        """By how much [mm] depths (n,) that the meshes do not know of may open the contacts' gaps."""
        most = {side: float(new.max(initial=0.0)) for side, new in self.by_side(depth - self.geometry.known).items()}
        contacts = self.geometry.problem.contacts
        return [sum(most.get(side, 0.0) for side in (contact.first, contact.second)) for contact in contacts]

    def _shallow(self) -> float:
        """The largest depth [mm] that the gap alone may take."""
        bodies = self.geometry.problem.bodies
        edges = [smallest_edge(bodies[b].mesh, self._surface((b, group)).nodes) for b, group in self.sides]
        return min(self.refresh.depth, self._share * min(edges), 0.5 * min(self._reaches()))

    def _surface(self, side: Side) -> Surface:
        return self.geometry.prepared[side[0]].surfaces[side[1]]

    def _moved_body(self, index: int, body: Body, new: Depths) -> Body:
        surfaces = self.geometry.prepared[index].surfaces
        worn = [WornSurface(surfaces[group], new[b, group]) for b, group in self.sides if b == index]
        if not worn:
            return body
        held = _resting(body)
        mesh = worn_mesh(body.mesh, worn, held, self.refresh.follow, self.refresh.least_quality)
        return replace(body, mesh=mesh)

    def _volumes(self, rates: Depths) -> dict[Side, float]:
        return {side: float(own @ rates[side]) for side, own in self.by_side(self.areas).items()}

    def _decay(self, states: list[list[Rubbing]]) -> float:
        """Cycles in which a ripple from node to node decays to 1/e: 1/(K/H πE*/ℓ s), ℓ two nodes, of the contact where
        it does so fastest."""
        fastest = 0.0
        for contact, law, own in zip(self.geometry.problem.contacts, self.laws, states):
            surfaces = [self._surface(side) for side in (contact.first, contact.second) if side in self.sides]
            nodes = [float(np.median(s.weights())) ** (1.0 / (s.points.shape[1] - 1)) for s in surfaces]
            slid = sum(float(state.sliding[state.result.pressure > 0.0].max(initial=0.0)) for state in own)
            stiff = np.pi * _modulus(self.geometry.problem, contact) / (2.0 * min(nodes, default=np.inf))
            fastest = max(fastest, sum(law.both) * slid * stiff)
        return 1.0 / fastest if fastest else np.inf

    def _integrals(self, states: list[list[Rubbing]]) -> dict[Side, float]:
        total = dict.fromkeys(self.sides, 0.0)
        for contact, law, own in zip(self.geometry.problem.contacts, self.laws, states):
            for side, K in zip((contact.first, contact.second), law.both):
                if K > 0.0:
                    total[side] += K * sum(float(state.work.sum()) for state in own)
        return total


def _wearing_sides(problem: Problem, laws: Sequence[Archard]) -> tuple[Side, ...]:
    sides = []
    for contact, law in zip(problem.contacts, laws):
        sides += [side for side, K in zip((contact.first, contact.second), law.both) if K > 0.0]
    return tuple(dict.fromkeys(sides))


def _refuse_tracks(sides: Sequence[Side], cycle: Cycle, bodies: int) -> None:
    """Raises ValueError where a body travels that there is not, or that wears: it would wear on its whole track, not
    where it is touched."""
    for travel in cycle.travel:
        if not 0 <= travel.body < bodies:
            raise ValueError(f"wear: wanted travel of a body below {bodies}, found body {travel.body}")
        if any(body == travel.body for body, _ in sides):
            raise ValueError(
                f"wear: wanted bodies that stay where they are, found body {travel.body}, which travels and wears; "
                "give it no K/H, or let it go to and fro in the cycle's steps"
            )


def _resting(body: Body) -> list[str]:
    """Facet groups that stay where they are when the mesh moves; a plane of symmetry is not among them."""
    rigid = [body.rigid.group] if body.rigid else []
    fixed = [s.group for s in body.supports if set(s.directions) >= set("xyz"[: body.mesh.dimension])]
    return [*{*fixed, *(t.group for t in body.loads), *rigid}]


def _deformation(problem: Problem, states: list[list[Rubbing]]) -> float:
    """Largest p̄ ℓ/E* [mm] of all contacts, p̄ the mean pressure on the pressed length or area ℓ or ℓ²: what an elastic
    half-space gives way, π/2 times b²/2R under a Hertzian line."""
    found = 0.0
    for contact, own in zip(problem.contacts, states):
        modulus = _modulus(problem, contact)
        for result in (state.result for state in own):
            pressed = float(result.weights[result.pressure > 0.0].sum())
            length = pressed ** (1.0 / (result.points.shape[1] - 1))
            mean = float(result.weights @ result.pressure) / pressed if pressed else 0.0
            found = max(found, mean * length / modulus)
    return found


def _modulus(problem: Problem, contact: Contact) -> float:
    """E* [MPa] of a contact's two materials."""
    one, other = (problem.bodies[index].material for index, _ in (contact.first, contact.second))
    return 1.0 / (1.0 / one.plane_modulus + 1.0 / other.plane_modulus)


def _certify(state: CycleState) -> None:
    """Raises VolumeLost."""
    for side, volume in state.volumes.items():
        certify_volume(f"body {side[0]}, {side[1]!r}", volume, state.integrals[side])
