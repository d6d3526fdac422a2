"""A wear study run for a few blocks, every state that it accepts checked anew, and what became of it.

Checked by other means than the study's own certificates: volumes from the contact points and from the nodes, cells by
their scaled Jacobians, meshes by what they have lost, depths that only grow.
"""

from __future__ import annotations

import re
import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import Enum
from itertools import islice
from math import nan

import numpy as np
from mpi4py import MPI

from evidence.robustness.campaigns.random_wear import BodyStudy
from evidence.robustness.campaigns.scene_outcomes import last_line
from evolvent.gears.gear_model import prepare_model
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.run.wear_run import certify_positions, law_of, settings_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.wear.block_stepping import WearState
from evolvent.wear.body_study import CycleState, WearStudy
from evolvent.wear.gears.gear_study import StudyState, study_states
from evolvent.wear.gears.gear_wear import GearWear
from evolvent.wear.gears.pitch_state import PitchState
from evolvent.wear.mesh_motion import MeshInverted, mesh_volume
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import EvolventError
from evolvent_meshes.mesh.quality import scaled_jacobians

BLOCKS = 25
CLEAR = re.compile(r"wanted .*found .*[:;]", re.DOTALL)
ROUNDING, VOLUME, MESH, WORK = 1e-9, 1e-6, 1e-2, 0.2
"""What is wrong, relative: depth that comes back, volumes, what a moved mesh has lost, the work of a gears' block."""
Volumes = list[tuple[float, float]]


class WearVerdict(Enum):
    """What became of a study: a result, a stop with a message, three that must not be."""

    FINISHED = "finished"
    STOPPED = "stopped, with a message"
    WRONG = "wrong"
    CRASHED = "crashed"
    HUNG = "hung"


@dataclass(frozen=True)
class WearOutcome:
    """The outcome of a study."""

    seed: int
    verdict: WearVerdict
    message: str = ""
    kind: str = ""
    """Gears, or the shapes of the bodies."""
    fastest: float = nan
    """Largest K/H [mm²/N]."""
    blocks: int = 0
    """Accepted ones, of at most BLOCKS; `refused`: those that were made shorter."""
    refused: int = 0
    error: float = 0.0
    """Of the worst block."""
    depth: float = 0.0
    """Over the module, the radius or the height."""
    cpu: float = 0.0
    """CPU time [s]."""

    @property
    def line(self) -> str:
        """The last line of the message."""
        return last_line(self.message)


@dataclass(frozen=True)
class Accepted:
    """A state that a study has accepted."""

    depth: Floats
    """(n,) [mm]."""
    volumes: Volumes
    """Found and wanted ones [mm³; mm² in 2D]."""
    faults: tuple[str, ...] = ()
    """What else is wrong."""
    block: int = 0
    """1 where a block led there."""
    refused: int = 0
    """Of that block, as `error`."""
    error: float = 0.0


def wear_outcome_of(study: Scene | BodyStudy, seed: int) -> WearOutcome:
    """Runs the study. Raises nothing but what ends Python."""
    begin = time.process_time()
    if isinstance(study, Scene):
        assert study.wear is not None
        fastest = max(study.wear.pinion_mm2_per_N, study.wear.wheel_mm2_per_N)
        outcome = WearOutcome(seed, WearVerdict.FINISHED, kind="gears", fastest=fastest)
        states, size = gear_states(study), study.pair.normal_module_mm
    else:
        outcome = WearOutcome(seed, WearVerdict.FINISHED, kind=study.kind, fastest=max(study.law.coefficients))
        states, size = body_states(study), study.size
    try:
        for judged in _judged(outcome, states, size):
            outcome = judged
    except EvolventError as error:
        clear = WearVerdict.STOPPED if CLEAR.search(str(error)) else WearVerdict.WRONG
        outcome = replace(outcome, verdict=clear, message=f"{type(error).__name__}: {error}")
    except Exception:
        outcome = replace(outcome, verdict=WearVerdict.CRASHED, message=traceback.format_exc(limit=-3))
    return replace(outcome, cpu=time.process_time() - begin)


