"""The positions of a scene: solved, certified, archived; again on deflected flanks where energy is not conserved."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from evolvent.gears.gear_model import GearModel, Preparation
from evolvent.gears.meshed_gear import MeshedGear
from evolvent.gears.solution.certificates import balance_error
from evolvent.gears.solution.certified_pitch import certified
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic, transmission_errors
from evolvent.gears.sweep.pitch_sweep import Pitch, SweptPosition, initial_state, joined, uniform_pitch
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.gear_shapes import MeshRecord
from evolvent.results.archive.run_cost import Cost, Timings, write_cost
from evolvent.run.context import RunContext
from evolvent.run.progress import POSITIONS
from evolvent.run.start import ResumePoint, checked_meshes, open_archive, prepare_gears, timings_of
from evolvent.scene.gear_problem import gear_options, gear_problem, shares_gears
from evolvent.scene.scene import Scene
from evolvent.scene.skips import with_deflected_flanks


@dataclass(frozen=True)
class SweepRecord:
    """Meshes that positions were solved on, and the wall time that it took."""

    meshes: MeshRecord
    timings: Timings


class ScenePitch:
    """One sweep over a scene's pitch. `generate` solves the positions, `keep` archives each once it is certified.

    All friction coefficients share the gears and the search. Where the scene switches that off, each coefficient has
    its own gears and is solved alone; the positions are put together at the end, because pitches at different
    coefficients close after different numbers of positions.

    run, scene: what is computed.
    resume:     completed positions, None for the beginning.
    gears:      condensed before for this scene, None to condense them.
    """

    def __init__(
        self, run: RunContext, scene: Scene, resume: ResumePoint | None = None, gears: Preparation | None = None
    ) -> None:
        self.run, self.scene, self.archive, self.pitch = run, scene, run.archive(scene), pitch_of(scene)
        self.groups = friction_groups(scene)
        several = len(self.groups) > 1
        self.resume = None if several and resume is not None and not resume.is_end else resume  # they end together
        self.gears, self.kept = gears, 0
        self.meshes: MeshRecord | None = None
        self.preparing, self.timings = Timings(), Timings()

    def generate(self) -> Iterator[SweptPosition]:
        """Completed positions, then the missing ones, as they are solved. Collective."""
        yield from self.completed
        if self.resume is not None and self.resume.is_end:  # the gears need not be condensed
            self.run.log.open()
            self.run.log.info("resumed after all of %d positions", len(self.completed))
            self.meshes = self.run.on_first(lambda: checked_meshes(self.scene, self.archive))
            return
        if self.completed:
            self.run.log.info("resumed after %d positions", len(self.completed))
        begin = time.perf_counter()
        solved = self._group(self.groups[0]) if len(self.groups) == 1 else self._joined_groups()
        for position in solved:
            self.timings = self._timings(begin)
            yield position
        self.timings = self._timings(begin)

    def keep(self, position: SweptPosition) -> None:
        """Archives and logs a position of `generate`, unless it has been archived before. Collective; raises
        WriteError, FolderError."""
        self.kept += 1
        if self.kept <= len(self.completed):
            return
        cost = self.run.cost(self.timings, self.run.memory_MB())
        self.run.on_first(partial(_keep, self.archive, self.kept - 1, position, cost))
        self.run.log.info(_log_line(position))
        self.run.progress.position(position)

    def deflected(self) -> ScenePitch:
        """The sweep to make after this one, on the same gears, where its energy does not balance."""
        gears, run = self.gears, replace(self.run, earlier=self.run.earlier + Cost(self.timings))
        if gears is not None:
            gears = replace(gears, model=replace(gears.model, deflected=True))
        return ScenePitch(run, with_deflected_flanks(self.scene), gears=gears)

    @property
    def completed(self) -> Sequence[SweptPosition]:
        """Positions that are archived already."""
        return () if self.resume is None else self.resume.positions

    def _group(self, group: slice) -> Iterator[SweptPosition]:
        """The missing positions at some of the friction coefficients."""
        gears, frictions = self._prepared(), self.scene.contact.friction[group]
        self.run.progress.stage(POSITIONS, len(self.pitch.angles), len(self.completed))
        state = initial_state(frictions) if self.resume is None else self.resume.state
        before = [transmission_errors(position, frictions) for position in self.completed]
        yield from sweep_until_periodic(gears, self.pitch, frictions, state, self.run.comm, before)

    def _joined_groups(self) -> Iterator[SweptPosition]:
        """The pitch at all friction coefficients, from the positions of each group."""
        groups = [one_pitch(list(self._group(group))) for group in self.groups]
        pitch = [joined(parts) for parts in zip(*groups, strict=True)]
        for position in pitch:
            yield replace(position, again=False, closes=position is pitch[-1])

    def _prepared(self) -> GearModel:
        """Condenses the gears and opens the archive for their meshes."""
        gears = self.gears
        if gears is None:
            gears = prepare_gears(self.run, self.scene)
            self.preparing += timings_of(gears)
            self.gears = gears if len(self.groups) == 1 else None
        if self.meshes is None:
            self.meshes = meshes = MeshRecord.of([MeshedGear.of(body) for body in gears.model.bodies])
            resumed = self.resume is not None
            self.run.on_first(lambda: open_archive(self.scene, self.archive, meshes, resumed))
        return gears.model

    def _timings(self, begin: float) -> Timings:
        """Wall time since `begin`: whatever was not preparation was solving."""
        seconds = time.perf_counter() - begin
        return replace(self.preparing, positions=seconds - self.preparing.total, total=seconds)


def sweep_scene(run: RunContext, scene: Scene, resume: ResumePoint | None) -> tuple[Scene, SweepRecord]:
    """Solves and archives all positions. Returns the scene that they belong to: `scene`, or, where the energy of its
    pitch does not balance, the same scene on deflected flanks.

    Collective; raises what `run_scene` does, on all ranks.
    """
    sweeps: list[ScenePitch] = []

    def swept(_: bool) -> Iterator[SweptPosition]:
        sweeps.append(sweeps[-1].deflected() if sweeps else ScenePitch(run, scene, resume))
        return sweeps[-1].generate()

    certified(swept, gear_options(scene).deflected_flanks, lambda position: sweeps[-1].keep(position))
    last = sweeps[-1]
    assert last.meshes is not None
    return last.scene, SweepRecord(last.meshes, sum((each.timings for each in sweeps), Timings()))


def _keep(archive: Archive, index: int, position: SweptPosition, cost: Cost) -> None:
    """Archives a position. Raises WriteError, FolderError."""
    archive.write_position(index, position)
    write_cost(archive.files, cost)


def friction_groups(scene: Scene) -> list[slice]:
    """The friction coefficients that share gears, search and compliance: all in one group, or each in its own."""
    count = len(scene.contact.friction)
    return [slice(0, count)] if shares_gears(scene) else [slice(i, i + 1) for i in range(count)]


def pitch_of(scene: Scene) -> Pitch:
    """The pinion rotations that a scene asks for."""
    return uniform_pitch(scene.pinion.teeth, scene.sweep.positions, gear_problem(scene).pitches)


def _log_line(position: SweptPosition) -> str:
    """Angle, iterations, balance and wall time of a position."""
    first = position.results[0]
    iterations = max(r.iterations for r in position.results)
    worst = max(balance_error(r) for r in position.results)
    seconds = sum(r.seconds for r in position.results)
    kind = "again   " if position.again else "position"
    return f"{kind} {first.stand.angle:9.5f} rad: at most {iterations} iterations, balance {worst:.1e}, {seconds:.2f} s"
