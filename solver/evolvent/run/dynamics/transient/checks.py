"""Scenes that `evolvent transient` refuses before it computes, and keys that it does not use."""

from __future__ import annotations

from evolvent.check.planned_cost import too_many_modes
from evolvent.scene.backlash import unnamed_backlash
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection, TransientSection
from evolvent.scene.schema.errors import SceneError
from evolvent.scene.vibration_limits import sense_of_transient
from evolvent_meshes.errors import InputError

UNUSED = "series_stiffness_N_per_um", "ground_damping_ratio", "mesh"
"""Keys of [dynamics] that `evolvent transient` does not use."""


def transient_section(scene: Scene) -> TransientSection:
    """Section [transient] of the scene. Raises InputError where it has none."""
    if scene.transient is None:
        raise InputError(
            "transient: found no section [transient]; wanted one with speeds; remedy: --set "
            "transient.speeds_rpm=[1500], or write [transient] into the scene"
        )
    return scene.transient


def require_possible(scene: Scene) -> None:
    """Raises SceneError where the wheel drives; where a transient from rest has no known backlash, as its impact
    separates the flanks; or where there are too many natural modes. From statics no backlash is needed as long as the
    flanks do not separate."""
    if problem := sense_of_transient(scene.load):
        raise SceneError([problem])
    given, section = None if scene.dynamics is None else scene.dynamics.backlash_um, transient_section(scene)
    if section.start == "rest" and (problem := unnamed_backlash(scene.gear_pair(), given)):
        raise SceneError([problem])
    if problem := too_many_modes(scene, section):
        raise SceneError([problem])


def unused_keys(section: DynamicsSection) -> list[str]:
    """A sentence on the keys of [dynamics] that the scene gives and `evolvent transient` does not use."""
    standard = DynamicsSection()
    names = [name for name in UNUSED if getattr(section, name) != getattr(standard, name)]
    if not names:
        return []
    keys = ", ".join(f"dynamics.{name}" for name in names)
    return [f"{keys}: not in a transient, whose gears stand on rigid shafts and whose flanks are in contact themselves"]
