"""Gear problem of a scene: the plain data for `gears`. Skips of the scene become options here only."""

from __future__ import annotations

from evolvent.gears.problem.gear_problem import GearOptions, GearProblem, MeshSettings
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member


def gear_problem(scene: Scene) -> GearProblem:
    """The gears of a scene under its load, and how they are computed."""
    mesh, served = scene.mesh, scene.load.mesh_torques_Nm
    pinion, wheel = (scene.flank_chart(member.label) for member in Member)
    return GearProblem(
        pair=scene.gear_pair(),
        torque=1e3 * scene.load.torque_Nm,
        torque_on=Member.named(scene.load.on),
        materials=scene.materials(),
        mesh=MeshSettings(mesh.level, mesh.elements_per_contact_width, mesh.shape, mesh.order, two_levels(scene)),
        flanks=(pinion, wheel),
        options=gear_options(scene),
        mesh_torques=None if served is None else (1e3 * served[0], 1e3 * served[1]),
        driving=Member.named(scene.load.driving),
    )


def gear_options(scene: Scene) -> GearOptions:
    """Options for parts that the scene wants computed in full, as exact.parts names them."""
    off = set(scene.exact.parts)
    return GearOptions(
        in_space="plane" in off,
        friction_terms="friction-terms" in off,
        whole_engagement="one-pitch" in off,
        whole_gears="one-sector" in off,
        all_teeth="far-teeth" in off,
        whole_flanks="window" in off,
        deflected_flanks="deflected-flanks" in off,
        fine_body="coarse-body" in off,
    )


def two_levels(scene: Scene) -> bool | None:
    """Whether flanks have levels of their own; None where the size of the mesh decides. Wear is followed on the nodes
    of one fine mesh."""
    return None if scene.wear is None and "two-level" not in scene.exact.parts else False


def shares_gears(scene: Scene) -> bool:
    """Whether condensed gears serve all friction coefficients; else each has gears of its own."""
    return len(scene.contact.friction) == 1 or "reuse" not in scene.exact.parts
