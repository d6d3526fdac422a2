"""A run of a scene: the contact of a pitch at every friction coefficient, with tables, fields and pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import ClassVar

from evolvent.check.scene_warnings import flank_warnings
from evolvent.dynamics.body_sentences import bodies_said
from evolvent.dynamics.figures.all import OPERATION_PICTURE
from evolvent.dynamics.operating_point import OperatingPoint, Operation
from evolvent.dynamics.operation_figures import OperationFigures, operation_warnings
from evolvent.dynamics.results.operation import OPERATION_TABLES, operation_tables
from evolvent.dynamics.under_mesh_force import UnderMeshForce
from evolvent.gears.solution.certified_pitch import ON_DEFLECTED
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.error_bar_data import read_error_bars
from evolvent.results.archive.gear_shapes import MeshRecord
from evolvent.results.archive.run_cost import Cost, Timings
from evolvent.results.drawing.picture_files import Picture
from evolvent.results.drawing.table_pictures import from_tables
from evolvent.results.error_bars.estimation import with_errors
from evolvent.results.fields.deformation import Deformation, deformation_of
from evolvent.results.run_data import RunData, archived_run, read_run
from evolvent.results.tables.summary_rows import Summary
from evolvent.results.tables.table import Filled
from evolvent.results.tables.tables import summary, write_summary, write_tables
from evolvent.run.call import Call
from evolvent.run.companion import Attempt
from evolvent.run.computation import Computation, Outputs, Results
from evolvent.run.dynamics.bodies import elastic_point
from evolvent.run.kept_pitch import COMPANION, STORED, KeptPitch, kept_pitch
from evolvent.run.output import facts_of, last_lines, write_fields_of
from evolvent.run.progress import DEFORMATION, VIBRATION
from evolvent.run.solved_pitches import companion_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.line_level import require_runnable
from evolvent.scene.scene import Scene
from evolvent.scene.schema.output import SkipName
from evolvent.scene.skips import Skipped, one_mesh_reason, skipped, switched_off, wanted_output
from evolvent.scene.vibration_limits import doubtful

DEFLECTED_FLANKS: SkipName = "deflected-flanks"
NOTHING_LEFT = "complete: nothing to compute, tables and pictures are written again"
"""Message of a resumed run that was complete."""
TABLES = "summary.json", "positions.csv", "teeth.csv"


@dataclass(frozen=True)
class SolvedRun:
    """The pitch of a run, and what is computed on it."""

    scene: Scene
    """Scene as it was solved."""
    archive: Archive
    """Archive of its positions."""
    meshes: MeshRecord
    """Meshes that the positions were solved on."""
    timings: Timings
    """Wall time of the positions and of the companion [s]."""
    coarse: Attempt[KeptPitch] | None = None
    """Pitch of the coarse companion; None where the scene asks for no error bars, or where they are stored."""
    deformation: Deformation | None = None
    """Displacement and stress of the teeth in contact; None where the scene does not ask for them."""
    operation: Operation | None = None
    """The mesh force under which contact was computed; None without vibration, or where no gears were prepared."""
    memory_MB: float = 0.0
    """Largest resident memory of all ranks together [MB]."""


@dataclass(frozen=True)
class Run(Computation[SolvedRun]):
    """The positions of one angular pitch at every friction coefficient. A pitch whose energy does not balance is solved
    again on deflected flanks."""

    name: ClassVar[str] = "run"
    command: ClassVar[str] = "run"
    in_line_contact: ClassVar[bool] = True
    outputs: ClassVar[Outputs] = Outputs(
        TABLES, (OPERATION_PICTURE,), OPERATION_TABLES, (*STORED, "results/errors.npz", "results/wear.npz")
    )

    def require_level(self) -> None:
        """Raises SceneError where the scene asks for more than a line contact has."""
        super().require_level()
        require_runnable(self.scene.mesh, self.scene.output, self.scene.dynamics)

    def warnings(self) -> Iterator[str]:
        """Warnings on flanks and tips, and on a vibration that is taken out of its range."""
        if self.scene.dynamics is not None and self.scene.dynamics.operating_rpm is not None:
            yield from doubtful(self.scene.planned_vibration())
        yield from flank_warnings(gear_problem(self.scene))

    def solve(self, call: Call) -> SolvedRun:
        """Positions, error bars and deformation, see `Computation.solve`."""
        _log_skips(call, self.scene)
        point = elastic_point(self.scene, call.comm)
        vibrating = None
        if point is not None:
            vibrating = UnderMeshForce(point, call.options.prepare, partial(call.progress.stage, VIBRATION))
            call = call.preparing(vibrating)
        solved = self._pitch(call, point)
        known = call.on_first(lambda: read_error_bars(solved.archive) is not None)
        if wanted_output(self.scene).error_bars and not known:
            again = call.companion(solved.scene, lambda: kept_pitch(call, solved.scene, COMPANION))
            solved = replace(solved, timings=replace(solved.timings, error_bars=again.seconds), coarse=again)
        if wanted_output(self.scene).deformation:
            call.progress.stage(DEFORMATION)
            solved = replace(solved, deformation=deformation_of(solved.scene, solved.archive, call.comm))
        if not solved.timings.total and solved.coarse is None and solved.deformation is None:
            call.log.info("%s", NOTHING_LEFT)
            call.progress.note(NOTHING_LEFT)
        operation = None if vibrating is None else vibrating.operation
        return replace(solved, operation=operation, memory_MB=call.memory_MB())

    def results(self, call: Call, solved: SolvedRun) -> Results:
        """Tables and pictures of the positions, and of the mesh force where the pair vibrates; then fields, and the
        whole cost in summary.json."""
        scene, archive = solved.scene, solved.archive
        companion = None if solved.coarse is None else companion_of(solved.coarse)
        data = with_errors(archived_run(archive), archive, companion)
        mended = [ON_DEFLECTED] if scene.exact != self.scene.exact else []
        cost = call.cost(replace(solved.timings, total=call.seconds), solved.memory_MB)
        content = summary(data, facts_of(data, solved.meshes, call.comm.size, cost), mended)
        tables = [*(_own_tables(content)), *(_of_operation(scene, solved.operation))]
        said = [*content.warnings, *_about_operation(solved.operation)]
        shown = replace(data, scene=scene.model_copy(update={"output": wanted_output(self.scene)}))

        def complete(cost: Callable[[], Cost]) -> None:
            for path in write_fields_of(shown, solved.deformation, call.folder):
                call.log.info("fields: %s", path)
            write_summary(call.folder, replace(content, timings_s=cost().timings))

        return Results(scene, tables, said, self._drawn(shown), solved.timings, complete)

    def pictures(self, out: Path) -> Iterable[Picture]:
        """Pictures of the positions, and of the mesh force."""
        from evolvent.results.figures.all import pictures  # pyvista and matplotlib take a second to import

        run = read_run(out)
        drawn = pictures(replace(run, scene=run.scene.changed("output", pictures=True)))
        return [*drawn, *from_tables(self.outputs.pictures, out)]

    def lines(self, out: Path) -> Iterable[str]:
        """Key figures, and where all results are."""
        return [last_lines(out, self.scene)]

    @property
    def files(self) -> tuple[str, ...]:
        """Nothing: `lines` says where all results are."""
        return ()

    def _pitch(self, call: Call, point: OperatingPoint | None) -> SolvedRun:
        """Solves and stores the positions. Collective. point: where the pair vibrates, if it does."""
        pitch = kept_pitch(call, self.scene)
        for skip in skipped(pitch.scene):  # known only now
            if skip.name == DEFLECTED_FLANKS:
                _log_skip(call, skip)
        return SolvedRun(pitch.scene, pitch.archive, pitch.meshes, pitch.timings)

    def _drawn(self, data: RunData) -> list[Picture]:
        """Pictures that the scene asks for, still to be drawn."""
        if not (data.scene.output.pictures or data.scene.output.animation):
            return []
        from evolvent.results.figures.all import pictures  # pyvista and matplotlib take a second to import

        return list(pictures(data))


def _log_skips(call: Call, scene: Scene) -> None:
    """Logs which parts of the computation are left out, and which are computed in full."""
    for skip in skipped(scene):
        if skip.name != DEFLECTED_FLANKS:
            _log_skip(call, skip)
    for name in switched_off(scene):
        call.log.info("not skipped: %s", name)
    if sentence := one_mesh_reason(scene):
        call.log.info("%s", sentence)


def _log_skip(call: Call, skip: Skipped) -> None:
    call.log.info("skipped, %s: %s", skip.name, skip.sentence)


def _own_tables(content: Summary) -> Iterator[Filled]:
    """summary.json, positions.csv and teeth.csv, which are written together."""
    yield Filled(TABLES[0], lambda folder: write_tables(folder, content))
    yield from (Filled(name, lambda folder: None) for name in TABLES[1:])


def _of_operation(scene: Scene, operation: Operation | None) -> list[Filled]:
    """Tables of the mesh force under which contact was computed."""
    if operation is None:
        return []
    assert scene.dynamics is not None
    return operation_tables(operation, scene.dynamics.direction)


def _about_operation(operation: Operation | None) -> Iterator[str]:
    """Warnings on the vibration under which contact was computed."""
    if operation is not None:
        yield from bodies_said(operation.drive, operation.speed.rpm, operation.speed.rpm)
        yield from operation_warnings([OperationFigures.of(operation)])
