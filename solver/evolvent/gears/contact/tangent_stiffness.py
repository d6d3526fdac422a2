"""Tangent mesh stiffness: derivative of the force along the line of action by the displacement along it.

ISO 6336-1 defines c_γ by the deflection of teeth without deviations, which is a secant. For modified or worn flanks the
force over the transmission error counts the removed material as deflection: 6 instead of 18 N/(mm·µm) at a tenth of the
load that a relief was designed for. The tangent dF/dδ does not, since removed material opens gaps but is not compliant.
Friction is left out, as in ISO 6336-1: with it the result would depend on which gear holds the torque.
"""

from __future__ import annotations

import numpy as np

from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.contact.newton.tangent import Tangent
from evolvent.contact.nitsche.coulomb import LawValues

ACCURACY = 1e-4  # of the forces: the stiffness, an average of them, is then right to about 1e-7


def tangent_stiffness(system: CondensedSystem, state: Equilibrium) -> float:
    """Tangent stiffness dF/dδ [N/mm; N/mm² in 2D] of a gear pair's frictionless system (k = 1) about an equilibrium.

    F is the torque over the base radius of the gear that turns freely, δ its rotation times that radius. With T the
    tangent of the equilibrium in these units, T (∂f, ∂δ) = (0, ∂F). One factorisation, as in a Newton step.
    Raises NotConverged where nothing touches.
    """
    touching = state.traction[:, :1] > 0.0
    law = LawValues(state.traction[:, :1], touching[:, :, None].astype(float))
    tangent = Tangent.of(system.operator, law, system.compliance, system.motions)
    unit = np.append(np.zeros(len(system.jump)), 1.0)
    return 1.0 / float(system.steps.solve(tangent, unit, ACCURACY)[-1])
