"""The cost of transient contact of gear pairs: CPU seconds of one process with one thread."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from math import nan

from mpi4py import MPI

from evidence.benchmarks.motion.motion_row import MotionRow
from evidence.checkout import DEMOS
from evolvent.contact.transient.time_schemes.time_scheme import TimeScheme
from evolvent.dynamics.of_scene import drive_settings
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.transient.driven_pair import driven_pair, loaded_as_static, resolved_modes
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.pair_transient import PairTransient
from evolvent.dynamics.transient.quasi_static_start import quasi_static_starts
from evolvent.dynamics.transient.steady_state import MeshPeriods, until_steady
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.sweep.periodic_pitch import one_pitch, sweep_until_periodic
from evolvent.gears.sweep.pitch_sweep import initial_state, uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene
from evolvent.scene.schema.dynamics import DynamicsSection

STEP_BAR, PAIR_BAR = 1.5, 900.0
"""Seconds of a step over those of a position; [s] until a motion repeats: docs/transient_method.md."""


@dataclass(frozen=True)
class TransientSizes:
    """What is run."""

    positions: int
    """Of the spur pair's mesh period."""
    helical_positions: int
    helical_scene: str
    """In demos/."""
    speed: float
    """Of both [r/min]."""


FULL = TransientSizes(40, 20, "yang2022.toml", 1500.0)
SMALL = TransientSizes(6, 3, "he2022.toml", 1500.0)


@dataclass(frozen=True)
class Cost:
    """CPU seconds of a transient."""

    position: float
    """A position without inertia."""
    step: float
    """A time step."""
    whole: float
    """All in all."""
    periods: int
    """Mesh periods until the motion repeats."""


def rows(sizes: TransientSizes) -> Iterator[MotionRow]:
    """He's spur pair without friction, Yang's helical pair at μ = 0.1: a step over a position; Yang's all in all."""
    dolfinx_compat.silence_logs()
    spur = cost(_scene("he2022.toml", sizes.positions, sizes.speed, 0.0))
    yield MotionRow(f"He's pair, {sizes.positions} positions: a time step over a position", spur.step, spur.position,
                    STEP_BAR)
    helical = cost(_scene(sizes.helical_scene, sizes.helical_positions, sizes.speed, 0.1))
    name = f"helical pair, {sizes.helical_positions} positions, friction"
    yield MotionRow(f"{name}: a time step over a position", helical.step, helical.position, STEP_BAR)
    what = f"{name}: from the scene to a motion that repeats, {helical.periods} mesh periods"
    yield MotionRow(what, helical.whole, nan, PAIR_BAR)


def cost(scene: Scene) -> Cost:
    """Of a scene with one speed and one friction coefficient."""
    begin = time.process_time()
    model = prepare_model(gear_problem(scene)).model
    swept, position = _statics(scene, model)
    motion, step = _steady(scene, model, swept)
    return Cost(position, step, time.process_time() - begin, motion.periods)


def _statics(scene: Scene, model: GearModel) -> tuple[list[PositionResult], float]:
    """Positions of a pitch, and CPU seconds of one of those that were solved for it."""
    begin, frictions = time.process_time(), list(scene.contact.friction)
    pitch = uniform_pitch(model.pair.pinion.z, scene.sweep.positions)
    swept = list(sweep_until_periodic(model, pitch, frictions, initial_state(frictions), MPI.COMM_SELF))
    seconds = (time.process_time() - begin) / len(swept)
    return [position.results[0] for position in one_pitch(swept)], seconds


def _steady(scene: Scene, model: GearModel, static: list[PositionResult]) -> tuple[MeshPeriods, float]:
    """The motion that repeats, and CPU seconds of one of the time steps up to it; natural modes apart."""
    section, dynamics, frictions = scene.transient, scene.dynamics or DynamicsSection(), list(scene.contact.friction)
    assert section is not None
    (speed,) = section.speeds_rpm
    problem, positions = gear_problem(scene), scene.sweep.positions
    turning = MeshSpeed(speed, model.pair.pinion.z)
    sampled = turning.mesh_frequency * positions
    modes = resolved_modes(problem, model, dynamics.density, sampled, section.modes_per_harmonic)
    settings = drive_settings(problem.pair, dynamics)
    pair = loaded_as_static(driven_pair(model, modes, settings, static, section.mode_damping_ratio, False), static)
    contacts = KeptContacts(pair, positions, model.bodies[0].d if any(frictions) else 1)
    (start,) = quasi_static_starts(pair, contacts.step_angle, frictions)
    begin = time.process_time()
    transient = PairTransient(pair, frictions[0], turning, TimeScheme(section.spectral_radius), contacts)
    motion = until_steady(transient, start.at(transient.time_step), section.mesh_periods, section.steady_change)
    return motion, (time.process_time() - begin) / len(motion.errors)


def _scene(name: str, positions: int, speed: float, friction: float) -> Scene:
    """Of a demo, at level quick."""
    return load_scene(DEMOS / name, [
        "mesh.level=quick", f"sweep.positions={positions}", f"contact.friction=[{friction}]",
        f"transient.speeds_rpm=[{speed}]",
    ])
