"""The problem, what is kept of its solution, and Evolvent's.

A steel block of 4 × 10 mm flies with 1 m/s against the middle of one of 8 × 6 mm that is held below, in plane strain,
without friction. First-order quadrilaterals, whose nodes do not meet across the contact.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from evolvent import Body, Contact, Fixed, InitialState, Material, Problem, Transient, TransientSettings
from evolvent_meshes.arrays import Floats
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import rectangle

STEEL = Material(210e3, 0.3, density=7.85e-9)
SPEED, GAP = 1000.0, 1.25e-4
"""Of the flying block [mm/s], and how far it has to fly [mm]."""
ALL = 1_000_000
"""More modes than a body has."""
WINDOW = 5e-7
"""Over which forces are averaged [s]: those of single steps have the vibration of single cells and of the penalty."""


def hammer(cells: int) -> MeshData:
    """The flying block. cells: across it."""
    return rectangle(4.0, 10.0, cells, 5 * cells // 2, order=1, origin=(2.0, GAP))


def anvil(cells: int) -> MeshData:
    """The other one, with cells that are larger by a fifth, about."""
    return rectangle(8.0, 6.0, 13 * cells // 8, 5 * cells // 4, order=1, origin=(0.0, -6.0))


@dataclass(frozen=True)
class Blow:
    """Both meshes and the time steps."""

    time_step: float
    """h [s]."""
    steps: int
    """How many."""
    bodies: tuple[MeshData, MeshData] = field(default_factory=lambda: (hammer(8), anvil(8)))
    """The flying block and the one that is held at its group "bottom"."""
    spectral_radius: float = 0.8
    """ρ_∞ of the time integration."""

    @property
    def energy(self) -> float:
        """Of the flight [N]."""
        return 0.5 * STEEL.density * 40.0 * SPEED**2


@dataclass(frozen=True)
class ForceCourse:
    """The contact force over the time steps that a program came through."""

    time_step: float
    """h [s]."""
    force: Floats
    """(n,) at the ends of steps [N/mm]."""
    energy: float
    """Kinetic and elastic energy at the end, over that of the flight."""

    @property
    def times(self) -> Floats:
        """(n,) [s]."""
        return self.time_step * np.arange(1, len(self.force) + 1)

    @property
    def contact(self) -> tuple[float, float]:
        """When the first step with a force ends, and the last one [s]."""
        pressed = self.times[self.force != 0.0]
        return float(pressed[0]), float(pressed[-1])

    @property
    def impulse(self) -> float:
        """[N·s/mm]."""
        return self.time_step * float(self.force.sum())

    @property
    def mean(self) -> Floats:
        """(n,) force averaged over WINDOW about each step."""
        count = round(WINDOW / self.time_step)
        return np.convolve(self.force, np.full(count, 1.0 / count), "same")

    def difference(self, other: ForceCourse) -> float:
        """Of the averaged forces, over the largest of the other's."""
        return float(np.abs(self.mean - other.mean).max() / other.mean.max())


def by_evolvent(blow: Blow, modes: int) -> ForceCourse:
    """modes: natural modes of each body. Raises what `Transient.solve` does."""
    upper, lower = (Body(mesh, STEEL, supports) for mesh, supports in zip(blow.bodies, ((), (Fixed("bottom"),))))
    problem = Problem((upper, lower), (Contact((0, "bottom"), (1, "top"), reach=1.0),))
    settings = TransientSettings(blow.time_step, modes, spectral_radius=blow.spectral_radius)
    start = InitialState(velocities={0: (0.0, -SPEED)})
    moments = list(Transient(problem, settings, start).run(blow.steps))
    force = np.abs([moment.solution.contacts[0].force[1] for moment in moments])
    return ForceCourse(blow.time_step, force, moments[-1].energy.total / blow.energy)
