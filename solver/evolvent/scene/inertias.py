"""Moments of inertia of a scene's gears."""

from __future__ import annotations

from evolvent.gears.problem.gear_inertia import polar_moment
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent_meshes.gears.pair import GearPair

KG_M2 = 1e3
"""One kg·m² in t·mm²."""


def moments_of_inertia(pair: GearPair, section: DynamicsSection) -> tuple[float, float]:
    """Moments of inertia of pinion and wheel [t·mm²]: those that the section gives, else those of the gear bodies."""
    given = section.pinion_inertia_kg_m2, section.wheel_inertia_kg_m2
    pinion, wheel = (
        polar_moment(gear, section.density) if value is None else KG_M2 * value
        for gear, value in zip(pair.gears, given)
    )
    return pinion, wheel
