"""Pressures of transients beside their statics."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import numpy as np

from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.dynamics.results.transient.cases import TransientCase, case_pressures
from evolvent.dynamics.transient.steady_state import MeshPeriods
from evolvent.gears.gear_model import GearModel
from evolvent.gears.pressure.pitch_pressure import PitchPressure
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import with_load
from tests.support.running.transient_pairs import condensed

POSITIONS = 40


def positions(model: GearModel, torque: float) -> tuple[PositionResult, ...]:
    """Of a mesh period without friction, under another torque."""
    loaded = with_load(model, torque, Member.PINION)
    swept = sweep_pitch(loaded, uniform_pitch(model.pair.pinion.z, POSITIONS), [0.0], initial_state([0.0]))
    return tuple(position.results[0] for position in swept)


def case(calm: tuple[PositionResult, ...], begun: tuple[PositionResult, ...] = ()) -> TransientCase:
    """A motion without inertia, with these positions from rest."""
    moments, beginning = (tuple(SimpleNamespace(result=each) for each in row) for row in (calm, begun))
    found = cast(MeshPeriods, SimpleNamespace(moments=moments, beginning=beginning))
    return TransientCase(MeshSpeed(60.0, 50), 0.0, found, calm, 1.0)


def test_a_blow_widens_the_tip_edge_zones() -> None:
    """Problem: a spur pair, two mesh periods from rest under 25 times the load. There teeth deflect further and tip
    edges bear earlier. Between the zones none of them bears in any position, which without the start's would not hold;
    the zones of the motion and of statics are the same."""
    model = condensed("spur")
    calm, blow = (positions(model, ratio * model.load.torque) for ratio in (0.2, 5.0))
    (plain,) = case_pressures(model, [case(calm)])
    (begun,) = case_pressures(model, [case(calm, blow + blow)])
    (heavy,) = case_pressures(model, [case(blow)])
    edges = np.concatenate([cut.roll_distance[cut.edge] for cut in heavy.moving.cuts])

    def inside(zones: PitchPressure) -> int:
        start, end = zones.inner_path
        return int(np.sum((edges > start) & (edges < end)))

    assert inside(begun.moving) == inside(begun.still) == 0 < inside(plain.moving)
    assert begun.moving.inner_path == begun.still.inner_path
