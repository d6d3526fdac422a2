"""A gear pair over time against the same time steps on all degrees of freedom of both whole gears.

Two small steel gears in 2D, coarsely meshed, so fast that their teeth part and meet again. The whole gears have no
modes, no sectors, no condensation and no renumbered teeth: mass and stiffness of all teeth, the bore held in the
rotating frame, in one sparse matrix with the rotation ψ; contact by an active set of quadrature points. Both have the
searched contacts and the weights of the time scheme in common.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from itertools import islice

import numpy as np
import pytest
import scipy.sparse as sp
from mpi4py import MPI
from scipy.sparse.linalg import SuperLU, splu

from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.contact.nitsche.flux_recovery import SAFETY
from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.dynamics.modes.gear_modes import ModeChoice, gear_modes
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.transient.certificates import Unbalanced
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import Drive, MovingPair
from evolvent.dynamics.transient.pair_step import SearchedContact
from evolvent.dynamics.transient.pair_transient import PairTransient
from evolvent.dynamics.transient.quasi_static_start import BEFORE, quasi_static_starts
from evolvent.fem.body import Body
from evolvent.fem.mass_matrix import mass_matrix
from evolvent.gears.condensed_gear import GearBody, matching_cuts
from evolvent.gears.full_gear import whole_mesh, whole_system
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.kinematics import spin
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import scene_from_text
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.rotation import turn
from tests.support.gear_cases import QUIET

PAIR = """
[pair]
normal_module_mm = 3.0
normal_pressure_angle_deg = 20.0
helix_angle_deg = 0.0
[pinion]
teeth = 15
face_width_mm = 8
bore_diameter_mm = 16
[wheel]
teeth = 16
face_width_mm = 8
bore_diameter_mm = 18
[mesh]
level = "quick"
order = 1
elements_per_contact_width = 0.5
[load]
torque_Nm = 40
"""
RPM, POSITIONS, STEPS = 20_000.0, 20, 30
SCHEME, MESH_DAMPING = TimeScheme(0.5), 0.02  # N·s/mm²


def eighty_nodes(problem: GearProblem, member: Member) -> MeshData:
    """A sector so coarse that all modes of the ring can be computed."""
    return gear_mesh(problem, member, lambda usual: replace(
        usual, profile_elements=6, neck_elements=2, fillet_elements=4, back_elements=4, core_elements=2, rim_elements=2
    ))


@cache
def condensed() -> GearModel:
    """Searched over the whole flanks, whose cells are longer than a window."""
    model = prepare_model(gear_problem(scene_from_text(PAIR, QUIET)), MPI.COMM_SELF, eighty_nodes).model
    return replace(model, half_width=np.inf)


def transient(per_harmonic: int) -> PairTransient:
    """Both gears are free; modes are not damped, the mesh is, with flanks apart, too."""
    model = condensed()
    pinion, wheel = (gear_modes(body, ModeChoice(0.0, per_harmonic)) for body in model.bodies)
    torques = model.load.torque, model.load.torque * model.pair.ratio
    drive = Drive.free(model.pair.ratio, (pinion.moment_of_inertia, wheel.moment_of_inertia), torques)
    pair = MovingPair(model, (pinion, wheel), drive, 0.0, MESH_DAMPING, damping_in_separation=True)
    return PairTransient(pair, 0.0, MeshSpeed(RPM, model.pair.pinion.z), SCHEME, KeptContacts(pair, POSITIONS, 1))


@dataclass(frozen=True)
class Course:
    """What a pair did, after each time step."""

    force: Floats
    """Of the mesh [N/mm]."""
    error: Floats
    """Of transmission [mm]."""


def by_modes(per_harmonic: int) -> Course:
    """As `evolvent transient` computes it."""
    fast = transient(per_harmonic)
    (start,) = quasi_static_starts(fast.pair, fast.contacts.step_angle, [0.0])
    moments = list(islice(fast.run(start.at(fast.time_step), 1 + STEPS // POSITIONS), STEPS))
    errors = [moment.result.transmission_error for moment in moments]
    return Course(np.array([moment.mesh_force for moment in moments]), np.array(errors))


class WholeGear:
    """All free degrees of freedom of a gear, N of them, in its rotating frame."""

    def __init__(self, body: GearBody) -> None:
        z, d = body.gear.z, body.d
        mesh = whole_mesh(body.mesh, matching_cuts(body.mesh, 2.0 * np.pi / z), z)
        system = whole_system(mesh, body.material, z, range(z), SAFETY if body.stabiliser is not None else None)
        free, M = system.free, mass_matrix(Body(mesh, body.material))
        r = spin(mesh.points[:, :d], np.zeros(d)).ravel()
        self.member, self.z, self.d, self.nodes = body.member, z, d, len(body.flank.points)
        self.stiffness, self.mass = (A[free][:, free].tocsc() for A in (system.stiffness.tocsr(), M))
        self.spun, self.inertia = (M @ r)[free], float(r @ (M @ r))
        self.flanks = system.functionals[:, free].tocsr()

    def jumps(self, at: SearchedContact, pitches: int) -> sp.csr_matrix:
        """(n, N) normal jumps of a position so many angular pitches on."""
        turned, rows = turn(self.member.sign * 2.0 * np.pi * pitches / self.z, self.d), []
        for t, E in zip(at.contact.geometry.teeth, at.contact.geometry.jump_maps(self.member, 1)):
            nodes = t.coupled_nodes(self.member)
            moved = sp.kron(sp.eye(len(nodes)), turned) @ self._flank(self.member.sign * (t.tooth - pitches), nodes)
            rows.append(sp.csr_matrix(E.jumps(np.eye(moved.shape[0]))) @ moved)
        return sp.vstack(rows).tocsr()

    def bent(self, result: PositionResult) -> Floats:
        """Displacements (N,) of a static position."""
        rows = (result.pinion_rows, result.wheel_rows)[self.member]
        forces = (result.pinion_forces, result.wheel_forces)[self.member]
        return np.asarray(splu(self.stiffness).solve(self._flank(*rows.T).T @ forces.ravel()))

    def _flank(self, teeth: Ints | int, nodes: Ints) -> sp.csr_matrix:
        """Displacements of nodes (k,) of flanks, (k·d, N)."""
        first = (teeth % self.z * self.nodes + nodes) * self.d
        return self.flanks[(first[:, None] + np.arange(self.d)).ravel()]


class WholePair:
    """Both gears and ψ: coordinates z = (u_1, u_2, ψ)."""

    def __init__(self, fast: PairTransient) -> None:
        """fast: of which speed, drive and searched contacts are taken."""
        drive = fast.pair.drive
        self.fast, self.gears = fast, [WholeGear(body) for body in fast.pair.model.bodies]
        across = np.concatenate([share * gear.spun for share, gear in zip(drive.shares, self.gears)])
        inertia = sum(share**2 * gear.inertia for share, gear in zip(drive.shares, self.gears))
        inside = sp.block_diag([gear.mass for gear in self.gears])
        self.mass = sp.bmat([[inside, across[:, None]], [across[None], [[inertia]]]]).tocsc()
        self.stiffness = sp.block_diag([*(gear.stiffness for gear in self.gears), [[0.0]]]).tocsc()
        self.damping = np.append(np.zeros(len(across)), MESH_DAMPING * fast.pair.lever**2)
        self.load = np.append(np.zeros(len(across)), drive.torque)

    def run(self) -> Course:
        """Time steps from statics at rotation 0."""
        s, h, M, D = SCHEME, self.fast.time_step, self.mass, self.damping
        inertia, rate = (1.0 - s.alpha) / (s.beta * h**2), s.gamma / (s.beta * h)
        A = splu((inertia * M + rate * sp.diags(D) + self.stiffness).tocsc())
        before, z = self._static()
        v, a, course = (z - before) / h, np.zeros(len(z)), []
        for n in range(1, STEPS + 1):
            drifted, coasted = z + h * v + h**2 * (0.5 - s.beta) * a, v + h * (1.0 - s.gamma) * a
            b = self.load + M @ (inertia * drifted - s.alpha * a) + D * (rate * drifted - coasted)
            pitches, phase = divmod(n, POSITIONS)
            step = WholeStep(self.gears, A, b, pitches)
            at, found = self.fast.contacts.solved(phase, float(z[-1] + h * v[-1]), step.solved)
            z = A.solve(b - step.jumps(at).T @ found.force[:, 0])
            a = (z - drifted) / (s.beta * h**2)
            v = coasted + s.gamma * h * a
            course.append((float(at.turned @ found.force[:, 0]) / self.fast.pair.lever, z[-1] * self.fast.pair.lever))
        return Course(*np.transpose(course))

    def _static(self) -> tuple[Floats, Floats]:
        """z of the position before rotation 0 and of that at 0."""
        pair, angles = self.fast.pair, self.fast.contacts.step_angle * np.arange(-BEFORE, 1)
        before, now = list(sweep_pitch(pair.model, Pitch(tuple(angles.tolist())), [0.0], initial_state([0.0])))[-2:]
        return self._bent(before.results[0]), self._bent(now.results[0])

    def _bent(self, result: PositionResult) -> Floats:
        ψ = self.fast.pair.drive.of(result.stand.beyond_nominal, self.fast.pair.base_radii)
        return np.append(np.concatenate([gear.bent(result) for gear in self.gears]), ψ)


@dataclass(frozen=True)
class WholeStep:
    """A z = b − Bᵀ f."""

    gears: list[WholeGear]
    factor: SuperLU
    known: Floats
    pitches: int

    def jumps(self, at: SearchedContact) -> sp.csr_matrix:
        """B (n, 2N + 1)."""
        return sp.hstack([*(gear.jumps(at, self.pitches) for gear in self.gears), at.turned[:, None]]).tocsr()

    def solved(self, at: SearchedContact) -> Equilibrium:
        """Contact forces and ψ."""
        B = self.jumps(at)
        U, alone = self.factor.solve(B.T.toarray()), self.factor.solve(self.known)
        λ = pressure(at, B @ U, B @ alone - at.turned * at.searched)[:, None]
        f = at.contact.operator.forces(λ)
        return Equilibrium(f, λ, alone[-1:] - U[-1] @ f - at.searched, np.zeros_like(f), 0, 0.0)


def pressure(at: SearchedContact, C: Floats, free: Floats) -> Floats:
    """λ (q,) at the points, of jumps (n,) without it and the compliance C (n, n)."""
    op = at.contact.operator
    N, γ, w = op.shape.toarray(), op.stabiliser[:, 0], op.weights
    on = N @ free > op.gap
    for _ in range(50):
        λ, G = np.zeros(len(w)), N[on]
        λ[on] = np.linalg.solve(np.diag(1.0 / γ[on]) + G @ C @ (G.T * w[on]), G @ free - op.gap[on])
        trial = N @ (free - C @ (N.T @ (w * λ))) - op.gap
        if np.array_equal(trial > 0.0, on):
            return λ
        on = trial > 0.0
    pytest.fail("the active set does not settle")


@cache
def by_full_matrices() -> Course:
    return WholePair(transient(0)).run()


def test_teeth_part_and_meet() -> None:
    """What is compared below is far from statics: force from nothing to more than twice the load."""
    force, drive = by_full_matrices().force, transient(0).pair
    assert force.min() == 0.0
    assert force.max() > 2.0 * drive.drive.torque / drive.lever


def test_all_modes_are_the_whole_gears() -> None:
    """With all 4402 modes: mesh force and transmission error to 1e-9 of their largest, over a pitch and a half, at the
    end of which the teeth have other numbers."""
    wanted, found = by_full_matrices(), by_modes(10_000)
    assert np.abs(found.force - wanted.force).max() < 1e-9 * wanted.force.max()
    assert np.abs(found.error - wanted.error).max() < 1e-9 * np.abs(wanted.error).max()


def test_a_few_modes_converge_to_them() -> None:
    """One, two and three modes of each harmonic: mesh forces nearer and nearer to those of the whole gears, the first
    within 2 % of the largest, the last within 0.2 %. With none the exchange of energy is off by 5.2 %, and refused."""
    wanted = by_full_matrices().force
    errors = [np.abs(by_modes(count).force - wanted).max() / wanted.max() for count in (1, 2, 3)]
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2]
    assert errors[0] < 0.02 and errors[2] < 0.002
    with pytest.raises(Unbalanced, match="energy balance"):
        by_modes(0)
