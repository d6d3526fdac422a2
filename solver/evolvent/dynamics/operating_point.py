"""Mesh force of a pair at its operating speed, on the flanks as they are: contact and wear are computed under it.

Excitation, oscillator and motion follow from the condensed gears and the flanks' charts. At the first flanks the motion
is that of a pair which has run up to the speed, or down to it; at later ones, such as worn flanks, it continues the
last motion.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from mpi4py import MPI

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import (
    LoadedMesh,
    Positions,
    loaded_mesh,
    loaded_mesh_again,
    under_torques,
)
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed, speeds_to_periods
from evolvent.dynamics.oscillator.response import histories
from evolvent.dynamics.oscillator.settling import LONGEST_REPEAT, Settled, settled, static_state
from evolvent.dynamics.oscillator.steady_state import NoSteadyState, SteadyState, steady_state
from evolvent.dynamics.oscillator.torsional_model import History
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive
from evolvent.fem.parallel.ranks import together
from evolvent.gears.gear_load import GearLoad, TorqueCourse
from evolvent.gears.gear_model import GearModel
from evolvent.gears.problem.flank_deviations import FlankCharts
from evolvent.gears.sweep.parallel_sweep import division
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.sweep.position_search import SearchedAt, SharedPosition, searched_at
from evolvent.gears.unloaded_error import RigidFlanks, unloaded_error
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

Motion = SteadyState | Settled
SLOWEST, FASTEST = 1.0 / 6.0, 1.6
"""Speeds at which a run-up and a run-down begin, over the natural speed."""
RUN_SPEEDS = 200
"""Speeds of a run-up or run-down: 0.4 % of the natural speed apart near resonance, a tenth of its peak's width at a
damping ratio of 0.03."""
SAMPLES = 240
"""Fewest samples of the mesh force in a pitch."""
LEAST_FORCE = 1e-3
"""Least mesh force under which contact is computed, over the static one: where flanks separate, no force at all would
leave the position of the gears open."""


@dataclass(frozen=True, eq=False)
class Start:
    """Initial state of an operation on given flanks."""

    state: Floats
    """Displacement s [mm] and velocity ṡ [mm/s] of the oscillator (2,) at phase 0."""
    forces: tuple[float, float]
    """Smallest and largest mesh force over the static one."""
    positions: Positions | None = None
    """This rank's searched positions, on the same condensed gears; None: they are searched anew."""

    def without_positions(self) -> Start:
        """Initial state for gears that are condensed anew."""
        return Start(self.state, self.forces)


@dataclass(frozen=True, eq=False)
class Operation:
    """Vibration of a pair at one speed, and its mesh force."""

    excitation: MeshExcitation
    """Excitation by the mesh."""
    drive: Drive
    """Oscillator of the pair."""
    speed: MeshSpeed
    """Speed of the pinion."""
    motion: Motion
    """Motion after the vibration has settled."""
    paths: tuple[History, ...]
    """Histories of the mesh periods after which the motion repeats; of sixteen where it does not."""
    load: GearLoad
    """Mesh force over a mesh period, the mean or the largest of `paths`, as a torque that repeats with the mesh."""
    lifted: float
    """Share of the mesh period in which `load` is `LEAST_FORCE`, because the force is less."""
    positions: Positions | None
    """This rank's positions of the excitation; None in space, where they would take too much memory."""

    @property
    def start(self) -> Start:
        """Initial state of the next operation, on nearly the same flanks."""
        return Start(self.state, self.forces, self.positions)

    @property
    def forces(self) -> tuple[float, float]:
        """Smallest and largest mesh force over the static one."""
        load = self.drive.model.load
        return min(p.smallest_force for p in self.paths) / load, max(p.largest_force for p in self.paths) / load

    @property
    def heaviest_torque_share(self) -> float:
        """Largest mesh force over that of the heaviest torque of the force surface, above which the surface is
        extrapolated linearly; NaN where the mesh is a stiffness."""
        if self.drive.settings.mesh != "force_surface":
            return math.nan
        return self.forces[1] * self.drive.model.load / float(self.excitation.loaded.forces[-1])

    @property
    def state(self) -> Floats:
        """Displacement s [mm] and velocity ṡ [mm/s] of the oscillator (2,) at phase 0."""
        return self.motion.state

    @property
    def repeats(self) -> int:
        """Mesh periods after which the motion repeats, 0 where it does not, see `Settled`."""
        return self.motion.repeats if isinstance(self.motion, Settled) else 1