def _judged(outcome: WearOutcome, states: Iterator[Accepted], size: float) -> Iterator[WearOutcome]:
    """After every accepted state; the first one that is wrong ends the study."""
    before: Accepted | None = None
    for state in states:
        faults = list(_faults(state, before))
        outcome = replace(
            outcome, blocks=outcome.blocks + state.block, refused=outcome.refused + state.refused,
            error=max(outcome.error, state.error), depth=float(state.depth.max()) / size,
        )
        if faults:
            yield replace(outcome, verdict=WearVerdict.WRONG, message="; ".join(faults))
            return
        yield outcome
        before = state


def _faults(state: Accepted, before: Accepted | None) -> Iterator[str]:
    """What is wrong with an accepted state."""
    yield from state.faults
    if not np.isfinite(state.depth).all():
        yield "depths that are no numbers"
        return
    gained = state.depth - (0.0 if before is None else before.depth)
    if gained.min() < -ROUNDING * np.abs(state.depth).max():
        yield f"{-gained.min():.3g} mm of material came back"
    for number, (found, wanted) in enumerate(state.volumes):
        if not abs(found - wanted) <= VOLUME * abs(wanted):
            yield f"volume {number}: wanted {wanted:.9g}, found {found:.9g}"


def body_states(study: BodyStudy) -> Iterator[Accepted]:
    """The states of a study of the public API. After a stop the last one is solved again: it must still be there.
    Raises what WearStudy does."""
    run = WearStudy(study.problem, (study.law,), study.cycle, study.refresh)
    now, depth, lost = run.evaluate(np.zeros(len(run.areas))), np.zeros(len(run.areas)), 0.0
    yield Accepted(depth, _rates(run, study, now))
    try:
        for block in islice(run.blocks(study.cycles, study.settings), BLOCKS):
            gained = block.state.depth - depth
            lost += float(block.end.areas @ gained)
            volumes = [*_rates(run, study, block.end), *_gained(run, study, gained, block.length, now, block.end)]
            depth, now = block.state.depth.copy(), block.state.evaluation
            yield Accepted(depth, volumes, tuple(_mesh_faults(run, study, depth, lost)), 1, block.refused, block.error)
    except EvolventError:
        again = run.evaluate(depth)
        yield Accepted(depth, _rates(run, study, again), tuple(_mesh_faults(run, study, depth, lost)))
        raise


def _rates(run: WearStudy, study: BodyStudy, state: CycleState) -> Volumes:
    """Volumes per cycle of every side that wears: at the nodes, and from the contact points."""
    areas, rates, points = run.by_side(state.areas), run.by_side(state.rate), _at_points(study, state)
    return [(float(areas[side] @ rates[side]), points[side[0]]) for side in run.sides]


def _gained(
    run: WearStudy, study: BodyStudy, gained: Floats, length: float, before: CycleState, after: CycleState
) -> Volumes:
    """Of a block: at the rate of its end, or the mean of both ends'."""
    begin, end = _at_points(study, before), _at_points(study, after)
    mean = {i: end[i] if study.settings.implicit else 0.5 * (begin[i] + end[i]) for i in end}
    areas, depths = run.by_side(after.areas), run.by_side(gained)
    return [(float(areas[side] @ depths[side]), length * mean[side[0]]) for side in run.sides]


def _at_points(study: BodyStudy, state: CycleState) -> dict[int, float]:
    """(K/H) ∫∫p|v_s| dA dt of both bodies per cycle."""
    work = sum(float(np.sum(r.result.weights * r.result.pressure * r.sliding)) for r in state.contacts[0])
    return {body: K * work for body, K in enumerate(study.law.coefficients)}


