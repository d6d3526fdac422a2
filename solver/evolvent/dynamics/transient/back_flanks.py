"""The limit of a model in which only the loaded flanks can touch."""

from __future__ import annotations

from evolvent_meshes.errors import ResultError


class BackFlanks(ResultError):
    """A motion in which the back flanks would touch, which are not modelled."""


def require_backlash(lowest: float, backlash: float, where: str) -> None:
    """Raises BackFlanks where the lowest transmission error [mm] goes beyond the backlash [mm]."""
    if lowest < -backlash:
        raise BackFlanks(
            f"{where}: wanted a motion within the backlash of {1e3 * backlash:.3g} µm, found a transmission error of "
            f"{1e3 * lowest:.3g} µm, at which the back flanks touch, which are not modelled here; `evolvent dynamics` "
            "has both sides. Give the backlash of the pair (dynamics.backlash_um, tooth_thickness_allowance_um of the "
            "gears, or pair.centre_distance_mm), more damping, or another speed"
        )