@dataclass(frozen=True)
class OperatingPoint:
    """Operating speed of a pair, with the settings of its vibration."""

    settings: DriveSettings
    """Inertia, damping, backlash, and the model of the mesh."""
    speed: float
    """Speed of the pinion [r/min]."""
    direction: Literal["up", "down"]
    """Direction of approach to the speed, from lower or from higher ones, where the motion depends on it."""
    shares: tuple[float, ...]
    """Torques of the force surface over the pair's, ascending; 1 among them."""
    positions: int
    """Positions of the pitch for the excitation."""
    of_several: Literal["mean", "largest"] = "mean"
    """Mesh force at each phase where the motion repeats after several mesh periods: their mean, which gives the wear of
    all together, or their largest, which is safe for stresses."""

    def on(self, model: GearModel, charts: FlankCharts, comm: MPI.Comm, before: Start | None = None) -> Operation:
        """Operation of condensed gears; their own torque is the static one. Collective.

        Where the mesh force has stayed within some of the torques of the force surface, those are solved alone, and
        more of them where it leaves these.

        charts: all deviations from the designed flanks, wear included.
        before: state of an operation on nearly the same flanks; None: the pair has just come to the speed.

        Raises NotConverged, SearchError, NoForceSurface, NoSteadyState.
        """
        angles = np.array(uniform_pitch(model.pair.pinion.z, self.positions).angles)
        error = unloaded_error(RigidFlanks(model.pair, charts), angles, model.load.on)
        shares = self.shares if before is None else self._around(before.forces)
        positions = None if before is None else before.positions
        while True:
            loaded, positions = self._loaded(model, shares, angles, comm, positions)
            found = self._operation(model, MeshExcitation(error, loaded), shares, before, positions)
            wider = self._around(found.forces)
            if set(wider) <= set(shares):
                return found
            shares = tuple(sorted({*shares, *wider}))

    def _around(self, forces: tuple[float, float]) -> tuple[float, ...]:
        """The torques that enclose forces from the first to the second, and the static one; all over the static."""
        low, high = min(forces[0], 1.0), max(forces[1], 1.0)
        first = max(bisect_left(self.shares, low) - 1, 0)
        return self.shares[first : bisect_right(self.shares, high) + 1]

    def _loaded(
        self, model: GearModel, shares: tuple[float, ...], angles: Floats, comm: MPI.Comm, kept: Positions | None
    ) -> tuple[LoadedMesh, Positions | None]:
        """Loaded mesh of a pitch under some of the torques, and its positions in 2D. kept: searched before."""
        torques = self._torques(model, shares)
        if model.bodies[0].d == 2:
            return loaded_mesh_again(model, torques, angles, comm, kept)
        return loaded_mesh(model, torques, angles, comm), None

    def _operation(
        self, model: GearModel, excitation: MeshExcitation, shares: tuple[float, ...], before: Start | None,
        positions: Positions | None,
    ) -> Operation:
        # every rank follows the motion: it takes less than sending it
        pair = drive(model.pair, excitation, float(excitation.loaded.forces[shares.index(1.0)]), self.settings)
        speed = MeshSpeed(self.speed, pair.teeth)
        period = speed.mesh_period
        motion = self._arrived(pair, period) if before is None else _followed(pair, period, before.state)
        motion = _bounded(motion, self.speed)
        paths = _paths(pair, period, motion)
        course, lifted = _course(model.pair, pair, paths, np.mean if self.of_several == "mean" else np.max)
        return Operation(excitation, pair, speed, motion, paths, replace(model.load, course=course), lifted, positions)

    def searched(
        self, model: GearModel, torques: Sequence[float], places: Sequence[SearchedAt], comm: MPI.Comm
    ) -> Positions:
        """This rank's positions under some torques [N·mm], searched at given places (positions · torques,): all of
        them, in their order."""
        models, count = under_torques(model, torques), len(torques)
        numbers = range(self.positions)[division(self.positions, comm.size)[comm.rank]]

        def position(i: int) -> Mapping[float, SharedPosition]:
            return {
                torque: searched_at(each, places[count * i + j], [0.0])
                for j, (torque, each) in enumerate(zip(torques, models))
            }

        return together(comm, lambda: tuple(position(i) for i in numbers))

    def _torques(self, model: GearModel, shares: tuple[float, ...]) -> list[float]:
        """Torques of the force surface on the whole face [N·mm]."""
        return [share * model.load.torque * model.width_factor for share in shares]

    def _arrived(self, pair: Drive, period: float) -> Motion:
        """Motion of a pair that has run up, or down, to the speed. One that is slower, or faster, than where it would
        come from settles from rest."""
        other = (SLOWEST if self.direction == "up" else FASTEST) * pair.natural_speed
        if (self.speed <= other) == (self.direction == "up"):
            return settled(pair.model, period, static_state(pair.model))
        periods = speeds_to_periods(np.linspace(other, self.speed, RUN_SPEEDS), pair.teeth)
        motion: Motion = settled(pair.model, float(periods[0]), static_state(pair.model))
        for each in periods[1:]:
            escaped = isinstance(motion, Settled) and motion.escaped  # then from rest
            motion = _followed(pair, float(each), static_state(pair.model) if escaped else motion.state)
        return motion


