"""A scene from start to finish: model, sweep, archive, tables, pictures. The command line calls only this."""

from __future__ import annotations

import logging
import resource
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
from mpi4py import MPI

from meshes.quality import scaled_jacobians
from solver import compat
from solver.archive import Archive, gear_shape
from solver.fields import write_fields
from solver.gear_body import GearBody
from solver.gear_model import Preparation, prepare_model
from solver.gear_results import balance_error
from solver.gear_sweep import Pitch, SweepState, SweptPosition, initial_state, sweep_pitch, uniform_pitch
from solver.progress import Progress
from solver.results import MeshFacts, RunFacts, Timings, write_tables, write_text
from solver.run_data import RunData, run_data
from solver.scene import Scene
from solver.skips import skipped

BALANCE_LIMIT = 1e-2  # a position whose energy does not balance better is an error, not a result


class BalanceError(RuntimeError):
    """A converged position that fails its balance certificate."""


def run_scene(scene: Scene, out: Path, resume: bool = False, quiet: bool = False) -> None:
    """Computes a scene and writes everything to `out`; the same on any number of ranks.

    Raises NotConverged, BalanceError, MeshError, ArchiveError, OSError; nothing unconverged is ever written.
    """
    comm = MPI.COMM_WORLD
    begin = time.perf_counter()
    compat.silence_logs()
    with _logged(out, comm.rank == 0) as log:
        archive = Archive(out, scene.resolved_toml())
        if comm.rank == 0:
            write_text(out / "scene.toml", scene.resolved_toml())
        for sentence in skipped(scene):
            log.info("skipped: %s", sentence)
        preparation = prepare_model(scene, comm)
        log.info("meshed in %.1f s, condensed in %.1f s", preparation.mesh_seconds, preparation.seconds)
        if comm.rank == 0:
            pinion, wheel = preparation.model.bodies
            archive.write_gears((gear_shape(pinion.mesh, pinion.flank.nodes), gear_shape(wheel.mesh, wheel.flank.nodes)))
        swept = time.perf_counter()
        _solve_positions(scene, preparation, archive, comm, resume, quiet, log)
        solved = time.perf_counter()
        memory = comm.allreduce(peak_memory_MB())
        if comm.rank == 0:
            parts = (preparation.mesh_seconds, preparation.assemble_seconds, preparation.condense_seconds, solved - swept)
            data = run_data(scene, archive.read_gears(), archive.read_positions(preparation.model.pair))
            _write_output(data, out, log)
            output, total = time.perf_counter() - solved, time.perf_counter() - begin
            facts = _facts(scene, preparation, data, comm.size, Timings(*parts, output, total), memory)
            write_tables(out, data, facts)
            log.info("done in %.1f s, %.0f MB", total, memory)
        comm.Barrier()


def _write_output(data: RunData, out: Path, log: logging.Logger) -> None:
    """Fields and pictures, as the scene asks."""
    if data.scene.output.fields:
        log.info("fields: %s", write_fields(data, out / "fields"))
    if data.scene.output.pictures or data.scene.output.animation:
        from solver.plots import draw_all  # pyvista and matplotlib take a second: only where a scene wants pictures

        for path in draw_all(data, out / "pictures"):
            log.info("picture: %s", path)


def _facts(scene: Scene, preparation: Preparation, data: RunData, ranks: int, timings: Timings, memory: float) -> RunFacts:
    bodies = preparation.model.bodies
    mesh = MeshFacts(min(float(scaled_jacobians(b.mesh).min()) for b in bodies), _cells_across(data, bodies[0]))
    return RunFacts(
        versions=compat.versions(),
        ranks=ranks,
        dofs=sum(b.mesh.points.shape[0] * b.d for b in bodies),
        cells=sum(len(b.mesh.cells) for b in bodies),
        mesh=mesh,
        skipped=skipped(scene),
        timings_s=timings,
        peak_memory_MB=memory,
    )


def _cells_across(data: RunData, pinion: GearBody) -> float:
    """Median over all slices of the fitted contact width 2b over the mean length of a profile element."""
    widths = np.concatenate([2.0 * solved.cut.half_width for each in data.positions for solved in each])
    arc = np.unique(np.round(pinion.roll_length**2 / (2.0 * pinion.gear.base_radius), 7))
    return float(np.nanmedian(widths) * ((len(arc) - 1) / 2) / np.ptp(arc))


def pitch_of(scene: Scene) -> Pitch:
    """The pinion rotations that a scene asks for."""
    warm_up = scene.sweep.warm_up_positions if any(scene.contact.friction) else 0
    return uniform_pitch(scene.pinion.teeth, scene.sweep.positions, warm_up)


def _solve_positions(
    scene: Scene, preparation: Preparation, archive: Archive, comm: MPI.Comm, resume: bool, quiet: bool, log: logging.Logger
) -> None:
    model, pitch, frictions = preparation.model, pitch_of(scene), scene.contact.friction
    begin, state = 0, initial_state(frictions)
    if resume and (kept := archive.read_state(model.pair)) is not None:
        begin, state = kept
        log.info("resumed after %d of %d positions", begin, len(pitch.angles))
    mine = [i for i in range(len(frictions)) if i % comm.size == comm.rank]
    own = replace(state, memories=tuple(state.memories[i] for i in mine))
    with Progress(len(pitch.angles), begin, hidden=quiet or comm.rank > 0) as progress:
        for k, part in enumerate(sweep_pitch(model, pitch, [frictions[i] for i in mine], own, begin), start=begin):
            position = _gathered(part, comm, len(frictions))
            _certify(position)
            if comm.rank == 0:
                archive.write_position(k, position)
                log.info(_line(position))
            progress.advance()


def _gathered(part: SweptPosition, comm: MPI.Comm, count: int) -> SweptPosition:
    """All friction coefficients' results and memories; coefficient i was computed by rank i modulo the ranks."""
    if comm.size == 1:
        return part
    parts = comm.allgather((part.results, part.state.memories))
    results = tuple(parts[i % comm.size][0][i // comm.size] for i in range(count))
    memories = tuple(parts[i % comm.size][1][i // comm.size] for i in range(count))
    return replace(part, results=results, state=SweepState(part.state.extra, memories))


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
    return (
        f"{kind} {first.stand.angle:9.5f} rad: at most {iterations} iterations, balance {worst:.1e}, {seconds:.2f} s"
    )


@contextmanager
def _logged(out: Path, first: bool) -> Iterator[logging.Logger]:
    """The run's log: OUT/run.log on rank 0, nothing elsewhere. Makes the folder. Raises OSError."""
    log = logging.getLogger("evolvent")
    log.setLevel(logging.INFO)
    log.propagate = False
    handler: logging.Handler = logging.NullHandler()
    if first:
        out.mkdir(parents=True, exist_ok=True)
        handler = logging.FileHandler(out / "run.log", mode="a", encoding="utf-8")
        handler.setFormatter(logging.Formatter("%(asctime)s  %(message)s", "%H:%M:%S"))
    log.addHandler(handler)
    try:
        yield log
    finally:
        log.removeHandler(handler)
        handler.close()


def peak_memory_MB() -> float:
    """Largest resident memory of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
