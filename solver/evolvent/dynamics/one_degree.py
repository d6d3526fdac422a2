"""A mesh on elastic bodies as one degree of freedom, with the bodies' elastic modes answering at once.

With φ the free modes of the bodies (`SmallSystem.modes`), p = g·φ and b likewise, the rigid ones of mass m have the
coordinate s, and an elastic one is q = (b F_0 − p F)/ω² where it is far above the motion. Then, C(φ) the static
compliance of the mesh between bores that are held,

    m s̈ + F = F_0 ,   s − e = (C − δ) F ,   δ = Σ (p − b)²/ω² − Σ p²/ω² ,
    t = s + δ F_0 + h (F_0 − F) ,   h = Σ p b/ω² .

t is the transmission error. C has in it what bodies give way between mesh and bore. In motion they are held by their
inertia instead, which lies nearer to the mesh: δ is the difference. What the elastic modes lag behind makes the mass
larger: the one that has the natural frequency of the whole system on the mean mesh stiffness is taken, so that this
frequency is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from evolvent.dynamics.small_system import SmallSystem


@dataclass(frozen=True)
class OneDegree:
    """The pair as one mass on its mesh."""

    mass: float
    """Mass m [t]."""
    stiffer: float
    """Compliance δ [mm/N] that the mesh has in statics and not in motion."""
    bore: float
    """Lead h [mm/N] of the bores over the mass, per force by which the mesh force is below the load."""
    next_frequency: float
    """Lowest natural frequency ω [rad/s] of the bodies on the mesh that is left out; infinite for rigid bodies."""


def one_degree(system: SmallSystem, stiffness: float) -> OneDegree:
    """One degree of freedom for a small system. stiffness: mean static one of the mesh between held bores [N/mm].

    Raises ValueError where the shapes give way more than the whole mesh.
    """
    g, b = system.closing, system.reading
    held, free = system.compliance(g - b, g - b), system.compliance(g, g)
    if held * stiffness >= 1.0:
        raise ValueError(
            f"compliance of gear bodies: wanted less than that of the mesh, {1e3 / stiffness:.4g} µm/N, found "
            f"{1e3 * held:.4g} µm/N"
        )
    mass, stiffer = system.rigid_mass, held - free
    if free == 0.0:
        return OneDegree(mass, stiffer, 0.0, inf)
    natural, following = system.natural(1.0 / (1.0 / stiffness - held))
    return OneDegree(1.0 / (1.0 / stiffness - stiffer) / natural**2, stiffer, system.compliance(g, b), following)
