"""Up to which Poisson's ratio contact is verified (test_poisson_limit.py).

Near 0.5 displacement elements lock: they are too stiff. And γ follows λ + 2μ, which grows without bound while the
stiffness of the contact, E/(1 − ν²), does not: what the flux lacks in accuracy is multiplied by it, and the pressure
gets spikes at the edge of contact, or no equilibrium is found. A small γ with the skew variant, which needs no least
one, mends the second; nothing but cells of order 2, as many as it takes, the first.
"""

from __future__ import annotations

from evolvent.contact.problem.definition import Nitsche, Problem
from evolvent.contact.problem.user_warnings import warn_user

VERIFIED = 0.45
SMALL = Nitsche(safety=0.1, theta=-1.0)
VERIFIED_SMALL = 0.49  # with quadrilaterals of order 2 and SMALL


class NearlyIncompressibleWarning(UserWarning):
    """A body's Poisson's ratio is beyond what is verified: its pressure may be far too high."""


def warn_if_incompressible(problem: Problem) -> None:
    """NearlyIncompressibleWarning for each body beyond VERIFIED, or VERIFIED_SMALL."""
    small = problem.nitsche.theta == SMALL.theta and problem.nitsche.safety <= SMALL.safety
    for index, body in enumerate(problem.bodies):
        limit = VERIFIED_SMALL if small and body.mesh.order == 2 else VERIFIED
        if body.material.poissons_ratio > limit:
            warn_user(
                f"body {index} ({body.name!r}): wanted a Poisson's ratio of at most {limit:g}, up to which pressures "
                f"are verified, found {body.material.poissons_ratio:g}: peaks may be far too high. Take cells of order "
                f"2, quadrilaterals or hexahedra, and nitsche=Nitsche(safety={SMALL.safety:g}, theta={SMALL.theta:g}), "
                f"which is verified up to {VERIFIED_SMALL:g} in 2D, and compare two meshes",
                NearlyIncompressibleWarning,
            )
