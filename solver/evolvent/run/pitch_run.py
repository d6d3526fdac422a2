"""All positions of a scene into its archive, certified; once more on deflected flanks where energy asks for it."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from mpi4py import MPI

from evolvent.fem.parallel.ranks import on_first
from evolvent.gears.gear_model import Preparation, prepare_model
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import Pitch, SweptPosition, initial_state, joined, uniform_pitch
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.run_cost import Cost, Timings, keep_cost
from evolvent.results.contact_slices import balance_error
from evolvent.run.output import PitchImbalance, Sweep, certify, certify_pitch, peak_memory_MB, timings_of
from evolvent.run.progress import CONDENSING, MESHING, POSITIONS, Progress
from evolvent.run.run_log import RunLog
from evolvent.run.start import Start, open_archive, same_meshes
from evolvent.scene.scene import Scene
from evolvent.scene.skips import pitches, skips, switched_off, with_deflected_flanks


def sweep_scene(
    scene: Scene, out: Path, start: Start | None, earlier: Cost, comm: MPI.Comm, progress: Progress, log: RunLog
) -> tuple[Scene, Sweep]:
    """The scene whose positions are then in its archive: this one, or, where the energy of its pitch does not balance,
    the one on deflected flanks. earlier: what earlier parts of the run have cost. Raises what `run_scene` does, on all
    ranks."""
    gears = _Gears(scene, earlier, comm, progress, log)
    sweep = _swept(scene, out, start, gears)
    loss = on_first(comm, lambda: _imbalance(scene, out))
    if loss is None:
        return scene, sweep
    deflected = with_deflected_flanks(scene)
    if deflected is scene:
        raise loss
    log.info("%s", loss)
    log.info("solved again, on deflected flanks")
    again = _swept(deflected, out, None, replace(gears, scene=deflected, earlier=earlier + Cost(sweep.timings)))
    if loss := on_first(comm, lambda: _imbalance(deflected, out)):
        raise loss
    return deflected, Sweep(again.meshes, sweep.timings + again.timings)


def _imbalance(scene: Scene, out: Path) -> PitchImbalance | None:
    positions = Archive(out, scene).read_positions(scene.gear_pair())
    try:
        certify_pitch(position.results for position in positions)
    except PitchImbalance as error:
        return error
    return None


@dataclass(frozen=True)
class _Gears:
    """A scene's gears on some ranks. earlier: what earlier parts of the run have cost. kept: those that all friction
    coefficients share, for a second sweep."""

    scene: Scene
    earlier: Cost
    comm: MPI.Comm
    progress: Progress
    log: RunLog
    kept: list[Preparation] = field(default_factory=list)

    def prepared(self) -> tuple[Preparation, Timings]:
        """And what it took now."""
        if self.kept:
            deflected = "deflected-flanks" in switched_off(self.scene)
            return replace(self.kept[0], model=replace(self.kept[0].model, deflected=deflected)), Timings()
        self.progress.stage(MESHING)
        preparation = prepare_model(self.scene, self.comm, meshed=self._meshed)
        self.log.info("meshed in %.1f s, condensed in %.1f s", preparation.mesh_seconds, preparation.seconds)
        if len(friction_groups(self.scene)) == 1:
            self.kept.append(preparation)
        return preparation, timings_of(preparation)

    def cost(self, timings: Timings) -> Cost:
        """Of the run so far, this part of it included; all ranks must call it."""
        return self.earlier + Cost(timings, self.comm.allreduce(peak_memory_MB()))

    def _meshed(self) -> None:
        self.log.begin()
        self.progress.stage(CONDENSING)


def _swept(scene: Scene, out: Path, start: Start | None, gears: _Gears) -> Sweep:
    """All positions in the archive. Where they are there already the gears are not even condensed."""
    comm, log, archive = gears.comm, gears.log, Archive(out, scene)
    groups, begun = friction_groups(scene), time.perf_counter()
    if start is not None and start.is_end:
        log.begin()
        log.info("resumed after all of %d positions", len(start.errors))
        return Sweep(on_first(comm, lambda: same_meshes(scene, archive)), Timings())
    if start is not None and len(groups) > 1:
        start = None  # groups are written together, once all are solved
    done = start.errors if start is not None else ()
    if done:
        log.info("resumed after %d positions", len(done))
    made: list[Sweep] = []

    def solved(group: slice) -> Iterator[SweptPosition]:
        """Positions of some friction coefficients, each certified, on gears of their own where these are not kept."""
        preparation, timings = gears.prepared()
        pinion, wheel = (body.mesh for body in preparation.model.bodies)
        if not made:
            on_first(comm, lambda: open_archive(scene, archive, (pinion, wheel), start))
        made.append(Sweep((pinion, wheel), timings))
        gears.progress.stage(POSITIONS, len(pitch_of(scene).angles), len(done))
        frictions = scene.contact.friction[group]
        state = start.state if start is not None else initial_state(frictions)
        for position in sweep_until_periodic(preparation.model, pitch_of(scene), frictions, state, comm, done):
            certify(position.results)
            yield position

    for k, position in enumerate(_together([solved(group) for group in groups]), len(done)):
        cost = gears.cost(_total(made, time.perf_counter() - begun).timings)
        on_first(comm, partial(_keep, archive, k, position, cost))
        log.info(_line(position))
        gears.progress.advance(more=not position.closes)
    return _total(made, time.perf_counter() - begun)


def _keep(archive: Archive, index: int, position: SweptPosition, cost: Cost) -> None:
    """On disk. Raises WriteError, FolderError."""
    archive.write_position(index, position)
    keep_cost(archive.files, cost)


def friction_groups(scene: Scene) -> list[slice]:
    """Which friction coefficients share gears, search and compliance: all, or each its own."""
    count = len(scene.contact.friction)
    shared = count == 1 or skips(scene, "reuse")
    return [slice(0, count)] if shared else [slice(i, i + 1) for i in range(count)]


def _together(sweeps: Sequence[Iterator[SweptPosition]]) -> Iterator[SweptPosition]:
    """The positions of all groups of friction coefficients: of a single one as it comes, of several, which close their
    pitches after different numbers of them, what each has found in the end."""
    if len(sweeps) == 1:
        yield from sweeps[0]
        return
    found = [joined(parts) for parts in zip(*(one_pitch(list(sweep)) for sweep in sweeps), strict=True)]
    for position in found:
        yield replace(position, again=False, closes=position is found[-1])


def _total(made: list[Sweep], seconds: float) -> Sweep:
    """Of all groups; what was not preparing was solving."""
    mesh, assemble, factor, preparing = (
        sum(getattr(each.timings, name) for each in made) for name in ("mesh", "assemble", "factor", "total")
    )
    return Sweep(made[0].meshes, Timings(mesh, assemble, factor, positions=seconds - preparing, total=seconds))


def pitch_of(scene: Scene) -> Pitch:
    """The pinion rotations that a scene asks for."""
    return uniform_pitch(scene.pinion.teeth, scene.sweep.positions, pitches(scene))


def _line(position: SweptPosition) -> str:
    """One line of the log."""
    first = position.results[0]
    iterations = max(r.iterations for r in position.results)
    worst = max(balance_error(r) for r in position.results)
    seconds = sum(r.seconds for r in position.results)
    kind = "again   " if position.again else "position"
    return f"{kind} {first.stand.angle:9.5f} rad: at most {iterations} iterations, balance {worst:.1e}, {seconds:.2f} s"
