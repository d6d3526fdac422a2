"""Motions at chosen speeds over one repeat: their table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.oscillator.response import SAMPLES, histories
from evolvent.dynamics.oscillator.settling import LONGEST_REPEAT
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.oscillator.torsional_model import History
from evolvent.dynamics.pair_model import Drive
from evolvent.dynamics.results.response import UM, speed_of
from evolvent.results.tables.table import Table
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class HistoryRow:
    """A line of histories.csv: an instant of a motion."""

    speed_rpm: float
    """Of the pinion, one of dynamics.histories_rpm, or dynamics.operating_rpm."""
    way: str
    """up or down, as in response.csv."""
    phase: float
    """In mesh periods, over the periods after which the motion repeats; sixteen of one that does not."""
    time_ms: float
    """Since phase 0."""
    transmission_error_um: float
    """s, the dynamic transmission error with the unloaded one in it."""
    elastic_um: float
    """s − e: how far the loaded flanks are beyond first contact; below 0 they are apart. With elastic bodies s is taken
    between the bores, which swing beside the mass: `contact` says what touches."""
    velocity_mm_per_s: float
    """ds/dt; with elastic bodies of the mass on the mesh."""
    force_N: float
    """Of the mesh, damping included; where contact begins or ends it jumps between two lines."""
    contact: int
    """1 where the loaded flanks touch, −1 where the back flanks do, 0 where none do."""
    displacement_um: float
    """Of the mass on the mesh, whose rate velocity_mm_per_s is: that of transmission_error_um with rigid bodies."""


HISTORIES = Table("histories.csv", HistoryRow)


@dataclass(frozen=True, eq=False)
class Motion:
    """What a pair does at a speed, one mesh period after the other."""

    speed: float
    """Of the pinion [r/min]."""
    way: str
    """up or down."""
    period: float
    """Of the mesh [s]."""
    repeats: int
    """As in `Running`."""
    paths: tuple[History, ...]
    """Its mesh periods, until it repeats."""

    @property
    def phases(self) -> Floats:
        """(n,) from 0 [mesh periods], each once."""
        inner = [path.phases[:-1] + ahead for ahead, path in enumerate(self.paths)]
        return np.append(np.concatenate(inner), float(len(self.paths)))

    def over(self, name: str) -> Floats:
        """A field of the paths at these phases (n,)."""
        inner = [getattr(path, name)[:-1] for path in self.paths]
        return np.append(np.concatenate(inner), getattr(self.paths[-1], name)[-1])


def motions(drive: Drive, swept: SpeedSweep, speeds: Sequence[float]) -> list[Motion]:
    """Up and down at each of these speeds of the sweep [r/min]."""
    known = np.array([speed_of(drive, float(period)) for period in swept.periods])
    found, phases = [], np.arange(SAMPLES) / SAMPLES
    for speed in speeds:
        i = int(np.argmin(np.abs(known - speed)))
        period = float(swept.periods[i])
        for way, run in (("up", swept.up[i]), ("down", swept.down[i])):
            count = run.repeats or LONGEST_REPEAT
            paths = histories(drive.model, period, run.motion.state, count, phases)
            found.append(Motion(float(known[i]), way, period, run.repeats, tuple(paths)))
    return found


def history_rows(found: Iterable[Motion]) -> Iterator[HistoryRow]:
    """One motion after the other."""
    for motion in found:
        names = "transmission_error", "error", "velocity", "force", "side", "displacement"
        for phase, s, e, velocity, force, side, displacement in zip(motion.phases, *map(motion.over, names)):
            yield HistoryRow(
                speed_rpm=motion.speed, way=motion.way, phase=float(phase), time_ms=1e3 * float(phase) * motion.period,
                transmission_error_um=UM * float(s), elastic_um=UM * float(s - e), velocity_mm_per_s=float(velocity),
                force_N=float(force), contact=int(side), displacement_um=UM * float(displacement),
            )
