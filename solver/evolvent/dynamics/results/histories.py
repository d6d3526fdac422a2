"""Table of motions at chosen speeds over one repeat."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.oscillator.response import SAMPLES, histories
from evolvent.dynamics.oscillator.settling import LONGEST_REPEAT
from evolvent.dynamics.oscillator.speed_sweep import SpeedSweep
from evolvent.dynamics.oscillator.torsional_model import History
from evolvent.dynamics.pair_model import Drive
from evolvent.dynamics.results.response import UM
from evolvent.results.tables.table import Table
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class HistoryRow:
    """A line of histories.csv: an instant of a motion."""

    speed_rpm: float
    """Speed of the pinion: one of dynamics.histories_rpm, or dynamics.operating_rpm."""
    way: str
    """Direction in which the pair has come to the speed: up or down, as in response.csv."""
    phase: float
    """Phase in mesh periods, over the periods after which the motion repeats; over sixteen of one that does not."""
    time_ms: float
    """Time since phase 0."""
    transmission_error_um: float
    """Dynamic transmission error s, with the unloaded one in it."""
    elastic_um: float
    """Deflection s − e: how far the loaded flanks are beyond first contact; below 0 they are apart. With elastic bodies
    s is taken between the bores, which swing beside the mass: `contact` says what touches."""
    velocity_mm_per_s: float
    """Velocity ds/dt; with elastic bodies that of the mass on the mesh."""
    force_N: float
    """Mesh force, damping included; it jumps between two lines where contact begins or ends."""
    contact: int
    """1 where the loaded flanks touch, −1 where the back flanks do, 0 where none do."""
    displacement_um: float
    """Displacement of the mass on the mesh, whose rate is velocity_mm_per_s; transmission_error_um with rigid
    bodies."""


HISTORIES = Table("histories.csv", HistoryRow)


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of a pair at one speed, one mesh period after the other."""

    speed: MeshSpeed
    """Speed of the pinion."""
    way: str
    """Direction in which the pair has come to the speed: up or down."""
    repeats: int
    """Mesh periods after which the motion repeats; 0 where it does not, as in `Running`."""
    paths: tuple[History, ...]
    """Histories of the mesh periods, until the motion repeats."""

    @property
    def phases(self) -> Floats:
        """(n,) phases from 0 on [mesh periods], each once."""
        inner = [path.phases[:-1] + ahead for ahead, path in enumerate(self.paths)]
        return np.append(np.concatenate(inner), float(len(self.paths)))

    def over(self, name: str) -> Floats:
        """A field of the histories at all phases (n,)."""
        inner = [getattr(path, name)[:-1] for path in self.paths]
        return np.append(np.concatenate(inner), getattr(self.paths[-1], name)[-1])


def motions(drive: Drive, swept: SpeedSweep, speeds: Sequence[float]) -> list[Motion]:
    """Motions running up and down at each of these speeds of the sweep [r/min]."""
    known = [MeshSpeed.of_period(period, drive.teeth) for period in swept.periods]
    found, phases = [], np.arange(SAMPLES) / SAMPLES
    for speed in speeds:
        i = int(np.argmin([abs(each.rpm - speed) for each in known]))
        period = float(swept.periods[i])
        for way, run in (("up", swept.up[i]), ("down", swept.down[i])):
            count = run.repeats or LONGEST_REPEAT
            paths = histories(drive.model, period, run.motion.state, count, phases)
            found.append(Motion(known[i], way, run.repeats, tuple(paths)))
    return found


def history_rows(found: Iterable[Motion]) -> Iterator[HistoryRow]:
    """Rows of histories.csv, one motion after the other."""
    for motion in found:
        speed, ms = motion.speed.rpm, 1e3 * motion.speed.mesh_period
        names = "transmission_error", "error", "velocity", "force", "side", "displacement"
        for phase, s, e, velocity, force, side, displacement in zip(motion.phases, *map(motion.over, names)):
            yield HistoryRow(
                speed_rpm=speed, way=motion.way, phase=float(phase), time_ms=ms * float(phase),
                transmission_error_um=UM * float(s), elastic_um=UM * float(s - e), velocity_mm_per_s=float(velocity),
                force_N=float(force), contact=int(side), displacement_um=UM * float(displacement),
            )
