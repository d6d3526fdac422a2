"""A scene from start to finish: model, sweep, archive, tables, pictures. The command line calls only this."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from mpi4py import MPI

from solver import compat
from solver.archive import Archive
from solver.companion import companion_of
from solver.gear_model import Preparation, prepare_model
from solver.gear_results import balance_error
from solver.gear_sweep import Pitch, SweptPosition, initial_state, uniform_pitch
from solver.parallel import on_first
from solver.progress import Progress
from solver.rank_sweep import sweep_on_ranks
from solver.results import Timings
from solver.run_output import (
    PitchImbalance,
    Sweep,
    certify,
    certify_pitch,
    peak_memory_MB,
    timings_of,
    write_output,
)
from solver.run_start import Start, continued, kept_start, logged, open_archive, same_meshes
from solver.run_wear import wear_scene, write_wear
from solver.scene import Scene
from solver.skips import pitches, skipped, skips, switched_off, wanted_output, warm_up_positions, with_deflected_flanks


def run_scene(scene: Scene, out: Path, resume: bool = False, quiet: bool = False) -> None:
    """Computes a scene and writes everything to `out`; the same on any number of ranks.

    resume: go on after the positions, or the blocks of wear, that `out` holds; else what an earlier run left there is
    removed once the gears are ready. A pitch whose energy does not balance is solved again on deflected flanks, as the
    scene that asks for these. Raises NotConverged, BalanceError, MeshError, ArchiveError, WearStopped,
    VolumeLost, OSError, on all ranks; nothing unconverged is ever written.
    """
    comm, begin = MPI.COMM_WORLD, time.perf_counter()
    compat.silence_logs()
    scene = on_first(comm, lambda: continued(scene, Archive(out, scene), resume))
    start = on_first(comm, lambda: kept_start(scene, Archive(out, scene), resume))  # before the first file is touched
    with logged(out, comm, start) as log:
        task = _Task(scene, Archive(out, scene), comm, begin, quiet, log)
        try:
            task.run(start, resume)
        except PitchImbalance as error:
            deflected = with_deflected_flanks(scene)
            if deflected is scene:
                raise
            log.info("%s", error)
            log.info("solved again, on deflected flanks")
            replace(task, scene=deflected, archive=Archive(out, deflected)).run(None, False)


@dataclass(frozen=True)
class _Task:
    """A scene on its way: its archive, ranks, when it began."""

    scene: Scene
    archive: Archive
    comm: MPI.Comm
    begin: float
    quiet: bool
    log: logging.Logger

    def run(self, start: Start | None, resume: bool) -> None:
        """Everything, from the beginning or what the archive holds. Raises what `run_scene` does."""
        scene, archive, comm, log = self.scene, self.archive, self.comm, self.log
        for skip in skipped(scene):
            log.info("skipped, %s: %s", skip.name, skip.sentence)
        for name in switched_off(scene):
            log.info("not skipped, as asked: %s", name)
        if scene.wear is None:
            sweep = _swept(scene, archive, start, comm, self.quiet, log)
            on_first(comm, lambda: _certify_archive(scene, archive))  # before anything else is computed
        else:
            sweep = wear_scene(scene, archive, resume, comm, self.quiet, log)
        companion = companion_of(scene, archive, pitch_of(scene), comm) if wanted_output(scene).error_bars else None
        memory = comm.allreduce(peak_memory_MB())
        on_first(comm, lambda: write_output(scene, archive, sweep, companion, comm.size, self.begin, memory, log))
        if scene.wear is not None:
            on_first(comm, lambda: write_wear(scene, archive.out, log))


def _certify_archive(scene: Scene, archive: Archive) -> None:
    """Raises PitchImbalance."""
    positions = archive.read_positions(scene.gear_pair())
    certify_pitch(position.results for position in positions if not position.warm_up)


def _swept(
    scene: Scene, archive: Archive, start: Start | None, comm: MPI.Comm, quiet: bool, log: logging.Logger
) -> Sweep:
    """All positions in the archive. Where they are there already the gears are not even condensed."""
    count, begun = len(pitch_of(scene).angles), time.perf_counter()
    if start is not None:
        log.info("resumed after %d of %d positions", start.complete, count)
        if start.complete == count:
            return Sweep(on_first(comm, lambda: same_meshes(scene, archive)), Timings())
    begin = start or Start(0, initial_state(scene.contact.friction))
    made: list[Sweep] = []

    def ready(preparation: Preparation) -> None:
        log.info("meshed in %.1f s, condensed in %.1f s", preparation.mesh_seconds, preparation.seconds)
        pinion, wheel = (body.mesh for body in preparation.model.bodies)
        if not made:
            on_first(comm, lambda: open_archive(scene, archive, (pinion, wheel), start))
        made.append(Sweep((pinion, wheel), timings_of(preparation)))

    sweeps = [_solved(scene, group, begin.only(group), comm, ready) for group in friction_groups(scene)]
    if len(sweeps) > 1:  # each with its own gears, one after the other
        sweeps = [iter(list(each)) for each in sweeps]
    with Progress(count, begin.complete, hidden=quiet or comm.rank > 0) as progress:
        for k, parts in enumerate(zip(*sweeps), begin.complete):
            position = _joined(parts)
            on_first(comm, partial(archive.write_position, k, position))
            log.info(_line(position))
            progress.advance()
    return _total(made, time.perf_counter() - begun)


def friction_groups(scene: Scene) -> list[slice]:
    """Which friction coefficients share gears, search and compliance: all, or each its own."""
    count = len(scene.contact.friction)
    shared = count == 1 or skips(scene, "reuse")
    return [slice(0, count)] if shared else [slice(i, i + 1) for i in range(count)]


def _solved(
    scene: Scene, group: slice, start: Start, comm: MPI.Comm, ready: Callable[[Preparation], None]
) -> Iterator[SweptPosition]:
    """Condenses the gears and solves the positions of some friction coefficients, each certified."""
    preparation = prepare_model(scene, comm)
    ready(preparation)
    frictions = scene.contact.friction[group]
    for position in sweep_on_ranks(
        preparation.model, pitch_of(scene), frictions, start.state, comm, start.complete
    ):
        certify(position.results)
        yield position


def _joined(parts: tuple[SweptPosition, ...]) -> SweptPosition:
    """One position from its groups of friction coefficients."""
    results = tuple(result for part in parts for result in part.results)
    memories = tuple(memory for part in parts for memory in part.state.memories)
    return replace(parts[0], results=results, state=replace(parts[0].state, memories=memories))


def _total(made: list[Sweep], seconds: float) -> Sweep:
    """Of all groups; what was not preparing was solving."""
    mesh, assemble, factor, preparing = (
        sum(getattr(each.timings, name) for each in made) for name in ("mesh", "assemble", "factor", "total")
    )
    return Sweep(made[0].meshes, Timings(mesh, assemble, factor, seconds - preparing))


def pitch_of(scene: Scene) -> Pitch:
    """The pinion rotations that a scene asks for."""
    return uniform_pitch(scene.pinion.teeth, scene.sweep.positions, warm_up_positions(scene), pitches(scene))


def _line(position: SweptPosition) -> str:
    """One line of the log."""
    first = position.results[0]
    iterations = max(r.iterations for r in position.results)
    worst = max(balance_error(r) for r in position.results)
    seconds = sum(r.seconds for r in position.results)
    kind = "warm-up " if position.warm_up else "position"
    return f"{kind} {first.stand.angle:9.5f} rad: at most {iterations} iterations, balance {worst:.1e}, {seconds:.2f} s"
