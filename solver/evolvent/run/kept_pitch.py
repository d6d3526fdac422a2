"""The pitch of a scene: solved, certified, stored; again on deflected flanks where energy is not conserved."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from evolvent.gears.gear_model import GearModel, Mesher, Preparation
from evolvent.gears.line.line_sweep import line_sweep
from evolvent.gears.meshed_gear import MeshedGear, meshed_gear
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.solution.certificates import balance_error
from evolvent.gears.solution.certified_pitch import CertifiedPitch, certified
from evolvent.gears.sweep.companion_pitch import companion_pitch
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic, transmission_errors
from evolvent.gears.sweep.pitch_sweep import Pitch, SweepState, SweptPosition, initial_state, joined, uniform_pitch
from evolvent.results.archive.archive import COARSE, Archive
from evolvent.results.archive.gear_shapes import MeshRecord
from evolvent.results.archive.run_cost import Cost, Timings, write_cost
from evolvent.results.error_bars.compared import keys
from evolvent.results.run_data import RunData, archived_run
from evolvent.run.call import Call
from evolvent.run.progress import ERROR_BARS, POSITIONS
from evolvent.scene.gear_problem import gear_options, gear_problem, shares_gears
from evolvent.scene.scene import Scene
from evolvent.scene.skips import with_deflected_flanks
from evolvent_meshes.gears.member import Member


@dataclass(frozen=True)
class Meshes:
    """Meshes on which a pitch is solved, and where its positions are stored."""

    mesh: Mesher = run_mesh
    """Makes the mesh of a gear's sector."""
    part: str = ""
    """Part of the archive: empty for the results that are reported, or `COARSE`."""
    problem: Callable[[Scene], GearProblem] = gear_problem
    """Makes the gear problem of a scene."""
    stored_as: Callable[[Scene], Scene] = lambda scene: scene
    """Makes a scene with all that the positions depend on; they are resumed whatever else differs."""
    thinned: bool = False
    """Whether every second position is solved, where `companion_pitch` says that it is enough."""

    @property
    def stage(self) -> str:
        """Stage of the positions in the progress display."""
        return ERROR_BARS if self.part.startswith(COARSE) else POSITIONS


OWN = Meshes()
"""Meshes of a scene, for the results that are reported."""
COMPANION = Meshes(companion_mesh, COARSE, thinned=True)
"""Meshes of twice the element size, for error bars of a pitch's figures."""
STORED = "results/state.npz", "results/gears.npz", "results/position_*.npz", f"results/{COARSE}*.npz"
"""Patterns of the files with the positions of both."""


@dataclass(frozen=True)
class KeptPitch:
    """A certified pitch whose positions are stored."""

    scene: Scene
    """Scene that the positions belong to: as asked, or on deflected flanks."""
    archive: Archive
    """Archive of the positions."""
    solved: CertifiedPitch
    """Positions of the pitch, on all ranks."""
    meshes: MeshRecord
    """Meshes that the positions were solved on."""
    timings: Timings
    """Wall time of the solution [s]."""
    gears: Preparation | None
    """Condensed gears; None where all positions had been stored before, or where frictions do not share them."""

    def run_data(self) -> RunData:
        """The pitch with its figures. On rank 0 alone. Raises ArchiveError."""
        return replace(archived_run(self.archive), scene=self.scene)


@dataclass(frozen=True)
class ResumePoint:
    """Positions that an earlier call has completed, and the state of its sweep."""

    positions: tuple[SweptPosition, ...] = ()
    """The completed positions in the order of their solution."""
    state: SweepState | None = None
    """State of the sweep after these positions; None where there are none."""

    @property
    def is_end(self) -> bool:
        """Whether no position is left to be solved."""
        return bool(self.positions) and self.positions[-1].closes


def kept_pitch(call: Call, scene: Scene, meshes: Meshes = OWN) -> KeptPitch:
    """Solves and stores all positions of a scene that are not stored yet. The positions belong to the scene or, where
    the energy of its pitch does not balance, to the same scene on deflected flanks.

    Collective. Raises NotConverged, SearchError, BalanceError, MeshError, ArchiveError, WriteError, on all ranks.
    """
    solved = call.on_first(lambda: scene_to_solve(call, scene, meshes))
    completed = call.on_first(lambda: resume_point(call, solved, meshes))
    sweeps: list[_Sweep] = []

    def swept(_: bool) -> Iterator[SweptPosition]:
        sweeps.append(sweeps[-1].deflected() if sweeps else _Sweep(call, solved, meshes, completed))
        return sweeps[-1].generate()

    pitch = certified(swept, gear_options(solved).deflected_flanks, lambda position: sweeps[-1].keep(position))
    last = sweeps[-1]
    assert last.record is not None
    timings = sum((each.timings for each in sweeps), Timings())
    return KeptPitch(last.scene, last.archive, pitch, last.record, timings, last.gears)


