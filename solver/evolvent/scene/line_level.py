"""Line contact as a mesh level: what does not go with it, and the commands that need a resolved contact."""

from __future__ import annotations

from evolvent.scene.schema.bodies import Level, MeshSection
from evolvent.scene.schema.dynamics import DynamicsSection
from evolvent.scene.schema.errors import InputProblem, SceneError, shown
from evolvent.scene.schema.output import ExactSection, OutputSection, SkipName

LINE: Level = "line"
"""Mesh level of line contact."""
RESOLVED_PARTS: tuple[SkipName, ...] = (
    "friction-terms", "one-sector", "window", "deflected-flanks", "two-level", "fields",
)
"""Parts of a resolved contact, which a line contact has not."""
SERVED = "evolvent run, loads, losses, excitation, dynamics and design"
"""Commands that compute in line contact, in words."""


def line_conflict(mesh: MeshSection, exact: ExactSection) -> InputProblem | None:
    """Keys beside mesh.level = "line" that contradict it; None where none does."""
    if mesh.level != LINE:
        return None
    remedy = f'delete the key, or give a level that resolves the contact instead of "{LINE}"'
    if mesh.elements_per_contact_width is not None:
        found, allowed = shown(mesh.elements_per_contact_width), "nothing at this level: no width is resolved"
        return InputProblem("mesh.elements_per_contact_width", found, allowed, remedy)
    if mesh.shape != "hexahedron":
        return InputProblem("mesh.shape", shown(mesh.shape), '"hexahedron" at this level', remedy)
    if mesh.order != 2:
        return InputProblem("mesh.order", shown(mesh.order), "2 at this level", remedy)
    without = [name for name in exact.parts if name in RESOLVED_PARTS]
    if without:
        remedy = f"leave {' and '.join(without)} out, or give a level that resolves the contact"
        return InputProblem("exact.parts", shown(exact.parts), "parts that a line contact leaves out", remedy)
    return None


def require_runnable(mesh: MeshSection, output: OutputSection, dynamics: DynamicsSection | None) -> None:
    """Raises SceneError where a run in line contact is asked for displacement and stress of the teeth in contact, which
    need the pressure across it, or for the contact under the mesh force of a vibration."""
    if mesh.level != LINE:
        return
    problems = []
    if output.deformation:
        allowed = f'false at mesh.level = "{LINE}", which has no pressure across the contact'
        problems.append(InputProblem("output.deformation", shown(True), allowed, "--level quick"))
    if dynamics is not None and dynamics.operating_rpm is not None:
        allowed = f'a constant torque at mesh.level = "{LINE}"'
        remedy = "--level quick, or delete the key"
        problems.append(InputProblem("dynamics.operating_rpm", shown(dynamics.operating_rpm), allowed, remedy))
    if problems:
        raise SceneError(problems)


def require_resolved(mesh: MeshSection, command: str) -> None:
    """Raises SceneError where a command is asked for line contact that resolves the contact."""
    if mesh.level == LINE:
        allowed = f'"quick", "standard" or "fine" for evolvent {command}, which resolves the width of the contact'
        raise SceneError([InputProblem("mesh.level", shown(LINE), allowed, f"--level quick; {LINE} serves {SERVED}")])
