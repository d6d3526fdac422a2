"""The resolved contact of a pair at some positions under some torques, without friction, for comparison with line
contact."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from evidence.benchmarks.line.pairs import Case
from evolvent.dynamics.excitation.loaded_mesh import searched_positions, under_torques
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.pressure.contact_slices import Slices, slices
from evolvent.gears.pressure.pitch_pressure import facets_of
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult, position_result
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True, eq=False)
class ResolvedLoad:
    """n positions under a torque."""

    error: Floats
    """(n,) transmission errors [mm]."""
    stiffness: Floats
    """(n,) tangent stiffnesses [N/mm]."""
    cuts: list[Slices]
    """Slices of the contact at each position."""
    forces: list[dict[int, float]]
    """Normal forces of the tooth pairs at each position [N; N/mm in the plane]."""


@dataclass(frozen=True, eq=False)
class ResolvedPitch:
    """Positions under several torques."""

    angles: Floats
    """(n,) rotations of the pinion [rad]."""
    torques: list[float]
    """Torques [N·mm]."""
    under: list[ResolvedLoad]
    """Positions under each torque."""
    seconds: float
    """Processor time of condensing and positions."""


def resolved_pitch(case: Case) -> ResolvedPitch:
    """Resolves the contact of a pair, on meshes for all of its torques."""
    problem, begin = case.problem, time.process_time()
    angles = np.array(uniform_pitch(problem.pair.pinion.z, case.positions).angles)
    torques = [problem.torque * percent / 100.0 for percent in case.percents]
    model = prepare_model(replace(problem, torque=torques[-1], mesh_torques=(torques[0], torques[-1]))).model
    found = list(zip(*_positions(model, torques, angles)))
    return ResolvedPitch(angles, torques, [_load(model, row) for row in found], time.process_time() - begin)


def _positions(model: GearModel, torques: Sequence[float], angles: Floats) -> Iterator[list[PositionResult]]:
    """Positions one after the other, each under all torques."""
    models = under_torques(model, torques)
    for row in searched_positions(models, angles):
        yield [
            position_result(own, each.contact, each.smooth, 0.0, each.stiffness, 0) for own, each in zip(models, row)
        ]


def _load(model: GearModel, results: Sequence[PositionResult]) -> ResolvedLoad:
    materials, facets = (model.bodies[0].material, model.bodies[1].material), facets_of(model)
    return ResolvedLoad(
        np.array([each.transmission_error for each in results]),
        np.array([each.stiffness for each in results]) * model.width_factor,
        [slices(each, facets, materials) for each in results],
        [{int(tooth): each.contact.normal_force(int(tooth)) for tooth in np.unique(each.contact.tooth)}
         for each in results],
    )
