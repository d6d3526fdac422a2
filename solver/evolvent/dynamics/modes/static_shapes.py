"""Static shapes of an elastic gear body for the vibration of a pair, from one sector, harmonic by harmonic.

Load-dependent Ritz vectors (Wilson, Yuan and Dickens, Earthquake Eng. Struct. Dyn. 10 (1982) 813-821), the bore held:

    u_1 = K⁻¹ f ,   u_2 = K⁻¹ M r ,   u_3 = K⁻¹ M u_1 ,

f the mesh force in the mean over a pitch (`mean_load`), r the gear's turn as a rigid body. Three of them have the
natural frequency of a pair within 0.3 % (tests/solver/dynamics/modes/test_static_shapes.py).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent.dynamics.modes.cyclic_stiffness import CyclicStiffness, Numbers
from evolvent.dynamics.modes.gear_modes import sector_matrices
from evolvent.dynamics.modes.mean_load import mean_load
from evolvent.dynamics.modes.mode_meshes import body_mesh
from evolvent.dynamics.modes.ring_modes import SectorMatrices, harmonics, phase_of
from evolvent.dynamics.pair_model import RIGID, DriveSettings
from evolvent.dynamics.small_system import GearShapes
from evolvent.fem.surface import surface_of
from evolvent.gears.condensed_gear import sector_body
from evolvent.gears.kinematics import spin
from evolvent.gears.problem.gear_inertia import check_density, refuse_light_gears
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.input_checks import instance

SHAPES = 3


def static_shapes(problem: GearProblem, member: Member, density: float) -> GearShapes:
    """Static shapes, mass and stiffness of one gear whose bore is held in its frame; per mm of face width in 2D.

    density: [t/mm³].

    Raises MeshError, NotPositiveDefinite, OutOfMemory, CompileError, CacheError.
    """
    gear = problem.pair.gears[member]
    sector_of = body_mesh(problem, member)
    material = replace(problem.materials[member], density=density)
    flank, d = surface_of(sector_of, "flank"), sector_of.dimension
    sector, mass, parts = sector_matrices(sector_body(sector_of, material, member), flank, None, gear.z)
    place = np.full(len(mass.indptr) - 1, -1)
    place[parts.free] = np.arange(len(parts.free))
    pressed = (flank.nodes[:, None] * d + np.arange(d)).ravel()
    load = mean_load(problem.pair, member, flank)
    turned = spin(sector_of.points[:, :d], np.zeros(d)).ravel()
    turned *= -np.sign(sum(float(forces.ravel() @ turned[pressed]) for forces in load.values()))  # the mesh closes
    inertia = mass @ turned
    ring = _Ring(sector, gear.z, place[pressed], load, inertia[parts.free])
    moment = gear.z * float(turned @ inertia)
    return ring.shapes(moment, gear.base_radius)


def with_elastic_bodies(settings: DriveSettings, problem: GearProblem, density: float) -> DriveSettings:
    """Settings of a vibration with elastic gear bodies. density: [t/mm³].

    Raises InputError, also for an inertia below that of a body, before anything is meshed, and as `static_shapes`.
    """
    instance("settings", settings, DriveSettings, "write DriveSettings(inertias, damping_ratio, backlash)")
    instance("problem", problem, GearProblem, "give the problem that was condensed")
    check_density(density)
    refuse_light_gears(problem.pair, settings.inertias, density, RIGID)
    width = problem.pair.face_width if problem.is_plane else 1.0
    pinion, wheel = (static_shapes(problem, member, density).scaled(width) for member in Member)
    return replace(settings, bodies=(pinion, wheel))


class _Ring:
    """The ring of sectors under the mesh force and under the inertia of a turn."""

    def __init__(
        self, sector: SectorMatrices, sectors: int, rows: Ints, load: dict[int, Floats], inertia: Floats
    ) -> None:
        """rows: of the sector's matrices (n·d,) on which the load's forces act; inertia: of a sector (N,)."""
        self.sector, self.sectors, self.rows, self.load, self.inertia = sector, sectors, rows, load, inertia

    def shapes(self, moment: float, radius: float) -> GearShapes:
        """Mass, stiffness and approach of the static shapes, summed over all harmonics. moment: of the body [t·mm²;
        t·mm in 2D]. radius: of the base circle [mm]."""
        cyclic = CyclicStiffness(self.sector.stiffness, self.sector.faces)
        mass, stiffness = np.zeros((SHAPES + 1, SHAPES + 1)), np.zeros((SHAPES + 1, SHAPES + 1))
        mass[0, 0], closing = moment, np.append(radius, np.zeros(SHAPES))
        for k in harmonics(self.sectors):
            phase = phase_of(k, self.sectors)
            weight = (1.0 if 2 * k in (0, self.sectors) else 2.0) / self.sectors
            K, M = (self.sector.faces.reduced(each, phase) for each in (self.sector.stiffness, self.sector.mass))
            inverse = cyclic.inverse(phase)
            pressed, spun = self._amplitudes(k, phase)
            first = inverse.solve(pressed)
            second = inverse.solve(spun) if k == 0 else np.zeros_like(first)
            u = np.column_stack([first, second, inverse.solve(M @ first)])
            mass[1:, 1:] += weight * np.real(u.conj().T @ (M @ u))
            stiffness[1:, 1:] += weight * np.real(u.conj().T @ (K @ u))
            closing[1:] -= weight * np.real(pressed.conj() @ u)
            mass[0, 1:] += weight * np.real(spun.conj() @ u)
        mass[1:, 0] = mass[0, 1:]
        return GearShapes(mass, stiffness, closing)

    def _amplitudes(self, k: int, phase: complex) -> tuple[Numbers, Numbers]:
        """Amplitudes of a harmonic on interior and low face: of the mesh force, and of the inertia by a unit
        rotation."""
        forces = np.zeros(len(self.inertia), dtype=np.result_type(phase))
        for tooth, own in self.load.items():
            turned = np.exp(-2j * np.pi * k * tooth / self.sectors)
            np.add.at(forces, self.rows, (turned if np.iscomplexobj(forces) else turned.real) * own.ravel())
        spun = self.sectors * self.inertia if k == 0 else np.zeros_like(self.inertia)
        faces = self.sector.faces
        return faces.gathered(forces, phase), faces.gathered(spun, phase)
