"""A scene from start to finish: model, sweep, archive, tables, pictures. The command line calls only this."""

from __future__ import annotations

import logging
import resource
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from mpi4py import MPI

from meshes.quality import scaled_jacobians
from solver import compat
from solver.archive import Archive
from solver.companion import Companion, companion_of
from solver.error_bars import with_errors
from solver.fields import write_fields
from solver.gear_model import Preparation, prepare_model
from solver.gear_position import PositionResult
from solver.gear_results import balance_error, pitch_imbalance
from solver.gear_sweep import Pitch, SweptPosition, initial_state, uniform_pitch
from solver.parallel import on_first
from solver.progress import Progress
from solver.rank_sweep import sweep_on_ranks
from solver.results import MeshFacts, RunFacts, Timings, write_tables, write_text
from solver.run_data import RunData, run_data
from solver.run_start import Meshes, Start, kept_start, logged, open_archive, same_meshes
from solver.scene import Scene
from solver.skips import pitches, skipped, skips, switched_off, wanted_output, warm_up_positions

BALANCE_LIMIT = 1e-2
"""A pitch whose energy does not balance better is an error, not a result."""
STORED_LIMIT = 0.1
"""A position whose teeth store or give back more of the input power bends them too far for small strain."""
REMEDY = (
    "where a tip's edge bears relieve it (tip_relief_um) or lower the torque, else refine the sweep (sweep.positions) "
    "or the mesh (mesh.level)"
)


class BalanceError(RuntimeError):
    """A converged position or pitch that fails its balance certificate."""


@dataclass(frozen=True)
class Sweep:
    """What sweeping took: the meshes it stood on, and wall seconds."""

    meshes: Meshes
    timings: Timings


def run_scene(scene: Scene, out: Path, resume: bool = False, quiet: bool = False) -> None:
    """Computes a scene and writes everything to `out`; the same on any number of ranks.

    resume: go on after the positions that `out` holds; else what an earlier run left there is removed once the gears
    are ready. Raises NotConverged, BalanceError, MeshError, ArchiveError, OSError, on all ranks; nothing unconverged is
    ever written.
    """
    comm, begin = MPI.COMM_WORLD, time.perf_counter()
    compat.silence_logs()
    archive = Archive(out, scene)
    start = on_first(comm, lambda: kept_start(scene, archive, resume))  # before the first file is touched
    with logged(out, comm, start) as log:
        for skip in skipped(scene):
            log.info("skipped, %s: %s", skip.name, skip.sentence)
        for name in switched_off(scene):
            log.info("not skipped, as asked: %s", name)
        sweep = _swept(scene, archive, start, comm, quiet, log)
        companion = companion_of(scene, archive, pitch_of(scene), comm) if wanted_output(scene).error_bars else None
        memory = comm.allreduce(peak_memory_MB())
        on_first(comm, lambda: _write_output(scene, archive, sweep, companion, comm.size, begin, memory, log))


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
        made.append(Sweep((pinion, wheel), _timings(preparation)))

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
        certify(position)
        yield position


def _joined(parts: tuple[SweptPosition, ...]) -> SweptPosition:
    """One position from its groups of friction coefficients."""
    results = tuple(result for part in parts for result in part.results)
    memories = tuple(memory for part in parts for memory in part.state.memories)
    return replace(parts[0], results=results, state=replace(parts[0].state, memories=memories))


def _timings(preparation: Preparation) -> Timings:
    parts = preparation.mesh_seconds, preparation.assemble_seconds, preparation.condense_seconds
    return Timings(*parts, total=preparation.mesh_seconds + preparation.seconds)


def _total(made: list[Sweep], seconds: float) -> Sweep:
    """Of all groups; what was not preparing was solving."""
    mesh, assemble, factor, preparing = (
        sum(getattr(each.timings, name) for each in made) for name in ("mesh", "assemble", "factor", "total")
    )
    return Sweep(made[0].meshes, Timings(mesh, assemble, factor, seconds - preparing))