def _mesh_faults(run: WearStudy, study: BodyStudy, depth: Floats, lost: float) -> Iterator[str]:
    """Cells that are turned over, depths that no mesh can have, meshes that have lost another volume than `lost`."""
    worst = min(float(scaled_jacobians(body.mesh).min()) for body in run.geometry.problem.bodies)
    if not worst > 0.0:
        yield f"a cell of scaled Jacobian {worst:.3g}"
    wanted, run.mesh_motion = run.mesh_motion, replace(run.mesh_motion, least_quality=0.0)
    try:
        moved = run.meshes(depth)
    except MeshInverted as error:
        yield f"accepted, but no mesh follows: {error}"
        return
    finally:
        run.mesh_motion = wanted
    gone = sum(mesh_volume(body.mesh) - mesh_volume(mesh) for body, mesh in zip(study.problem.bodies, moved))
    if not abs(gone - lost) <= MESH * lost:
        yield f"mesh: wanted {lost:.6g} to be gone, found {gone:.6g}"


def gear_states(scene: Scene) -> Iterator[Accepted]:
    """The states of a gear pair, certified as a run does. Raises what a run does."""
    wear = scene.wear
    assert wear is not None
    model = prepare_model(gear_problem(scene), MPI.COMM_SELF).model
    pitch = uniform_pitch(scene.pinion.teeth, scene.sweep.positions)
    gears = GearWear(model, pitch, scene.contact.friction[0], law_of(wear))
    before: WearState[PitchState] | None = None
    for stage in islice(study_states(gears, wear.reports, settings_of(wear)), BLOCKS + 1):
        certify_positions(stage.state.evaluation)
        yield _gear_state(gears, stage, before)
        before = stage.state


def _gear_state(gears: GearWear, stage: StudyState, before: WearState[PitchState] | None) -> Accepted:
    state = stage.state
    work = _passage_work(gears, state.evaluation)
    volumes = [*zip(_works(gears, state.evaluation.rate), 2 * [work])]
    if before is None:
        return Accepted(state.depth, volumes)
    ends, row, faults = (_passage_work(gears, before.evaluation), work), stage.rows[-1], []
    done = _works(gears, (state.depth - before.depth) / row.block_cycles)
    volumes.append((done[0], done[-1]))
    if not (1.0 - WORK) * min(ends) <= done[0] <= (1.0 + WORK) * max(ends):
        faults.append(f"a block's work: wanted it near {ends[0]:.4g} and {ends[1]:.4g}, found {done[0]:.4g}")
    return Accepted(state.depth, volumes, tuple(faults), 1, row.refused, row.error)


def _works(gears: GearWear, rate: Floats) -> list[float]:
    """The work per passage [N·mm; N] that a depth per cycle (n,) of each gear that wears speaks of."""
    often = 1.0, 1.0 / gears.model.pair.ratio
    parts = zip(gears.by_gear(gears.areas), gears.by_gear(rate), gears.law.coefficients, often)
    return [float(areas @ own) / (K * n) for areas, own, K, n in parts if K > 0.0]


def _passage_work(gears: GearWear, state: PitchState) -> float:
    """∫∫p|v_s| dA dt of a tooth's passage: every point's pressure for a step before and after its position, rising and
    falling linearly, ∫B|ξ + η|dη as the second difference of |ξ|³/6; ξ where nominal sliding is what was found."""
    pair, total = gears.model.pair, 0.0
    growth = 1.0 + 1.0 / pair.ratio
    step = pair.pinion.base_radius * 2.0 * np.pi / pair.pinion.z / len(state.positions)
    for position in state.positions:
        x, p = position.contact.sliding / growth, position.contact.weights * position.contact.pressure
        slid = (abs(x + step) ** 3 - 2.0 * abs(x) ** 3 + abs(x - step) ** 3) / (6.0 * step)
        total += float(p @ slid)
    return total * growth / pair.pinion.base_radius
