"""Transient cases of a scene, every speed at every friction coefficient, on one kind of meshes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial

from mpi4py import MPI

from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.dynamics.modes.ring_modes import harmonics
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.pair_model import DriveSettings
from evolvent.dynamics.transient.back_flanks import require_backlash
from evolvent.dynamics.transient.certificates import certify_motion
from evolvent.dynamics.transient.divided_steps import UNDIVIDED, DividedSteps
from evolvent.dynamics.transient.driven_pair import LEAST, driven_pair, loaded_as_static, resolved_modes
from evolvent.dynamics.transient.kept_contacts import ContactStore, KeptContacts
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_transient import PairState, PairTransient
from evolvent.dynamics.transient.quasi_static_start import quasi_static_starts
from evolvent.dynamics.transient.start_from_rest import start_from_rest
from evolvent.dynamics.transient.steady_state import MeshPeriods, until_steady
from evolvent.fem.parallel.machine import machine_megabytes
from evolvent.fem.parallel.ranks import together
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.run.call import Call
from evolvent.run.dynamics.transient.checks import transient_section
from evolvent.run.dynamics.transient.kept_cases import KeptCases
from evolvent.run.kept_pitch import KeptPitch, Meshes, kept_pitch
from evolvent.run.progress import ERROR_BARS, Progress
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent_meshes.errors import EvolventError

MODES, STEPS = "natural modes", "mesh periods"
KEPT = 0.4
"""Share of the machine's memory for the kept contacts of positions, beside the gears."""
FIRST = 2
"""Number of mesh periods from rest that are reported."""
Motion = MeshPeriods | None
"""Computed mesh periods of a case; None where it failed."""
Found = Mapping[int, MeshPeriods | str]
"""Number of a case -> its computed mesh periods, or the reason why it failed."""


def one_pitch(scene: Scene) -> GearProblem:
    """The gear problem of a scene over a single pitch, which is the period of its motion."""
    problem = gear_problem(scene)
    return replace(problem, options=replace(problem.options, whole_engagement=False))


def statics_scene(scene: Scene) -> Scene:
    """The scene with all that positions without inertia depend on."""
    return scene.model_copy(update={"transient": None, "dynamics": None})


@dataclass(frozen=True)
class PairMeshes:
    """Meshes and natural modes of a vibrating gear pair."""

    meshes: Meshes
    """Meshes of both gears, and where the positions without inertia are stored."""
    least: int = LEAST
    """Natural modes of each harmonic, at least, where the scene does not say how many."""


OWN = PairMeshes(Meshes(problem=one_pitch, stored_as=statics_scene))
"""Meshes of the results that are reported."""