def _write_output(
    scene: Scene, archive: Archive, sweep: Sweep, companion: Companion | None, ranks: int, begin: float, memory: float,
    log: logging.Logger,
) -> None:  # fmt: skip
    """Fields and pictures; then the tables, whose being there says that the run is complete."""
    started = time.perf_counter()
    data = run_data(scene, archive.read_gears(), archive.read_positions(scene.gear_pair()))
    certify_pitch([solved.result for solved in each] for each in data.positions)
    data = with_errors(data, archive, companion)
    write_text(archive.out / "scene.toml", scene.resolved_toml())  # a resumed run may ask for other output
    _draw(replace(data, scene=scene.model_copy(update={"output": wanted_output(scene)})), archive.out, log)
    now = time.perf_counter()
    seconds = 0.0 if companion is None else companion.seconds
    timings = replace(sweep.timings, error_bars=seconds, output=now - started, total=now - begin)
    write_tables(archive.out, data, _facts(data, sweep.meshes, ranks, timings, memory))
    log.info("done in %.1f s, %.0f MB", timings.total, memory)


def _draw(data: RunData, out: Path, log: logging.Logger) -> None:
    """Fields and pictures, as the scene asks."""
    if data.scene.output.fields:
        log.info("fields: %s", write_fields(data, out / "fields"))
    if data.scene.output.pictures or data.scene.output.animation:
        from solver.plots import draw_all  # pyvista and matplotlib take a second: only where a scene wants pictures

        for path in draw_all(data, out / "pictures"):
            log.info("picture: %s", path)


def _facts(data: RunData, meshes: Meshes, ranks: int, timings: Timings, memory: float) -> RunFacts:
    return RunFacts(
        versions=compat.versions(),
        ranks=ranks,
        dofs=sum(mesh.points.shape[0] * mesh.dimension for mesh in meshes),
        cells=sum(len(mesh.cells) for mesh in meshes),
        mesh=MeshFacts(min(float(scaled_jacobians(mesh).min()) for mesh in meshes), _cells_across(data)),
        skipped=skipped(data.scene),
        timings_s=timings,
        peak_memory_MB=memory,
    )


def _cells_across(data: RunData) -> float:
    """Median over all slices of the fitted contact width 2b over the mean length of a profile element."""
    widths = np.concatenate([2.0 * solved.cut.half_width for each in data.positions for solved in each])
    arc = np.unique(np.round(data.flank.roll_length**2 / (2.0 * data.pair.pinion.base_radius), 7))
    return float(np.nanmedian(widths) * ((len(arc) - 1) / 2) / np.ptp(arc))


def pitch_of(scene: Scene) -> Pitch:
    """The pinion rotations that a scene asks for."""
    return uniform_pitch(scene.pinion.teeth, scene.sweep.positions, warm_up_positions(scene), pitches(scene))


def certify(position: SweptPosition) -> None:
    """Raises BalanceError where the forces of a position do not balance, or its teeth store too much."""
    for result in position.results:
        error = balance_error(result)
        if not error <= STORED_LIMIT:
            raise BalanceError(
                f"pinion at {result.stand.angle:.4f} rad, μ = {result.friction}: wanted a balance error of at most "
                f"{STORED_LIMIT}, found {error:.2e}; {REMEDY}"
            )


def certify_pitch(positions: Iterable[Sequence[PositionResult]]) -> None:
    """Of all positions of a pitch, with a result for each friction coefficient. Raises BalanceError where the energy
    does not balance."""
    for results in zip(*positions, strict=True):
        error = pitch_imbalance(results)
        if not error <= BALANCE_LIMIT:
            raise BalanceError(
                f"the pitch at μ = {results[0].friction}: wanted an energy balance within {BALANCE_LIMIT} of the "
                f"input, found {error:.2e}; {REMEDY}"
            )


def _line(position: SweptPosition) -> str:
    """One line of the log."""
    first = position.results[0]
    iterations = max(r.iterations for r in position.results)
    worst = max(balance_error(r) for r in position.results)
    seconds = sum(r.seconds for r in position.results)
    kind = "warm-up " if position.warm_up else "position"
    return f"{kind} {first.stand.angle:9.5f} rad: at most {iterations} iterations, balance {worst:.1e}, {seconds:.2f} s"


def peak_memory_MB() -> float:
    """Largest resident memory of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
