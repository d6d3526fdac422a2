"""A scene from start to finish: model, sweep, archive, tables, pictures. The command line calls only this."""

from __future__ import annotations

import logging
import resource
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from mpi4py import MPI

from meshes.data import MeshData
from meshes.quality import scaled_jacobians
from solver import compat
from solver.archive import Archive, gear_shape
from solver.companion import Companion, companion_of
from solver.error_bars import with_errors
from solver.fields import write_fields
from solver.gear_model import GearModel, Preparation, prepare_model
from solver.gear_results import balance_error
from solver.gear_sweep import Pitch, SweepState, SweptPosition, initial_state, sweep_pitch, uniform_pitch
from solver.parallel import on_first, together
from solver.progress import Progress
from solver.results import MeshFacts, RunFacts, Timings, write_tables, write_text
from solver.run_data import RunData, run_data
from solver.scene import Scene
from solver.sectors import sector_meshes
from solver.skips import skipped
from solver.surface import surface_of

BALANCE_LIMIT = 1e-2  # a position whose energy does not balance better is an error, not a result


class BalanceError(RuntimeError):
    """A converged position that fails its balance certificate."""


@dataclass(frozen=True)
class Start:
    """Where a run begins: after `complete` positions, in this state."""

    complete: int
    state: SweepState


@dataclass(frozen=True)
class Sweep:
    """What sweeping took: the meshes it stood on, and wall seconds."""

    meshes: tuple[MeshData, MeshData]
    timings: Timings


def run_scene(
    scene: Scene, out: Path, resume: bool = False, quiet: bool = False, error_bars: bool = True
) -> None:
    """Computes a scene and writes everything to `out`; the same on any number of ranks.

    resume: go on after the positions that `out` holds; else what an earlier run left there is removed once the gears
    are ready. error_bars: solve a coarse companion for them. Raises NotConverged, BalanceError, MeshError,
    ArchiveError, OSError, on all ranks; nothing unconverged is ever written.
    """
    comm, begin = MPI.COMM_WORLD, time.perf_counter()
    compat.silence_logs()
    archive = Archive(out, scene)
    start = on_first(comm, lambda: _start(scene, archive, resume))  # before the first file is touched
    with _logged(out, comm, start) as log:
        for sentence in skipped(scene):
            log.info("skipped: %s", sentence)
        sweep = _swept(scene, archive, start, comm, quiet, log)
        companion = companion_of(scene, archive, pitch_of(scene), comm) if error_bars else None
        memory = comm.allreduce(peak_memory_MB())
        on_first(comm, lambda: _write_output(scene, archive, sweep, companion, comm.size, begin, memory, log))


def _start(scene: Scene, archive: Archive, resume: bool) -> Start | None:
    """Where to go on, None for the beginning. Raises ArchiveError where another scene's results are to be resumed."""
    kept = archive.read_state(scene.gear_pair()) if resume else None
    return None if kept is None else Start(*kept)


def _swept(
    scene: Scene, archive: Archive, start: Start | None, comm: MPI.Comm, quiet: bool, log: logging.Logger
) -> Sweep:
    """All positions in the archive. Where they are there already the gears are not even condensed."""
    if start is not None:
        log.info("resumed after %d of %d positions", start.complete, len(pitch_of(scene).angles))
        if start.complete == len(pitch_of(scene).angles):
            return Sweep(on_first(comm, lambda: _same_meshes(scene, archive)), Timings())
    preparation = prepare_model(scene, comm)
    log.info("meshed in %.1f s, condensed in %.1f s", preparation.mesh_seconds, preparation.seconds)
    on_first(comm, lambda: _open_archive(scene, archive, preparation, start))
    swept = time.perf_counter()
    begin = start or Start(0, initial_state(scene.contact.friction))
    _solve_positions(scene, preparation.model, archive, begin, comm, quiet, log)
    pinion, wheel = (body.mesh for body in preparation.model.bodies)
    return Sweep((pinion, wheel), _timings(preparation, time.perf_counter() - swept))


def _same_meshes(scene: Scene, archive: Archive) -> tuple[MeshData, MeshData]:
    """The scene's meshes; raises ArchiveError where the results stand on others."""
    meshes = sector_meshes(scene)
    pinion, wheel = (gear_shape(mesh, surface_of(mesh, "flank").nodes) for mesh in meshes)
    archive.check_gears((pinion, wheel))
    return meshes


def _timings(preparation: Preparation, positions: float) -> Timings:
    return Timings(preparation.mesh_seconds, preparation.assemble_seconds, preparation.condense_seconds, positions)


def _open_archive(scene: Scene, archive: Archive, preparation: Preparation, start: Start | None) -> None:
    """Makes the folder ready for this scene's positions."""
    pinion, wheel = (gear_shape(body.mesh, body.flank.nodes) for body in preparation.model.bodies)
    if start is None:
        archive.clear()
        archive.write_gears((pinion, wheel))
    else:
        archive.check_gears((pinion, wheel))
    write_text(archive.out / "scene.toml", scene.resolved_toml())


