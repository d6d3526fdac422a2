"""Largest Poisson's ratios for which contact pressures are verified (test_poisson_limit.py).

Near 0.5 two errors grow. Displacement elements lock, they are too stiff: only cells of order 2, and enough of them,
help. And γ follows λ + 2μ, which grows without bound while the stiffness of the contact, E/(1 − ν²), does not: errors
of the recovered flux are multiplied by γ, the pressure oscillates at the edge of contact, or no equilibrium is found. A
small γ with the skew variant (θ = −1), which needs no least one, removes the second error.
"""

from __future__ import annotations

from evolvent.contact.problem.definition import Nitsche, Problem
from evolvent.contact.problem.user_warnings import warn_user

VERIFIED = 0.45
SMALL_STABILISER = Nitsche(safety=0.1, theta=-1.0)
VERIFIED_SMALL = 0.49  # with quadrilaterals of order 2 and SMALL_STABILISER


class NearlyIncompressibleWarning(UserWarning):
    """A body's Poisson's ratio is beyond what is verified: its pressure may be far too high."""


def warn_if_incompressible(problem: Problem) -> None:
    """Warns of each body beyond VERIFIED, or VERIFIED_SMALL, by a NearlyIncompressibleWarning."""
    skew = problem.nitsche.theta == SMALL_STABILISER.theta
    small = skew and problem.nitsche.safety <= SMALL_STABILISER.safety
    for index, body in enumerate(problem.bodies):
        limit = VERIFIED_SMALL if small and body.mesh.order == 2 else VERIFIED
        if body.material.poissons_ratio > limit:
            setting = f"nitsche=Nitsche(safety={SMALL_STABILISER.safety:g}, theta={SMALL_STABILISER.theta:g})"
            warn_user(
                f"body {index} ({body.name!r}): wanted a Poisson's ratio of at most {limit:g}, up to which pressures "
                f"are verified, found {body.material.poissons_ratio:g}: peaks may be far too high. Take cells of order "
                f"2, quadrilaterals or hexahedra, and {setting}, "
                f"which is verified up to {VERIFIED_SMALL:g} in 2D, and compare two meshes",
                NearlyIncompressibleWarning,
            )
