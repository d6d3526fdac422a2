"""The energy that the method of Wood, Bossak and Zienkiewicz keeps, exactly, under any forces.

With a_ the acceleration one step before a, d = a − a_, and |x|² = xᵀM x, the energy

    E = ½ |v + ½αh d|² + h²/8 ((α² − α) |a|² − α |a_|²) + h²/16 α (1 − α²) |d|² + ½ zᵀK z

changes in a step from n to n + 1, whatever the forces p at its ends are, by

    E_{n+1} − E_n = ½ (p_n + p_{n+1})·Δz − ½ (v_n + v_{n+1})·D Δz − L ,    L = −α (1 − α)²/16 h² |a_{n+1} − a_{n−1}|² .

It follows from the method alone (time_scheme.py): insert M ((1 − α) a_{n+1} + α a_n) = p_{n+1} − D v_{n+1} − K z_{n+1}
of both ends into the mean force times Δz = h v̄ + ¼ α² h² (a_{n+1} − a_n), and sum by parts. As −1 <= α <= 0, L >= 0,
and E >= 0: |d|² <= 2 |a|² + 2 |a_|² leaves at least h²/8 ((α² + |α|³) |a|² + |α|³ |a_|²) of all but the first square.
So the method takes energy out, and gives none to a motion that forces do not. For h → 0, or ρ_∞ = 1, E is kinetic plus
elastic. The identity needs the acceleration of two steps, so that it holds from the second one on.
"""

from __future__ import annotations

from dataclasses import dataclass

from evolvent.contact.transient.time_schemes.time_scheme import KinematicState, LinearSystem, TimeScheme
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class SchemeEnergy:
    """Energy of a system of m coordinates in steps of equal length."""

    system: LinearSystem
    """Mass, damping and stiffness."""
    scheme: TimeScheme
    """Weights of the time scheme."""
    length: float
    """Step length h [s]."""

    def of(self, state: KinematicState, before: Floats) -> float:
        """Energy E of a state. before: acceleration a_ (m,) one step before."""
        h, α, a = self.length, self.scheme.alpha, state.acceleration
        d = a - before
        kinetic = 0.5 * self._square(state.velocity + 0.5 * α * h * d)
        spread = (α**2 - α) * self._square(a) - α * self._square(before)
        elastic = 0.5 * float(state.position @ (self.system.stiffness * state.position))
        return kinetic + h**2 / 8.0 * spread + h**2 / 16.0 * α * (1.0 - α**2) * self._square(d) + elastic

    def taken(self, before: Floats, after: KinematicState) -> float:
        """Energy L that a step dissipates, never negative. before: a_{n−1} (m,); after: the state at its end."""
        α = self.scheme.alpha
        return -α * (1.0 - α) ** 2 / 16.0 * self.length**2 * self._square(after.acceleration - before)

    def _square(self, x: Floats) -> float:
        """Square xᵀM x in the mass."""
        return float(x @ (self.system.mass @ x))
