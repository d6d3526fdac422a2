"""The positions of a scene: solved, certified, archived; again on deflected flanks where energy is not conserved."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from evolvent.gears.gear_model import Preparation
from evolvent.gears.meshed_gear import MeshedGear
from evolvent.gears.solution.certificates import PitchImbalance, balance_error, certify, certify_pitch
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import Pitch, SweptPosition, initial_state, joined, uniform_pitch
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.gear_shapes import MeshRecord
from evolvent.results.archive.run_cost import Cost, Timings, write_cost
from evolvent.run.context import RunContext
from evolvent.run.progress import POSITIONS
from evolvent.run.start import ResumePoint, checked_meshes, open_archive, prepare_gears, timings_of
from evolvent.scene.gear_problem import gear_problem, shares_gears
from evolvent.scene.scene import Scene
from evolvent.scene.skips import with_deflected_flanks
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class SweepRecord:
    """Meshes that positions were solved on, and the wall time that it took."""

    meshes: MeshRecord
    timings: Timings


class ScenePitch:
    """The positions of a scene's pitch. `generate` solves and certifies them, `solve` also archives them.

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
        self.resume = resume if len(self.groups) == 1 else None  # several groups leave nothing before the end
        self.gears = gears
        self.meshes: MeshRecord | None = None
        self.preparing = Timings()

    def solve(self) -> SweepRecord:
        """Solves and archives the positions. Collective; raises what `run_scene` does, on all ranks."""
        begin = time.perf_counter()
        for index, position in enumerate(self.generate(), len(self.completed)):
            cost = self.run.cost(self._timings(begin), self.run.memory_MB())
            self.run.on_first(partial(_keep, self.archive, index, position, cost))
            self.run.log.info(_log_line(position))
            self.run.progress.advance(more=not position.closes)
        assert self.meshes is not None
        return SweepRecord(self.meshes, self._timings(begin))

    def generate(self) -> Iterator[SweptPosition]:
        """The positions that are still missing, one after the other, each certified."""
        if self.completed:
            self.run.log.info("resumed after %d positions", len(self.completed))
        if len(self.groups) == 1:
            yield from self._group(self.groups[0])
        else:
            yield from _joined_groups([list(self._group(group)) for group in self.groups])

    @property
    def completed(self) -> Sequence[Floats]:
        """Transmission errors of the positions that are archived already."""
        return () if self.resume is None else self.resume.errors

    def _group(self, group: slice) -> Iterator[SweptPosition]:
        """The positions at some of the friction coefficients."""
        gears, frictions = self._prepared(), self.scene.contact.friction[group]
        self.run.progress.stage(POSITIONS, len(self.pitch.angles), len(self.completed))
        state = initial_state(frictions) if self.resume is None else self.resume.state
        for position in sweep_until_periodic(gears.model, self.pitch, frictions, state, self.run.comm, self.completed):
            certify(position.results)
            yield position

    def _prepared(self) -> Preparation:
        """The condensed gears; the archive is opened for their meshes."""
        gears = self.gears
        if gears is None:
            gears = prepare_gears(self.run, self.scene)
            self.preparing += timings_of(gears)
            self.gears = gears if len(self.groups) == 1 else None
        if self.meshes is None:
            self.meshes = meshes = MeshRecord.of([MeshedGear.of(body) for body in gears.model.bodies])
            resumed = self.resume is not None
            self.run.on_first(lambda: open_archive(self.scene, self.archive, meshes, resumed))
        return gears

    def _timings(self, begin: float) -> Timings:
        """Wall time since `begin`: whatever was not preparation was solving."""
        seconds = time.perf_counter() - begin
        return replace(self.preparing, positions=seconds - self.preparing.total, total=seconds)


def sweep_scene(run: RunContext, scene: Scene, resume: ResumePoint | None) -> tuple[Scene, SweepRecord]:
    """Solves and archives all positions. Returns the scene that they belong to: `scene`, or, where the energy of its
    pitch does not balance, the same scene on deflected flanks.

    Collective; raises what `run_scene` does, on all ranks.
    """
    if resume is not None and resume.is_end:
        first, record = None, _finished(run, scene, resume)
    else:
        first = ScenePitch(run, scene, resume)
        record = first.solve()
    imbalance = run.on_first(lambda: _imbalance(run, scene))
    if imbalance is None:
        return scene, record
    deflected = with_deflected_flanks(scene)
    if deflected is scene:
        raise imbalance
    run.log.info("%s", imbalance)
    run.log.info("solved again, on deflected flanks")
    gears = None if first is None or first.gears is None else _on_deflected_flanks(first.gears)
    again = ScenePitch(replace(run, earlier=run.earlier + Cost(record.timings)), deflected, gears=gears).solve()
    if imbalance := run.on_first(lambda: _imbalance(run, deflected)):
        raise imbalance
    return deflected, SweepRecord(again.meshes, record.timings + again.timings)


def _finished(run: RunContext, scene: Scene, resume: ResumePoint) -> SweepRecord:
    """A sweep that an earlier run has completed: the gears need not be condensed."""
    run.log.open()
    run.log.info("resumed after all of %d positions", len(resume.errors))
    return SweepRecord(run.on_first(lambda: checked_meshes(scene, run.archive(scene))), Timings())


def _imbalance(run: RunContext, scene: Scene) -> PitchImbalance | None:
    """Why the archived pitch is not certified, None where it is."""
    positions = run.archive(scene).read_positions(scene.gear_pair())
    try:
        certify_pitch(position.results for position in positions)
    except PitchImbalance as error:
        return error
    return None


def _on_deflected_flanks(gears: Preparation) -> Preparation:
    return replace(gears, model=replace(gears.model, deflected=True))


def _keep(archive: Archive, index: int, position: SweptPosition, cost: Cost) -> None:
    """Archives a position. Raises WriteError, FolderError."""
    archive.write_position(index, position)
    write_cost(archive.files, cost)


def friction_groups(scene: Scene) -> list[slice]:
    """The friction coefficients that share gears, search and compliance: all in one group, or each in its own."""
    count = len(scene.contact.friction)
    return [slice(0, count)] if shares_gears(scene) else [slice(i, i + 1) for i in range(count)]


def _joined_groups(groups: Sequence[list[SweptPosition]]) -> Iterator[SweptPosition]:
    """The pitch at all friction coefficients, from the positions of each group."""
    pitch = [joined(parts) for parts in zip(*(one_pitch(positions) for positions in groups), strict=True)]
    for position in pitch:
        yield replace(position, again=False, closes=position is pitch[-1])


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