def _write_output(
    scene: Scene, archive: Archive, sweep: Sweep, companion: Companion | None, ranks: int, begin: float, memory: float,
    log: logging.Logger,
) -> None:  # fmt: skip
    """Fields and pictures, as the scene asks; then the tables, whose being there says that the run is complete."""
    started = time.perf_counter()
    data = run_data(scene, archive.read_gears(), archive.read_positions(scene.gear_pair()))
    data = with_errors(data, archive, companion)
    write_text(archive.out / "scene.toml", scene.resolved_toml())  # a resumed run may ask for other output
    _draw(data, archive.out, log)
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


def _facts(data: RunData, meshes: tuple[MeshData, MeshData], ranks: int, timings: Timings, memory: float) -> RunFacts:
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
    warm_up = scene.sweep.warm_up_positions if any(scene.contact.friction) else 0
    return uniform_pitch(scene.pinion.teeth, scene.sweep.positions, warm_up)


def _solve_positions(
    scene: Scene, model: GearModel, archive: Archive, start: Start, comm: MPI.Comm, quiet: bool, log: logging.Logger
) -> None:
    pitch, state = pitch_of(scene), start.state
    with Progress(len(pitch.angles), start.complete, hidden=quiet or comm.rank > 0) as progress:
        for k in range(start.complete, len(pitch.angles)):
            position = _position(model, pitch, scene.contact.friction, state, k, comm)
            _certify(position)
            on_first(comm, partial(archive.write_position, k, position))
            log.info(_line(position))
            progress.advance()
            state = position.state


def _position(
    model: GearModel, pitch: Pitch, frictions: tuple[float, ...], state: SweepState, k: int, comm: MPI.Comm
) -> SweptPosition:
    """Position k of the pitch at all friction coefficients, of which i is computed by rank i modulo the ranks."""
    own = range(comm.rank, len(frictions), comm.size)

    def part() -> SweptPosition | None:
        mine = replace(state, memories=tuple(state.memories[i] for i in own))
        return next(sweep_pitch(model, pitch, [frictions[i] for i in own], mine, k)) if own else None

    parts: list[SweptPosition] = comm.allgather(together(comm, part))
    results = tuple(parts[i % comm.size].results[i // comm.size] for i in range(len(frictions)))
    memories = tuple(parts[i % comm.size].state.memories[i // comm.size] for i in range(len(frictions)))
    return replace(parts[0], results=results, state=SweepState(parts[0].state.extra, memories))


def _certify(position: SweptPosition) -> None:
    for result in position.results:
        error = balance_error(result)
        if not error <= BALANCE_LIMIT:
            raise BalanceError(
                f"pinion at {result.stand.angle:.4f} rad, μ = {result.friction}: wanted a balance error of at most "
                f"{BALANCE_LIMIT}, found {error:.2e}; refine the mesh (mesh.level) or the sweep (sweep.positions)"
            )


def _line(position: SweptPosition) -> str:
    """One line of the log."""
    first = position.results[0]
    iterations = max(r.iterations for r in position.results)
    worst = max(balance_error(r) for r in position.results)
    seconds = sum(r.seconds for r in position.results)
    kind = "warm-up " if position.warm_up else "position"
    return f"{kind} {first.stand.angle:9.5f} rad: at most {iterations} iterations, balance {worst:.1e}, {seconds:.2f} s"


@contextmanager
def _logged(out: Path, comm: MPI.Comm, start: Start | None) -> Iterator[logging.Logger]:
    """The run's log: OUT/run.log on rank 0, nothing elsewhere; a resumed run adds to it. Makes the folder.

    Raises OSError.
    """
    log = logging.getLogger("evolvent")
    log.setLevel(logging.INFO)
    log.propagate = False
    handler = together(comm, lambda: logging.NullHandler() if comm.rank > 0 else _log_file(out, "a" if start else "w"))
    log.addHandler(handler)
    try:
        yield log
    except Exception as error:
        log.error("failed: %s", error)
        raise
    finally:
        log.removeHandler(handler)
        handler.close()


def _log_file(out: Path, mode: str) -> logging.Handler:
    try:
        out.mkdir(parents=True, exist_ok=True)
        handler = logging.FileHandler(out / "run.log", mode=mode, encoding="utf-8")
    except OSError as error:
        raise OSError(
            f"{out}: wanted a folder to write to, found {error.strerror}; name another one with --out"
        ) from error
    handler.setFormatter(logging.Formatter("%(asctime)s  %(message)s", "%H:%M:%S"))
    return handler


def peak_memory_MB() -> float:
    """Largest resident memory of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