def resume_point(call: Call, scene: Scene, meshes: Meshes) -> ResumePoint:
    """Where the call goes on. On rank 0 alone. Raises ArchiveError where the results belong to another scene."""
    pair, archive = scene.gear_pair(), call.archive(meshes.stored_as(scene), meshes.part)
    state = archive.read_state(pair) if call.resume else None
    return ResumePoint() if state is None else ResumePoint(tuple(archive.read_sweep(pair)), state)


def require_resumable(scene: Scene, folder: Path, command: str, part: str = "", listed: Scene | None = None) -> None:
    """Raises ArchiveError where stored positions belong neither to a scene nor to it on deflected flanks. listed: scene
    with all torques, of which this is one; the message names its keys."""
    archives = [Archive(folder, each, command, part) for each in (with_deflected_flanks(scene), scene)]
    if not any(archive.holds_scene() for archive in archives):
        Archive(folder, listed or scene, command, part).read_state(scene.gear_pair())


def scene_to_solve(call: Call, scene: Scene, meshes: Meshes) -> Scene:
    """The scene, on deflected flanks where the call to be resumed had switched to them. On rank 0 alone."""
    deflected = with_deflected_flanks(scene)
    archive = call.archive(meshes.stored_as(deflected), meshes.part)
    return deflected if call.resume and archive.holds_scene() else scene


class _Sweep:
    """One sweep over a scene's pitch. `generate` solves the positions, `keep` stores each once it is certified.

    All friction coefficients share the gears and the search. Where the scene switches that off, each coefficient has
    its own gears and is solved alone; the positions are put together at the end, because pitches at different
    coefficients close after different numbers of positions.

    call, scene, meshes: what is computed.
    resume: completed positions.
    gears: condensed before for this scene, None to condense them.
    """

    def __init__(
        self, call: Call, scene: Scene, meshes: Meshes, resume: ResumePoint, gears: Preparation | None = None
    ) -> None:
        self.call, self.scene, self.meshes = call, scene, meshes
        self.archive, self.groups = call.archive(meshes.stored_as(scene), meshes.part), friction_groups(scene)
        together = len(self.groups) > 1 and not resume.is_end  # the groups end together
        self.resume = ResumePoint() if together else resume
        self.pitch = _pitch_to_sweep(scene, meshes, [each.angle for each in self.completed])
        self.gears, self.kept = gears, 0
        self.record: MeshRecord | None = None
        self.preparing, self.timings = Timings(), Timings()

    def generate(self) -> Iterator[SweptPosition]:
        """Completed positions, then the missing ones, as they are solved. Collective."""
        yield from self.completed
        if self.resume.is_end:  # the gears need not be condensed
            self.record = self.call.on_first(self._reopen)
            return
        if self.completed:
            self.call.log.info("resumed after %d positions", len(self.completed))
        begin = time.perf_counter()
        solved = self._group(self.groups[0]) if len(self.groups) == 1 else self._joined_groups()
        for position in solved:
            self.timings = self.preparing.then_solved(time.perf_counter() - begin)
            yield position
        self.timings = self.preparing.then_solved(time.perf_counter() - begin)

    def keep(self, position: SweptPosition) -> None:
        """Stores and logs a position of `generate`, unless it has been stored before. Collective; raises WriteError,
        FolderError."""
        self.kept += 1
        if self.kept <= len(self.completed):
            return
        memory = self.call.memory_MB()
        self.call.on_first(partial(self._store, self.kept - 1, position, memory))
        self.call.progress.advance(more=not position.closes)

    def deflected(self) -> _Sweep:
        """The sweep to make after this one, on the same gears, where its energy does not balance."""
        gears, call = self.gears, replace(self.call, earlier=self.call.earlier + Cost(self.timings))
        if gears is not None:
            gears = replace(gears, model=replace(gears.model, deflected=True))
        return _Sweep(call, with_deflected_flanks(self.scene), self.meshes, ResumePoint(), gears)

    @property
    def completed(self) -> Sequence[SweptPosition]:
        """Positions that are stored already."""
        return self.resume.positions

    def _group(self, group: slice) -> Iterator[SweptPosition]:
        """The missing positions at some of the friction coefficients."""
        gears, frictions = self._prepared(), self.scene.contact.friction[group]
        self.call.progress.stage(self.meshes.stage, len(self.pitch.angles), len(self.completed))
        if gears.is_line:
            yield from line_sweep(gears, self.pitch, frictions, self.call.comm, len(self.completed))
            return
        state = self.resume.state or initial_state(frictions)
        before = [transmission_errors(position, frictions) for position in self.completed]
        yield from sweep_until_periodic(gears, self.pitch, frictions, state, self.call.comm, before)

    def _joined_groups(self) -> Iterator[SweptPosition]:
        """The pitch at all friction coefficients, from the positions of each group."""
        groups = [one_pitch(list(self._group(group))) for group in self.groups]
        pitch = [joined(parts) for parts in zip(*groups, strict=True)]
        for position in pitch:
            yield replace(position, again=False, closes=position is pitch[-1])

    def _prepared(self) -> GearModel:
        """Condenses the gears and prepares the folder for positions on their meshes."""
        gears = self.gears
        if gears is None:
            gears = self.call.gears(self.meshes.problem(self.scene), self.meshes.mesh, shown=not self.meshes.part)
            self.preparing += timings_of(gears)
            self.gears = gears if len(self.groups) == 1 else None
        if self.record is None:
            self.record = record = MeshRecord.of([MeshedGear.of(body) for body in gears.model.bodies])
            self.call.on_first(lambda: self._open(record))
        return gears.model

    def _open(self, record: MeshRecord) -> None:
        """Prepares the folder. Raises ArchiveError where stored positions belong to other meshes; OSError."""
        if self.completed:
            self.archive.check_gears(record.shapes)
        if not self.meshes.part:
            self.call.begin(self.scene, resumed=bool(self.completed))
        if not self.completed:
            self.archive.write_gears(record.shapes)

    def _reopen(self) -> MeshRecord:
        """Goes on in a folder with all positions. Raises ArchiveError where they belong to other meshes."""
        record = checked_meshes(self.meshes.problem(self.scene), self.archive, self.meshes.mesh)
        if not self.meshes.part:
            self.call.begin(self.scene, resumed=True)
            self.call.log.info("resumed after all of %d positions", len(self.completed))
        return record

    def _store(self, index: int, position: SweptPosition, memory: float) -> None:
        """Stores and logs a position. On rank 0 alone. Raises WriteError, FolderError."""
        self.archive.write_position(index, position)
        if not self.meshes.part:
            write_cost(self.call.folder, self.call.cost(self.timings, memory))
            self.call.log.info(_log_line(position))


