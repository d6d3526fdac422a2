"""Error bars of a pair's vibration over the speed: from sweeps through the same speeds on other excitations.

The error of a figure at a speed has two parts, each a multiple of how far the figure is off on another excitation:

- The mesh: on elements of twice the size at the same positions. The factor is that of what varies over the pitch in the
  excitation (`compared.SHARING`), for that is what excites.
- The spacing of positions: on every other position of the same mesh, from the first on and from the second on. The
  excitation is a spline through its positions. Where a tooth pair comes into contact the stiffness jumps within a step,
  so that harmonics of the spline are off in proportion to the step: half the step has half the error, and the
  difference is the error of the finer one, 1/(2 − 1). Of kinks alone a third would do. Where in a step the jump lies is
  chance; one half of the positions may see it just as all do, the other then does not, and the mean of both differences
  is taken, as for the harmonics of the excitation (`curves.PitchCurve.amplitude_errors`).

Both are added, as in all error bars: they are limits rather than deviations of chance, and both mostly move the same
resonances, so that there is no reason for them to cancel as roots of squares have it. All sweeps are at the same speeds
in r/min: where a resonance or a jump moves with the excitation, figures beside it have a large error, which is true of
them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.oscillator.response import Response
from evolvent.dynamics.pair_model import Drive
from evolvent.dynamics.results.curves import SECANT, TANGENT, CoarseExcitation, PitchCurve
from evolvent.results.error_bars.position_spacing import every_other
from evolvent_meshes.arrays import Floats

WAYS = "up", "down"
SPACING_FACTOR = 0.5
"""Factor of the difference to each half of the positions, so that the mean of both counts. With the first half alone,
14 of 86 bars of the dynamic factor of He's pair at 20 positions were too small, by up to 19 times."""
FEWEST_POSITIONS = 6
"""Least number of positions of which every other one still makes an excitation."""
SAME_JUMP = 0.1
"""Largest relative difference between the speeds of a jump on two excitations; superharmonic resonances up to the fifth
lie twice as far apart."""


@dataclass(frozen=True, eq=False)
class Vibration:
    """Figures of a pair's vibration over n speeds that are compared between excitations."""

    drive: Drive
    """Oscillator of the pair."""
    found: dict[str, list[Response]]
    """"up" and "down": n responses each, as by `response.responses`."""
    jumps: dict[str, tuple[float, ...]]
    """"up" and "down": speeds at which the pair leaves the branch [r/min], in the order in which it comes there."""


@dataclass(frozen=True, eq=False)
class OtherVibration:
    """Vibration through the same speeds on another excitation."""

    what: str
    """Name of the excitation, as in "on elements of twice the size"."""
    remedy: str
    """Remedy, as a sentence, where the vibration on this excitation is too far off."""
    factor: float
    """Error of a figure over its difference between both excitations."""
    vibration: Vibration | None
    """Vibration on the other excitation; None where it could not be computed."""
    failure: str = ""
    """Reason why the vibration could not be computed; empty where it could."""


@dataclass(frozen=True, eq=False)
class VibrationErrors:
    """Error bars of a pair's vibration over n speeds; NaN where they are not known."""

    amplitude: dict[str, Floats]
    """"up" and "down": (n,) errors of the equivalent amplitude [mm]."""
    dynamic_factor: dict[str, Floats]
    """"up" and "down": (n,) errors of the dynamic factor."""
    jumps: dict[str, tuple[float, ...]]
    """"up" and "down": errors of the speeds of jumps [r/min]; NaN of jumps that are not found on another excitation,
    too."""
    mean_stiffness: float
    """Error of the mean stiffness [N/mm]."""
    natural_speed: float
    """Error of the natural speed [r/min]."""
    said: tuple[str, ...] = ()
    """Sentences on missing error bars, and on jumps that are found on one excitation alone."""


def unknown_errors(speeds: int, up: int = 0, down: int = 0) -> VibrationErrors:
    """Error bars of a vibration over so many speeds, with so many jumps running up and down, that was computed on one
    excitation alone: none is known."""
    each, jumps = np.full(speeds, np.nan), {"up": (np.nan,) * up, "down": (np.nan,) * down}
    return VibrationErrors({way: each for way in WAYS}, {way: each for way in WAYS}, jumps, np.nan, np.nan)


def vibration_errors(own: Vibration, others: Sequence[OtherVibration], mean_stiffness: float) -> VibrationErrors:
    """Error bars of a vibration that was computed on other excitations, too; unknown where there are none, or one of
    them failed.

    mean_stiffness: its error [N/mm], see `mean_stiffness_error`.
    """
    return VibrationErrors(
        {way: _error(own, others, way, lambda drive, each: each.equivalent_amplitude) for way in WAYS},
        {way: _error(own, others, way, lambda drive, each: each.largest_force / drive.model.load) for way in WAYS},
        {way: tuple(map(float, _jump_errors(speeds, others, way))) for way, speeds in own.jumps.items()},
        mean_stiffness,
        _natural_speed_error(own.drive, mean_stiffness),
        tuple(sentence for other in others for sentence in _said(own, other)),
    )


