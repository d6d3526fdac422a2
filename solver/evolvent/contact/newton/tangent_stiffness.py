"""The stiffness of a mesh: how much more force along the line of action turns the gears how much further.

ISO 6336-1 defines c_γ by the deflection of deviation-free teeth, which is a secant. Of modified or worn flanks a secant
counts what is missing of them as deflection, 6 instead of 18 N/(mm·µm) at a tenth of the load that a relief was made
for. The tangent dF/dδ does not: what is missing opens gaps, but gives way to nothing. Friction is left out, as in
ISO 6336-1: with it the number would depend on which gear holds the torque.
"""

from __future__ import annotations

import numpy as np

from evolvent.contact.newton.equilibrium import CondensedSystem, Equilibrium
from evolvent.contact.newton.tangent import Tangent
from evolvent.contact.nitsche.coulomb import Law


def tangent_stiffness(system: CondensedSystem, state: Equilibrium) -> float:
    """dF/dδ [N/mm; N/mm² in 2D] of a frictionless system (k = 1) of a gear pair about its solution.

    F: torque over base radius of the gear that turns freely, δ: its rotation times that radius. With T the tangent of
    the equilibrium and both in these units, T (∂f, ∂δ) = (0, ∂F). One factorisation, as in a step of Newton's method.
    Raises NotConverged where nothing touches.
    """
    touching = state.traction[:, :1] > 0.0
    law = Law(state.traction[:, :1], touching[:, :, None].astype(float))
    tangent = Tangent.of(system.operator, law, system.compliance, system.motion / system.lever)
    unit = np.append(np.zeros(len(system.jump)), 1.0)
    return 1.0 / float(tangent.solve(unit)[-1])
