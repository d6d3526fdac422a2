"""A bar that bounces between two rigid walls, followed over many impacts."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from evidence.verification.transient.bar_on_wall import LENGTH, PASSAGE, SPEED, STEEL
from evolvent import Body, Contact, Fixed, InitialState, Problem, Transient, TransientSettings
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import rectangle

GAP = 5e-4  # mm, on both sides
LEAST = 0.01  # of the energy: a bar that has less is not followed


@dataclass(frozen=True)
class Setting:
    """How it is solved.

    modes:  natural modes of the bar that have inertia.
    steps:  time steps in 2L/c.
    radius: ρ_∞; None: steps that conserve energy.
    """

    modes: int
    steps: int
    radius: float | None

    def __str__(self) -> str:
        modes = f"{self.modes} modes" if self.modes else "no modes"
        method = "conserving" if self.radius is None else f"ρ_∞ = {self.radius:g}"
        return f"{modes}, {self.steps} steps, {method}"

    @property
    def method(self) -> TransientSettings:
        """As a transient takes it."""
        step = PASSAGE / self.steps
        if self.radius is None:
            return TransientSettings(step, self.modes, conserving=True)
        return TransientSettings(step, self.modes, spectral_radius=self.radius)


@dataclass(frozen=True)
class Bounces:
    """The bar over time: at the start and at the ends of n − 1 time steps.

    energy:   (n,), over that at the start.
    touching: (n, 2), whether it touches the lower and the upper wall.
    systems:  contact systems that were solved, mean over the time steps.
    """

    energy: Floats
    touching: Bools
    systems: float

    @property
    def impacts(self) -> int:
        """How often a wall is met."""
        return int(self._met.sum())

    @property
    def in_flight(self) -> tuple[Floats, Floats]:
        """Impacts so far, and the energy, (m,), at the last time step of each flight."""
        flying = ~self.touching.any(axis=1)
        last = np.flatnonzero(flying[:-1] & ~flying[1:])
        return np.cumsum(self._met)[last].astype(float), self.energy[last]

    @property
    def left(self) -> float:
        """Share of the energy in the last flight."""
        return float(self.in_flight[1][-1])

    @property
    def growth(self) -> float:
        """The largest growth of the energy at any time over that at the start."""
        return float(self.energy.max()) - 1.0  # not negative: the start is among them

    @property
    def loss(self) -> float:
        """The largest share of the energy at the start that is missing at any time."""
        return 1.0 - float(self.energy.min())

    @property
    def regained(self) -> float:
        """The largest growth of the energy in flight over that of any flight before."""
        energy = self.in_flight[1]
        return float((energy / np.minimum.accumulate(energy)).max()) - 1.0

    @property
    def _met(self) -> Floats:
        """(n,), walls that are met in each time step."""
        return np.asarray((np.diff(self.touching.astype(int), axis=0, prepend=0) > 0).sum(axis=1))


def problem() -> Problem:
    """The bar amid two walls, which are one body: one contact takes half the time of two."""
    bar = rectangle(1.0, LENGTH, 1, 20, origin=(0.0, GAP))
    ends = np.concatenate([bar.facets["bottom"], bar.facets["top"]])
    bodies = (
        Body(replace(bar, facets={**bar.facets, "ends": ends}), STEEL, supports=(Fixed("left", "x"),), name="bar"),
        Body(walls(), STEEL, supports=(Fixed("faces"), Fixed("backs")), name="walls"),
    )
    return Problem(bodies, (Contact((0, "ends"), (1, "faces"), reach=1.0),))


def walls() -> MeshData:
    """Facet groups: faces, to the bar, and backs."""
    lower, upper = (rectangle(1.0, 1.0, 1, 1, origin=(0.0, y)) for y in (-1.0, LENGTH + 2.0 * GAP))
    count = len(lower.points)
    facets = {
        "faces": np.concatenate([lower.facets["top"], upper.facets["bottom"] + count]),
        "backs": np.concatenate([lower.facets["bottom"], upper.facets["top"] + count]),
    }
    points, cells = np.concatenate([lower.points, upper.points]), np.concatenate([lower.cells, upper.cells + count])
    return MeshData(points, lower.shape, lower.order, cells, facets, {"body": np.arange(2)})


def bounced(setting: Setting, impacts: int) -> Bounces:
    """Until there have been so many impacts, or less than LEAST of the energy is left."""
    run = Transient(problem(), setting.method, InitialState(velocities={0: (0.0, -SPEED)}))
    energy, touching, met, systems = [1.0], [np.zeros(2, dtype=bool)], 0, 0
    while met < impacts and energy[-1] > LEAST:
        moment = run.solve()
        contact, systems = moment.solution.contacts[0], systems + moment.systems
        above = contact.points[:, 1] > 0.5 * LENGTH
        energy.append(moment.energy.total / (0.5 * STEEL.density * LENGTH * SPEED**2))
        touching.append(np.array([(contact.pressure[side] > 0.0).any() for side in (~above, above)]))
        met += int((touching[-1] & ~touching[-2]).sum())
    return Bounces(np.array(energy), np.array(touching), systems / (len(energy) - 1))
