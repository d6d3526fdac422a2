"""What time steps and steady motions of a pair must fulfil before they count as results."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from evolvent.dynamics.transient.step_balance import Residuals
from evolvent_meshes.errors import ResultError

EXACT = 1e-8
"""Of what holds to rounding and the tolerance of Newton's method, 1e-10."""
MOMENT = 1e-2
"""Of moments about one axis, which the gap between the flanks sets apart."""
EXCHANGED = 0.05
"""Energy that the way from one position to the next may leave without account, over what the load passes on there;
beyond it the steps are too long for what happens in them, or strains are not small. Found, with ten positions a mesh
period: up to 0.003, with separation; in a blow from rest, with 300, up to 0.02."""
PERIOD = 1e-2
"""The same of a mesh period of a steady motion, as of a pitch in statics."""
MEAN_FORCE = 0.01
"""Of the load: what the mean mesh force of a steady motion may differ from it."""
WRONG = "an error of the program: please report the scene"
COARSE = (
    "where a tip's edge bears relieve it (tip_relief_um) or lower the torque, else take more positions "
    "(sweep.positions) or a finer mesh (mesh.level)"
)


class Unbalanced(ResultError):
    """A time step that is out of balance, or a motion that is called steady and still gains momentum or energy."""


@dataclass(frozen=True)
class Limit:
    """What a residual may be at most."""

    name: str
    """Of `Residuals`."""
    from_second: bool
    """Whether it is known from the second step on."""
    balance: str
    """In words."""
    most: float
    """Relative."""
    remedy: str
    """Where it is more."""


LIMITS = (
    Limit("momentum", False, "equations of motion", EXACT, WRONG),
    Limit("reaction", False, "opposite forces on both gears, and torques that are their moments,", EXACT, WRONG),
    Limit("moment", False, "opposite moments of the forces on both gears", MOMENT, COARSE),
    Limit("motion", True, "an energy balance of the motion", EXACT, WRONG),
    Limit("exchange", True, "an energy balance between rotation, contact and motion", EXCHANGED, COARSE),
)


WITHIN = tuple(limit for limit in LIMITS if limit.name != "exchange")
"""Of a step that ends between two positions. Where other nodes come into contact some energy has no account, however
short the step is: it is taken over the whole way from one position to the next."""


def certify_step(residuals: Residuals, is_first: bool, where: str, limits: Sequence[Limit] = LIMITS) -> None:
    """Raises Unbalanced where a residual exceeds its limit. where: speed, friction and position of the step."""
    for limit in limits:
        found: float = getattr(residuals, limit.name)
        if not found <= limit.most and not (is_first and limit.from_second):
            wanted = f"wanted {limit.balance} within {limit.most:g}"
            raise Unbalanced(f"{where}: {wanted}, found {found:.2e}; {limit.remedy}")


def certify_motion(mean_force: float, left: float, where: str) -> None:
    """Raises Unbalanced of a steady motion.

    mean_force: of the mesh over the load. left: energy of a mesh period without account, over what the load passes on.
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
