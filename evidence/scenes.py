"""The gear pairs of demos/ as scenes that write nothing but numbers."""

from __future__ import annotations

from evidence.checkout import DEMOS
from evolvent.gears.gear_model import GearModel
from evolvent.scene.scene import Scene, load_scene

QUIET = ("output.pictures=false", "output.animation=false", "output.fields=false")
PLAIN = (*QUIET, "output.error_bars=false")
WHOLE_WIDTH, TORQUE = 16.9, 250.0
"""Face width [mm] and torque [N·m] of the helical pair."""
SPUR, HELICAL = DEMOS / "he2022.toml", DEMOS / "yang2022.toml"


def spur_pair(*settings: str) -> Scene:
    """The spur pair of He et al. 2022, solved in plane strain."""
    return load_scene(SPUR, [*QUIET, *settings])


def helical_pair(*settings: str) -> Scene:
    """The helical pair of Yang et al. 2022."""
    return load_scene(HELICAL, [*QUIET, *settings])


def helical_pair_of_width(width: float, *settings: str) -> Scene:
    """The helical pair with another face width [mm], under the line load that it has over its whole width."""
    widths = [f"{gear}.face_width_mm={width}" for gear in ("pinion", "wheel")]
    return helical_pair(*widths, f"load.torque_Nm={TORQUE * width / WHOLE_WIDTH}", *settings)


def model_dofs(model: GearModel) -> int:
    """Displacement unknowns of both condensed gears' meshes."""
    return sum(len(body.mesh.points) * body.d for body in model.bodies)