@dataclass(frozen=True)
class PairCases:
    """Transient cases of a gear pair, one for each speed and friction coefficient, and its static positions. All
    methods are collective."""

    scene: Scene
    """Scene with a section [transient]."""
    problem: GearProblem
    """Gear problem of the scene."""
    pair: MovingPair
    """Gear pair with mass, damping and stiffness on one kind of meshes."""
    static: KeptPitch
    """The pitch without inertia."""
    settings: DriveSettings
    """Inertias, damping and backlash."""
    comm: MPI.Comm
    """Ranks that share the cases."""
    progress: Progress
    """Progress display of this rank's cases."""

    @staticmethod
    def of(call: Call, scene: Scene, settings: DriveSettings, on: PairMeshes, progress: Progress) -> PairCases:
        """Meshes and condenses the gears, solves the missing static positions and computes the natural modes.
        Collective. Raises MeshError, TooMuchRelief, NotConverged, SearchError, BalanceError, ArchiveError, WriteError.
        """
        section, dynamics = transient_section(scene), scene.dynamics or DynamicsSection()
        pitch, problem = kept_pitch(call, scene, on.meshes), on.meshes.problem(scene)
        gears = pitch.gears or call.gears(problem, on.meshes.mesh, shown=not on.meshes.part)
        model = replace(gears.model, deflected=pitch.solved.deflected)
        progress.stage(MODES, sum(len(harmonics(gear.z)) for gear in problem.pair.gears))
        sampled = MeshSpeed(max(section.speeds_rpm), problem.pair.pinion.z).mesh_frequency * scene.sweep.positions  # Hz
        count, density = section.modes_per_harmonic, dynamics.density
        found = partial(resolved_modes, problem, model, density, sampled, count, on.least)
        modes = together(call.comm, lambda: found(lambda: progress.advance(more=True)))
        first, constant_speed = pitch.solved.by_friction[0], section.drive == "constant_speed"
        pair = driven_pair(model, modes, settings, first, section.mode_damping_ratio, constant_speed)
        return PairCases(scene, problem, pair, pitch, settings, call.comm, progress)

    @property
    def tasks(self) -> list[tuple[MeshSpeed, int]]:
        """Speed and index of the friction coefficient of each case."""
        count, teeth = len(self.scene.contact.friction), self.problem.pair.pinion.z
        speeds = [MeshSpeed(speed, teeth) for speed in transient_section(self.scene).speeds_rpm]
        return [(speed, index) for speed in speeds for index in range(count)]

    def loaded(self) -> list[MovingPair]:
        """The pair under its loads at each friction coefficient."""
        return [loaded_as_static(self.pair, results) for results in self.static.solved.by_friction]

    def found(self, kept: KeptCases) -> dict[int, MeshPeriods]:
        """Computes all cases. Missing ones are divided among the ranks; rank 0 returns all, other ranks none. Raises
        NotConverged, SearchError, BackFlanks, Unbalanced, ArchiveError, WriteError, on all ranks."""

        def solved(number: int, transient: PairTransient, start: PairState) -> MeshPeriods:
            found = self._until_steady(transient, start)
            self._check(found, transient)
            return found

        return self._shared(kept, self.contacts(), solved, STEPS)

    def tried(self, kept: KeptCases, contacts: KeptContacts) -> Found:
        """Computes all cases of a companion. A case that fails has its reason instead of a motion. A motion is not
        checked: it need not be one that could be reported. contacts: the positions of its time steps. Raises
        ArchiveError, WriteError."""
        failures: dict[int, str] = {}

        def solved(number: int, transient: PairTransient, start: PairState) -> MeshPeriods | None:
            try:
                return self._until_steady(transient, start)
            except EvolventError as error:
                failures[number] = str(error)
                return None

        found = self._shared(kept, contacts, solved, ERROR_BARS)
        every = self.comm.gather(failures) or []
        return {**found, **{number: reason for each in every for number, reason in each.items()}}

    def contacts(self, steps: int = 1) -> KeptContacts:
        """Store of the contacts at the positions of a mesh period, for all cases of a rank. steps: time steps between
        two positions of the scene."""
        components = self.pair.model.bodies[0].d if any(self.scene.contact.friction) else 1
        most = KEPT * 1e6 * machine_megabytes() / self.comm.size
        return KeptContacts(self.pair, steps * self.scene.sweep.positions, components, ContactStore(most))

    def _shared(
        self, kept: KeptCases, contacts: KeptContacts, solved: Callable[[int, PairTransient, PairState], Motion],
        stage: str,
    ) -> dict[int, MeshPeriods]:
        """Archived and newly solved cases, on rank 0. solved: solves a case by number, transient and initial state.
        stage: name of the stage in the progress display."""
        known = together(self.comm, lambda: kept.read() if self.comm.rank == 0 else {})
        ended = self.comm.bcast(set(known))
        missing = [number for number in range(len(self.tasks)) if number not in ended]

        def own() -> dict[int, MeshPeriods]:
            found: dict[int, MeshPeriods] = {}
            numbers = missing[self.comm.rank :: self.comm.size]
            if not numbers:
                return found
            most = transient_section(self.scene).mesh_periods
            self.progress.stage(stage, most * len(numbers))
            start = self._starts(contacts)
            for ended, number in enumerate(numbers, 1):
                transient = self._transient(number, contacts)
                motion = solved(number, transient, start(number, transient))
                if motion is not None:
                    kept.write(number, motion)
                    found[number] = motion
                self.progress.reach(most * ended)
            return found

        gathered = self.comm.gather(together(self.comm, own)) or []
        return {number: found for part in (known, *gathered) for number, found in part.items()}

    def _starts(self, contacts: KeptContacts) -> Callable[[int, PairTransient], PairState]:
        """Function that makes the initial state of a case. Raises NotConverged, SearchError."""
        if self._from_rest:
            return lambda _, case: start_from_rest(case.pair, self.problem, case.speed.rad_s, case.friction)
        statics = quasi_static_starts(self.pair, contacts.step_angle, list(self.scene.contact.friction))
        return lambda number, case: statics[self.tasks[number][1]].at(case.time_step)

    @property
    def _from_rest(self) -> bool:
        return transient_section(self.scene).start == "rest"

    def _transient(self, number: int, contacts: KeptContacts) -> PairTransient:
        speed, index = self.tasks[number]
        scheme = TimeScheme(transient_section(self.scene).spectral_radius)
        friction = self.scene.contact.friction[index]
        pair = loaded_as_static(self.pair, self.static.solved.by_friction[index])
        return PairTransient(pair, friction, speed, scheme, contacts, self._division(contacts))

    def _division(self, contacts: KeptContacts) -> DividedSteps:
        """Rule by which steps between two positions are divided. Between positions that are closer than the scene's,
        steps are to be shorter by as much: their error goes with the square of their length."""
        section, closer = transient_section(self.scene), contacts.positions / self.scene.sweep.positions
        if section.tolerance is None:
            return UNDIVIDED
        return DividedSteps(section.tolerance / closer**2, section.most_parts.bit_length() - 1)

    def _until_steady(self, transient: PairTransient, start: PairState) -> MeshPeriods:
        """Mesh periods of a transient until it is steady. Raises NotConverged, SearchError, Unbalanced."""
        section = transient_section(self.scene)
        first = FIRST if self._from_rest else 0
        shown = self.progress.advance
        return until_steady(transient, start, section.mesh_periods, section.steady_change, first, shown)

    def _check(self, found: MeshPeriods, transient: PairTransient) -> None:
        """Certifies a motion. Raises BackFlanks where back flanks touch, Unbalanced where force or energy are out of
        balance."""
        require_backlash(found.lowest_error, self.settings.backlash, transient.name)
        if found.is_steady:
            load, energies = transient.pair.drive.torque / transient.pair.lever, found.energies
            certify_motion(found.mean_force / load, energies.left / energies.passed, transient.name)