def _natural_speed_error(drive: Drive, mean_stiffness: float) -> float:
    """Error of the natural speed [r/min] by an error of the mean stiffness [N/mm]. The speed is in proportion to the
    root of the stiffness in motion, whose compliance is off by as much as that in statics."""
    relative = mean_stiffness * drive.moving_stiffness / drive.mean_stiffness**2
    return 0.5 * relative * drive.natural_speed


def mean_stiffness_error(
    excitation: MeshExcitation, companion: CoarseExcitation, load: float, series_stiffness: float,
    quantity: str = TANGENT,
) -> float:
    """Error [N/mm] of `Drive.mean_stiffness` under a load [N], by mesh and spacing; NaN without a companion. It is that
    of harmonics.csv where nothing gives way in series (series_stiffness: [N/mm], infinite then). quantity: the
    stiffness that is averaged, TANGENT or SECANT."""

    def values(mesh: MeshExcitation) -> Floats:
        depth, tangent = (mesh if np.isinf(series_stiffness) else mesh.in_series(series_stiffness)).under(load)
        return 1e-3 * (load / depth if quantity == SECANT else tangent)

    coarse = None if companion.excitation is None else values(companion.excitation)
    return 1e3 * PitchCurve(quantity, values(excitation), coarse, companion.order).mean_error


def halves(excitation: MeshExcitation) -> tuple[MeshExcitation, ...]:
    """The excitation from every other position, the first or the second one the first; none where positions are odd in
    number, or fewer than `FEWEST_POSITIONS`."""
    loaded, count = excitation.loaded, len(excitation.unloaded_error)
    if count % 2 or count < FEWEST_POSITIONS:
        return ()
    kept = [every_other(count, first) for first in (0, 1)]
    return tuple(
        MeshExcitation(
            excitation.unloaded_error[half],
            replace(loaded, angles=loaded.angles[half], errors=loaded.errors[half], stiffness=loaded.stiffness[half]),
        )
        for half in kept
    )


def same_jumps(speeds: Sequence[float], others: Sequence[float]) -> Floats:
    """For each of the speeds of jumps (k,) the one of the others (m,) that is the same jump, (k,); NaN where there is
    none: the nearest one, to which no other of the speeds is nearer, within `SAME_JUMP`."""
    found = np.full(len(speeds), np.nan)
    if len(speeds) and len(others):
        one, other = np.asarray(speeds), np.asarray(others)
        apart = np.abs(one[:, None] - other)
        nearest = apart.argmin(axis=1)
        mutual = apart.argmin(axis=0)[nearest] == np.arange(len(one))
        same = mutual & (apart.min(axis=1) <= SAME_JUMP * one)
        found[same] = other[nearest[same]]
    return found


def _error(
    own: Vibration, others: Sequence[OtherVibration], way: str, figure: Callable[[Drive, Response], float]
) -> Floats:
    """Errors (n,) of a figure at all speeds, running one way."""

    def values(of: Vibration) -> Floats:
        return np.array([figure(of.drive, each) for each in of.found[way]])

    parts = [
        np.full(len(own.found[way]), np.nan) if (seen := other.vibration) is None
        else other.factor * np.abs(values(own) - values(seen)) for other in others
    ]
    return np.sum(parts, axis=0) if parts else np.full(len(own.found[way]), np.nan)


def _jump_errors(speeds: Sequence[float], others: Sequence[OtherVibration], way: str) -> Floats:
    """Errors (k,) of the speeds of jumps (k,), running one way."""
    total = np.full(len(speeds), 0.0 if others else np.nan)
    for other in others:
        there = () if other.vibration is None else other.vibration.jumps[way]
        total += other.factor * np.abs(np.asarray(speeds) - same_jumps(speeds, there))
    return total


def _said(own: Vibration, other: OtherVibration) -> list[str]:
    """Sentence on why there are no error bars, or on jumps that are found on one of both excitations alone."""
    if other.vibration is None:
        return [f"response.csv: no error bars, as the vibration {other.what} was not found: {other.failure}"]
    parts = []
    for way in WAYS:
        here, there = own.jumps[way], other.vibration.jumps[way]
        if lost := _without(here, there):
            parts.append(f"running {way}, {lost} not found {other.what}")
        if more := _without(there, here):
            parts.append(f"running {way}, {more} found {other.what} alone")
    if not parts:
        return []
    return [f"dynamics.json: {'; '.join(parts)}: whether the pair jumps there is not sure. {other.remedy}"]


def _without(speeds: Sequence[float], others: Sequence[float]) -> str:
    """Clause on the jumps that are not among the others, with their verb; empty where all are."""
    alone = [f"{each:.0f}" for each, same in zip(speeds, same_jumps(speeds, others)) if np.isnan(same)]
    if not alone:
        return ""
    return f"the jump{'s' * (len(alone) > 1)} at {', '.join(alone)} r/min {'are' if len(alone) > 1 else 'is'}"
