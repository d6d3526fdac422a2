"""Torques that gears can be solved under: the contact has a width, and strains stay small."""

from __future__ import annotations

from evolvent.gears.problem.gear_problem import GearProblem
from evolvent_meshes.errors import InputError

WIDEST_CONTACT = 0.2
"""Largest Hertz half-width over the radius of curvature: beyond it neither Hertz' theory nor small strain holds."""
NARROWEST_CONTACT = 1e-5
"""Smallest Hertz half-width [mm]: a hundred times the distance within which a mesh merges points (`section.WELD`), and
thirty atoms of iron."""
LARGEST_DEFLECTION = 0.1
"""Largest deflection of a tooth pair in modules, estimated with the whole load on one pair: of 112 random scenes below
it 107 were solved, of 38 above it 9. Loaded plastic gears come near it, steel gears stay far below."""


def check_load(problem: GearProblem) -> None:
    """Raises InputError for a torque under which the contact has no width, or strains are large.

    The Hertz half-width grows with the root of the torque, the teeth's deflection with the torque.
    """
    estimate, module = problem.hertz_estimate, problem.pair.pinion.normal_module
    half_width, radius = float(estimate.half_width(0.0)), float(estimate.pair.relative_curvature_radius(0.0))
    deflection = estimate.tooth_deflection(*problem.materials) / module
    if not half_width >= NARROWEST_CONTACT:
        why, limit = f"Hertz half-width {half_width:.3g} mm", f"at least {NARROWEST_CONTACT:g} mm"
        raise _refused(problem, f"a contact with a half-width of {limit}", why, "raise it")
    if half_width > WIDEST_CONTACT * radius:
        most = problem.torque * (WIDEST_CONTACT * radius / half_width) ** 2
        why = f"Hertz half-width {half_width:.3g} mm at a radius of {radius:.3g} mm"
        raise _refused(problem, f"up to {most:.3g} N·mm, as strains must stay small", why, "lower it")
    if deflection > LARGEST_DEFLECTION:
        most = problem.torque * LARGEST_DEFLECTION / deflection
        why = f"teeth bend by about {deflection:.2g} modules"
        raise _refused(problem, f"up to {most:.3g} N·mm, as strains must stay small", why, "lower it")


def _refused(problem: GearProblem, wanted: str, why: str, remedy: str) -> InputError:
    return InputError(
        f"torque: wanted {wanted}, found {problem.torque:g} ({why}); {remedy}, or check that it is in N·mm and Young's "
        "modulus in MPa"
    )
