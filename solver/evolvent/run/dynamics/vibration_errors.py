"""Vibration on other excitations, for its error bars: on that of the coarse companion, and on every other position."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive
from evolvent.dynamics.results.curves import SECANT, TANGENT, CoarseExcitation
from evolvent.dynamics.results.response import jumps, responses
from evolvent.dynamics.results.response_errors import (
    FEWEST_POSITIONS,
    SPACING_FACTOR,
    OtherVibration,
    Vibration,
    VibrationErrors,
    halves,
    mean_stiffness_error,
    vibration_errors,
)
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.results.error_bars.compared import SHARING
from evolvent.run.dynamics.speeds import sweep_at
from evolvent_meshes.arrays import Floats
from evolvent_meshes.errors import EvolventError

COARSE, THINNED = "on elements of twice the size", "on every other position from the {} on"
SWEEPS = 3
"""Number of sweeps over all speeds on other excitations."""
FINER = "A finer mesh tells (mesh.level)"
CLOSER = "More positions tell (sweep.positions)"


def vibration_of(pair: Drive, swept: SpeedSweep) -> Vibration:
    """Responses and jumps of a sweep, which the error bars compare."""
    ways = {"up": jumps(pair, swept.up), "down": jumps(pair, swept.down[::-1])}
    return Vibration(pair, responses(pair, swept), ways)


def errors_over_speed(
    own: Vibration,
    excitation: MeshExcitation,
    companion: CoarseExcitation,
    problem: GearProblem,
    settings: DriveSettings,
    speeds: Floats,
    computed: Callable[[], None] = lambda: None,
) -> VibrationErrors:
    """Error bars of a pair's vibration at ascending speeds (n,) [r/min]. They are unknown where the companion has no
    excitation or a sweep fails: a sentence names the reason, and the results remain.

    own: on `excitation`, under the load that counts.
    problem: its pair.
    computed: called `SWEEPS` times as often as by the sweep of the pair itself.
    """
    load = own.drive.model.load
    others = [
        _swept(name, mesh, lambda mesh: drive(problem.pair, mesh, load, settings), speeds, computed)
        for name, mesh in _excitations(excitation, companion)
    ]
    said = _without_spacing(excitation) if others else []
    quantity = SECANT if settings.mesh == "secant" else TANGENT
    stiffness = mean_stiffness_error(excitation, companion, load, settings.series_stiffness, quantity)
    found = vibration_errors(own, others, stiffness)
    return replace(found, said=(*found.said, *said))


def _excitations(
    excitation: MeshExcitation, companion: CoarseExcitation
) -> Iterator[tuple[OtherVibration, MeshExcitation]]:
    """The excitations that the pair is compared on, each with a name for messages."""
    if companion.excitation is None:
        return
    yield OtherVibration(COARSE, FINER, SHARING[companion.order], None), companion.excitation
    for first, half in zip(("first", "second"), halves(excitation)):
        yield OtherVibration(THINNED.format(first), CLOSER, SPACING_FACTOR, None), half


def _swept(
    name: OtherVibration, excitation: MeshExcitation, pair_on: Callable[[MeshExcitation], Drive], speeds: Floats,
    computed: Callable[[], None],
) -> OtherVibration:
    """Vibration on another excitation, or the reason why there is none."""
    try:
        pair = pair_on(excitation)
        return replace(name, vibration=vibration_of(pair, sweep_at(pair, speeds, computed)))
    except EvolventError as error:
        return replace(name, failure=str(error))


def _without_spacing(excitation: MeshExcitation) -> list[str]:
    """Warning of error bars without the part of the spacing of positions, where the positions cannot be halved."""
    if halves(excitation):
        return []
    return [
        "response.csv: the error bars are those of the mesh alone; with an even number of positions (sweep.positions), "
        f"{FEWEST_POSITIONS} or more, they hold that of their spacing, too; found {len(excitation.unloaded_error)}"
    ]