def checked_meshes(problem: GearProblem, archive: Archive, mesh: Mesher = run_mesh) -> MeshRecord:
    """The meshes of a problem. Raises ArchiveError where the stored positions belong to other meshes."""
    record = MeshRecord.of([meshed_gear(problem, member, mesh) for member in Member])
    archive.check_gears(record.shapes)
    return record


def timings_of(preparation: Preparation) -> Timings:
    """Wall time of a preparation [s]."""
    parts = preparation.mesh_seconds, preparation.assemble_seconds, preparation.condense_seconds
    return Timings(*parts, total=preparation.mesh_seconds + preparation.seconds)


def friction_groups(scene: Scene) -> list[slice]:
    """The friction coefficients that share gears, search and compliance: all in one group, or each in its own."""
    count = len(scene.contact.friction)
    return [slice(0, count)] if shares_gears(scene) else [slice(i, i + 1) for i in range(count)]


def pitch_of(scene: Scene, problem: Callable[[Scene], GearProblem] = gear_problem) -> Pitch:
    """The pinion rotations that a scene asks for, in the order in which the gears pass them. problem: makes its gear
    problem."""
    pitches, driving = problem(scene).pitches, Member.named(scene.load.driving)
    return uniform_pitch(scene.pinion.teeth, scene.sweep.positions, pitches, driving)


def _pitch_to_sweep(scene: Scene, meshes: Meshes, stored: Sequence[float]) -> Pitch:
    """The positions of a scene on these meshes. stored: angles that are there; earlier versions thinned no pitch."""
    whole = pitch_of(scene, meshes.problem)
    thinned = companion_pitch(whole, meshes.problem(scene).is_plane) if meshes.thinned else whole
    return thinned if set(keys(stored)) <= set(keys(thinned.angles)) else whole


def _log_line(position: SweptPosition) -> str:
    """Angle, iterations, balance and wall time of a position."""
    first = position.results[0]
    iterations = max(r.iterations for r in position.results)
    worst = max(balance_error(r) for r in position.results)
    seconds = sum(r.seconds for r in position.results)
    kind = "again   " if position.again else "position"
    return f"{kind} {first.stand.angle:9.5f} rad: at most {iterations} iterations, balance {worst:.1e}, {seconds:.2f} s"
