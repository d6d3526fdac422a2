"""A scene under a list of torques, for its excitation: the meshes are those of its own torque.

Transmission error and stiffness of lighter torques need no contact that is resolved as finely as for pressures, and
meshes for the narrowest contact of a list cost many times the rest. Error bars say what is lost: at 5 % of the torque
of He's pair, level standard, 1 % of the transmission error and 2 % of the tangent stiffness.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from evolvent.gears.meshing.element_sizes import elements_per_contact_width
from evolvent.gears.meshing.levelled_meshes import is_two_level
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.load_cases import (
    LoadCase,
    load_cases,
    misalignment_refusal,
    parts_of_torque,
    under_torque,
    with_list,
)
from evolvent.scene.scene import Scene
from evolvent.scene.schema.errors import SceneError

NARROWEST = 0.35
"""Elements across the contact width from which on error bars hold nine errors in ten: at level quick from 5 % of the
torque on, at standard from 2 %."""


@dataclass(frozen=True)
class SceneTorques:
    """A scene and the torques under which its excitation is computed."""

    scene: Scene
    """Scene without wear, under the torque that the meshes are sized for."""
    torques: tuple[float, ...]
    """(m,) torques, ascending [N·mm]."""
    cases: tuple[str, ...]
    """(m,) names of the loads: of the load cases with this torque, or the part of the scene's torque."""

    @cached_property
    def problem(self) -> GearProblem:
        """Gear problem of the scene, on flanks that are long enough for the heaviest torque."""
        own = gear_problem(self.scene)
        lightest, heaviest = own.mesh_torques or (own.torque, own.torque)
        return replace(own, mesh_torques=(lightest, max(heaviest, self.torques[-1])))

    @property
    def heaviest(self) -> Scene:
        """The scene under the largest torque."""
        return under_torque(self.scene, 1e-3 * self.torques[-1])

    @property
    def elements(self) -> tuple[float, ...]:
        """(m,) elements across the Hertz width, which grows with the square root of the torque; none in line contact.
        """
        if self.problem.is_line:
            return ()
        own = elements_per_contact_width(self.problem, is_two_level(self.problem))
        return tuple(own * math.sqrt(torque / self.problem.lightest.torque) for torque in self.torques)

    @property
    def warnings(self) -> list[str]:
        """Sentence on contacts that are too narrow for their error bars, if any is."""
        narrow = [torque for torque, elements in zip(self.torques, self.elements) if elements < NARROWEST]
        if not narrow:
            return []
        return [
            f"torques up to {1e-3 * narrow[-1]:.3g} N·m: wanted a contact at least {NARROWEST:g} elements wide, found "
            f"{self.elements[0]:.2g} under the lightest; transmission error and stiffness may be off by several per "
            "cent, and error bars too small. Leave these torques out, or take finer meshes: "
            f"--set load.mesh_torques_Nm=[{1e-3 * narrow[0]:.3g},{1e-3 * self.torques[-1]:.4g}]"
        ]


def listed_torques(scene: Scene, percents: Sequence[float]) -> SceneTorques:
    """The scene under a list of loads: parts of its torque that are given [%] or, without any, those that it lists.
    Raises SceneError where one of them is refused, or for loads of different misalignment."""
    listed = with_list(scene, percents)
    cases = load_cases(listed)
    if problem := misalignment_refusal(cases):
        raise SceneError([problem])
    return _under(listed.changed("pair", misalignment_um=cases[0].misalignment_um), cases)


def scene_torques(scene: Scene, percents: Sequence[float]) -> SceneTorques:
    """The scene under parts of its torque. percents: different ones. Raises SceneError where one is refused."""
    return _under(scene, parts_of_torque(scene, sorted(percents)))


def _resized(scene: Scene, torque: float) -> Scene:
    """The scene with another torque [N·m], of which its list of percentages names the same loads. Raises SceneError."""
    own, percents = scene.load.torque_Nm, scene.load.percents
    if torque == own:
        return scene
    return under_torque(scene.changed("load", percents=tuple(each * own / torque for each in percents)), torque)


def _under(scene: Scene, cases: Sequence[LoadCase]) -> SceneTorques:
    """The scene under some loads, the lightest first; those of one torque are one. Meshes are sized for its own torque
    or, where this lies outside the list, for the nearest one of that; for lighter ones where the scene says so
    (`load.mesh_torques_Nm`). Raises SceneError where one of the torques is refused."""
    names: dict[float, list[str]] = {}
    for case in cases:
        names.setdefault(case.torque_Nm, []).append(case.name)
    torques = list(names)
    for torque in (torques[0], torques[-1]):  # the limits of a torque are those of a range
        under_torque(scene, torque)
    if scene.load.mesh_torques_Nm is None:
        scene = _resized(scene, min(max(scene.load.torque_Nm, torques[0]), torques[-1]))
    return SceneTorques(
        scene.model_copy(update={"wear": None}), tuple(1e3 * torque for torque in torques),
        tuple(", ".join(each) for each in names.values()),
    )
