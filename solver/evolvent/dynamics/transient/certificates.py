"""Limits that time steps and steady motions of a pair must satisfy to count as results."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from evolvent.dynamics.transient.step_balance import Residuals
from evolvent_meshes.errors import ResultError

EXACT = 1e-8
"""Limit of residuals that are zero up to rounding and the tolerance of Newton's method, 1e-10."""
MOMENT = 1e-2
"""Limit of the residual of moments about one axis: the forces on both flanks act a gap apart."""
EXCHANGED = 0.05
"""Limit of the unbalanced energy on the way from one position to the next, over the energy that the load transmits
there. Beyond it the steps are too long for what happens in them, or strains are not small. Values with ten positions a
mesh period: up to 0.003, with separation; in an impact from rest, with 300, up to 0.02."""
PERIOD = 1e-2
"""Limit of the unbalanced energy of a mesh period of a steady motion, over the energy that the load transmits, as of a
pitch in statics."""
MEAN_FORCE = 0.01
"""Limit of the deviation of the mean mesh force of a steady motion from the load, over the load."""
WRONG = "an error of the program: please report the scene"
COARSE = (
    "where a tip's edge bears relieve it (tip_relief_um) or lower the torque, else take more positions "
    "(sweep.positions) or a finer mesh (mesh.level)"
)


class Unbalanced(ResultError):
    """A time step that is out of balance, or a motion that is called steady and still gains momentum or energy."""


@dataclass(frozen=True)
class Limit:
    """Largest allowed value of a residual of a time step."""

    name: str
    """Field of `Residuals` that is limited."""
    from_second: bool
    """Whether the residual is known only from the second time step on."""
    balance: str
    """Name of the balance in messages."""
    most: float
    """Largest allowed residual, relative."""
    remedy: str
    """Remedy in the message of a residual that exceeds its limit."""


LIMITS = (
    Limit("momentum", False, "equations of motion", EXACT, WRONG),
    Limit("reaction", False, "opposite forces on both gears, and torques that are their moments,", EXACT, WRONG),
    Limit("moment", False, "opposite moments of the forces on both gears", MOMENT, COARSE),
    Limit("motion", True, "an energy balance of the motion", EXACT, WRONG),
    Limit("exchange", True, "an energy balance between rotation, contact and motion", EXCHANGED, COARSE),
)


WITHIN = tuple(limit for limit in LIMITS if limit.name != "exchange")
"""Limits of a step that ends between two positions. Where other nodes come into contact some energy is unbalanced,
however short the step is: the exchange of energy is balanced over the whole way from one position to the next."""


def certify_step(residuals: Residuals, is_first: bool, where: str, limits: Sequence[Limit] = LIMITS) -> None:
    """Raises Unbalanced where a residual exceeds its limit. where: speed, friction and position of the step."""
    for limit in limits:
        found: float = getattr(residuals, limit.name)
        if not found <= limit.most and not (is_first and limit.from_second):
            wanted = f"wanted {limit.balance} within {limit.most:g}"
            raise Unbalanced(f"{where}: {wanted}, found {found:.2e}; {limit.remedy}")


def certify_motion(mean_force: float, left: float, where: str) -> None:
    """Raises Unbalanced where the mean mesh force or the energy of a steady motion is out of balance.

    mean_force: mean mesh force over the load. left: unbalanced energy of a mesh period, over the energy that the load
    transmits.
    """
    if not abs(mean_force - 1.0) <= MEAN_FORCE:
        raise Unbalanced(
            f"{where}: wanted a mean mesh force within {MEAN_FORCE:.0%} of the load of a motion that repeats, "
            f"found {mean_force:.4f} of it; lower transient.steady_change"
        )
    if not abs(left) <= PERIOD:
        raise Unbalanced(
            f"{where}: wanted an energy balance of the mesh period within {PERIOD:g} of what the load passes on, "
            f"found {abs(left):.2e}; {COARSE}, or lower transient.steady_change"
        )
