"""Moments of inertia of a scene's gears."""

from __future__ import annotations

from evolvent.gears.problem.gear_inertia import polar_moment
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent_meshes.gears.pair import GearPair

KG_M2 = 1e3
"""t·mm² per kg·m²."""


def moments_of_inertia(pair: GearPair, section: DynamicsSection) -> tuple[float, float]:
    """Of pinion and wheel [t·mm²]: what the section says, else that of the gear body."""
    given = section.pinion_inertia_kg_m2, section.wheel_inertia_kg_m2
    pinion, wheel = (
        polar_moment(gear, section.density_kg_m3) if value is None else KG_M2 * value
        for gear, value in zip(pair.gears, given)
    )
    return pinion, wheel
