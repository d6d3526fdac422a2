"""Yang's pair from rest, as the paper drives it: the pinion at its speed at once, the wheel at rest under its torque.

The paper computes 0.0015 s "dynamic, implicit" with a speed on the pinion and a load on the wheel, and prints no course
of the speed over time. Read as printed, the pinion runs into a wheel at rest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from evidence.checkout import DEMOS
from evidence.pages.papers.kept_runs.kept import Named
from evolvent.contact.transient.time_schemes.time_scheme import MotionState, TimeScheme
from evolvent.dynamics.transient.driven_pair import driven_pair, resolved_modes
from evolvent.dynamics.transient.kept_contacts import KeptContacts
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_transient import PairMoment, PairState, PairTransient
from evolvent.fem.backend import dolfinx_compat
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state, sweep_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.pair_dynamics import drive_settings
from evolvent.scene.scene import Scene, load_scene
from evolvent.scene.schema.dynamics import DynamicsSection

WHEEL_TORQUE = 250.0 * 60.0 / 17.0  # N·m
DURATION = 0.0015  # s, the paper's
SPEED, FRICTION, POSITIONS = 1500.0, 0.07, 120
"""[r/min]; μ; time steps a mesh period: a blow takes some ten of them."""
FEW = 4
"""Positions of a pitch, whose mean stiffness makes the damping."""


@dataclass(frozen=True)
class FirstBlow:
    """Up to where the mesh force has passed its largest value."""

    force: float
    """The largest mesh force over the load."""
    time: float
    """When [s]."""
    pressure: float
    """Largest pressure then, over the largest of a static pitch."""
    one_degree: float
    """Largest force over the load of the wheel's inertia on the mean stiffness."""
    ramp_percent: float
    """By how much the load would rise if the pinion's speed rose evenly over the paper's time."""


def first_blow() -> FirstBlow:
    """Solves it. Raises NotConverged, SearchError, Unbalanced."""
    dolfinx_compat.silence_logs()
    scene = load_scene(DEMOS / "yang2022.toml", [
        "mesh.level=quick", "load.on=wheel", f"load.torque_Nm={WHEEL_TORQUE}", f"contact.friction=[{FRICTION}]",
        f"sweep.positions={POSITIONS}", f"transient.speeds_rpm=[{SPEED}]",
    ])  # fmt: skip
    model = prepare_model(gear_problem(scene)).model
    static = _static(model)
    pair = _moving(scene, model, static)
    omega = 2.0 * np.pi * SPEED / 60.0
    moments = list(_until_it_falls(_started(pair, omega)))
    load = pair.drive.torque / pair.lever
    largest = max(moments, key=lambda moment: moment.mesh_force)
    stiffness = float(np.mean([result.stiffness for result in static]))
    mass, speed = pair.drive.inertia / pair.lever**2, omega / model.pair.ratio * pair.base_radii[1]
    return FirstBlow(
        largest.mesh_force / load, largest.time,
        float(largest.result.pressure.max()) / max(float(result.pressure.max()) for result in static),
        1.0 + float(np.sqrt(1.0 + stiffness * mass * speed**2 / load**2)),
        100.0 * mass * speed / DURATION / load,
    )  # fmt: skip


def _static(model: GearModel) -> Sequence[PositionResult]:
    """A few positions of a pitch."""
    step = 2.0 * np.pi / model.pair.pinion.z / FEW
    pitch = Pitch(tuple(step * k for k in range(FEW)))
    return [position.results[0] for position in sweep_pitch(model, pitch, [FRICTION], initial_state([FRICTION]))]


def _moving(scene: Scene, model: GearModel, static: Sequence[PositionResult]) -> MovingPair:
    dynamics, section = DynamicsSection(), scene.transient
    assert section is not None
    sampled = SPEED / 60.0 * model.pair.pinion.z * POSITIONS
    modes = resolved_modes(gear_problem(scene), model, dynamics.density_kg_m3, sampled, section.modes_per_harmonic)
    settings = drive_settings(model.pair, dynamics)
    return driven_pair(model, modes, settings, static, section.mode_damping_ratio, constant_speed=True)


def _started(pair: MovingPair, omega: float) -> Iterator[PairMoment]:
    """Undeformed, the pinion at its speed, the wheel at rest."""
    contacts = KeptContacts(pair, POSITIONS, 3)
    nothing = np.zeros(pair.count + 1)
    velocity = np.append(nothing[1:], omega / pair.model.pair.ratio)  # against the nominal rotation
    state = PairState(MotionState(nothing, velocity, nothing), None, nothing[1:])
    return PairTransient(pair, FRICTION, omega, TimeScheme(0.8), contacts).run(state, 1)


def _until_it_falls(moments: Iterator[PairMoment]) -> Iterator[PairMoment]:
    """Up to the first moment whose mesh force is less than that before."""
    before = -np.inf
    for moment in islice(moments, POSITIONS):
        yield moment
        if moment.mesh_force < before:
            return
        before = moment.mesh_force


def figures() -> Named:
    """(name, value) of each figure."""
    blow = first_blow()
    yield "rest_force_ratio", blow.force
    yield "rest_time_us", 1e6 * blow.time
    yield "rest_pressure_ratio", blow.pressure
    yield "rest_one_degree_ratio", blow.one_degree
    yield "rest_ramp_percent", blow.ramp_percent


def sentence(kept: dict[str, float]) -> str:
    """What the figures say."""
    return (
        f"From rest, as printed (the pinion at 1500 r/min at once, the wheel at rest under its torque): the mesh force "
        f"rises to **{kept['rest_force_ratio']:.1f} times the load** after {kept['rest_time_us']:.0f} µs "
        f"({kept['rest_one_degree_ratio']:.1f} times by the wheel's inertia on the mean mesh stiffness), the largest "
        f"pressure to {kept['rest_pressure_ratio']:.1f} times its static one, and the flanks then part. The paper's "
        "curves have nothing of the kind. If the speed rises evenly over the 0.0015 s, the acceleration of the wheel "
        f"adds {kept['rest_ramp_percent']:.0f} % to the load."
    )
