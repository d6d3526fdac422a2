"""Torques that gears can be solved under: the contact has a width, and strains stay small."""

from __future__ import annotations

import math
from dataclasses import dataclass

from evolvent.fem.material import Material
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.problem.hertz_estimate import HertzEstimate
from evolvent_meshes.errors import InputError

WIDEST_CONTACT = 0.2
"""Largest Hertz half-width over the radius of curvature: beyond it neither Hertz' theory nor small strain holds."""
NARROWEST_CONTACT = 1e-5
"""Smallest Hertz half-width [mm]: a hundred times the distance within which a mesh merges points (`section.WELD`), and
thirty atoms of iron."""
LARGEST_DEFLECTION = 0.1
"""Largest deflection of a tooth pair in modules, estimated with the whole load on one pair: of 112 random scenes below
it 107 were solved, of 38 above it 9. Loaded plastic gears come near it, steel gears stay far below."""


@dataclass(frozen=True)
class Overload:
    """Why strains are not small under a torque."""

    why: str
    """The figure that is too large, in words."""
    allowed_share: float
    """Largest torque at which strains are small, over the torque."""


def overload(estimate: HertzEstimate, materials: tuple[Material, Material]) -> Overload | None:
    """Whether a torque is too large for small strain, by the lower of both limits; None where it is not.

    The Hertz half-width grows with the root of the torque, the teeth's deflection with the torque. materials: of
    (pinion, wheel).
    """
    half_width, radius = float(estimate.half_width(0.0)), float(estimate.pair.relative_curvature_radius(0.0))
    deflection = estimate.tooth_deflection(*materials) / estimate.pair.pinion.normal_module
    why = f"Hertz half-width {half_width:.3g} mm at a radius of {radius:.3g} mm"
    limits = (
        Overload(why, (WIDEST_CONTACT * radius / half_width) ** 2),
        Overload(f"teeth bend by about {deflection:.2g} modules", LARGEST_DEFLECTION / deflection),
    )
    lowest = min(limits, key=lambda limit: limit.allowed_share)
    return lowest if lowest.allowed_share < 1.0 else None


def rounded_down(limit: float) -> str:
    """A largest value to three digits, none of which exceeds it."""
    step = 10.0 ** (math.floor(math.log10(limit)) - 2)
    return f"{math.floor(limit / step) * step:.10g}"


def rounded_up(limit: float) -> str:
    """A least value to three digits, none of which is below it."""
    step = 10.0 ** (math.floor(math.log10(limit)) - 2)
    return f"{math.ceil(limit / step) * step:.10g}"


def check_load(problem: GearProblem) -> None:
    """Raises InputError for a torque under which the contact has no width, or strains are large."""
    half_width = float(problem.hertz_estimate.half_width(0.0))
    if not half_width >= NARROWEST_CONTACT:
        why, limit = f"Hertz half-width {half_width:.3g} mm", f"at least {NARROWEST_CONTACT:g} mm"
        raise _refused(problem, f"a contact with a half-width of {limit}", why, "raise it")
    if found := overload(problem.hertz_estimate, problem.materials):
        most = problem.torque * found.allowed_share
        raise _refused(problem, f"up to {rounded_down(most)} N·mm, as strains must stay small", found.why, "lower it")


def _refused(problem: GearProblem, wanted: str, why: str, remedy: str) -> InputError:
    return InputError(
        f"torque: wanted {wanted}, found {problem.torque:g} ({why}); {remedy}, or check that it is in N·mm and Young's "
        "modulus in MPa"
    )
