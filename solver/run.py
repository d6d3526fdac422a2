"""A scene from start to finish: model, sweep, archive, tables, pictures. The command line calls only this."""

from __future__ import annotations

import logging
import resource
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from mpi4py import MPI

from solver import compat
from solver.archive import Archive, gear_shape
from solver.gear_model import Preparation, prepare_model
from solver.gear_results import balance_error
from solver.gear_sweep import Pitch, SweepState, SweptPosition, initial_state, sweep_pitch, uniform_pitch
from solver.progress import Progress
from solver.scene import Scene
from solver.skips import skipped

BALANCE_LIMIT = 1e-2  # a position whose energy does not balance better is an error, not a result


class BalanceError(RuntimeError):
    """A converged position that fails its balance certificate."""


@dataclass(frozen=True)
class Timings:
    """Wall seconds of the parts of a run."""

    mesh: float = 0.0
    condense: float = 0.0
    positions: float = 0.0
    output: float = 0.0
    total: float = 0.0


def run_scene(scene: Scene, out: Path, resume: bool = False, quiet: bool = False, no_skip: bool = False) -> None:
    """Computes a scene and writes everything to `out`; the same on any number of ranks.

    Raises NotConverged, BalanceError, MeshError, ArchiveError, OSError; nothing unconverged is ever written.
    """
    comm = MPI.COMM_WORLD
    begin = time.perf_counter()
    compat.silence_logs()
    log = _log(out, comm.rank == 0)
    archive = Archive(out, scene.resolved_toml())
    if comm.rank == 0:
        (out / "scene.toml").write_text(scene.resolved_toml(), encoding="utf-8")
    for sentence in skipped(scene):
        log.info("skipped: %s", sentence)
    preparation = prepare_model(scene, comm)
    if comm.rank == 0:
        archive.write_gears(tuple(gear_shape(b.mesh, b.flank.nodes) for b in preparation.model.bodies))
    log.info("meshed in %.1f s, condensed in %.1f s", preparation.mesh_seconds, preparation.condense_seconds)
    swept = time.perf_counter()
    _solve_positions(scene, preparation, archive, comm, resume, quiet, log)
    solved = time.perf_counter()
    if comm.rank == 0:
        timings = Timings(preparation.mesh_seconds, preparation.condense_seconds, solved - swept, 0.0, solved - begin)
        _write_output(scene, preparation, archive, out, timings, comm.size, log)
    comm.Barrier()


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