def _followed(pair: Drive, period: float, before: Floats) -> Motion:
    """Motion after a small change of the excitation, continued from the state before."""
    try:
        found = steady_state(pair.model, period, before)
    except NoSteadyState:
        found = None
    if found is not None and found.stable:
        return found
    return settled(pair.model, period, before)


def _bounded(motion: Motion, speed: float) -> Motion:
    """Motion as given. Raises NoSteadyState where it grows beyond measure."""
    if isinstance(motion, Settled) and motion.escaped:
        raise NoSteadyState(
            f"vibration at {speed:g} r/min: wanted a motion that stays bounded, found one that grows beyond measure, "
            "as the varying stiffness feeds in more than the dampers take out; give more damping "
            "(dynamics.damping_ratio) or another speed (dynamics.operating_rpm)"
        )
    return motion


def _paths(pair: Drive, period: float, motion: Motion) -> tuple[History, ...]:
    """Histories of the mesh periods of a motion."""
    repeats = motion.repeats or LONGEST_REPEAT if isinstance(motion, Settled) else 1
    return tuple(histories(pair.model, period, motion.state, repeats, np.arange(SAMPLES) / SAMPLES))


def _course(
    gears: GearPair, pair: Drive, paths: tuple[History, ...], of_several: Callable[..., Floats]
) -> tuple[TorqueCourse, float]:
    """Mesh force of these mesh periods over the static one, and the share of the period in which it is raised to
    LEAST_FORCE. of_several: reduces their forces, (periods, phases), along the first axis."""
    phases = np.arange(SAMPLES) / SAMPLES
    force = of_several([np.interp(phases, path.phases, path.force) for path in paths], axis=0) / pair.model.load
    low = force < LEAST_FORCE
    shares = np.where(low, LEAST_FORCE, force)
    if pair.settings.driving is Member.WHEEL:  # phase τ is the rotation −τ
        shares = np.roll(shares[::-1], 1)
    return TorqueCourse(shares, gears.pinion.z), float(np.mean(low))
