"""The campaign's figures over γ on flanks in levels: Yang's pair 4.6 mm wide with one element across the contact.

Exact: transmission error and load sharing do not depend on γ, the pressures of so coarse a contact do.
"""

from __future__ import annotations

import pytest

from evidence.robustness.settings.level_independence import CHANGE, level_claims
from evolvent.gears.problem.gear_problem import MeshSettings

COARSE = MeshSettings("quick", 1.0, two_level=True)


@pytest.mark.evidence
@pytest.mark.slow
def test_gamma_changes_pressures_of_a_coarse_contact_only() -> None:
    """γ ten times its default: transmission error and sharing within 0.5 %, and p0 not the same, so that γ acts."""
    claims = {claim.quantity.split(",")[0]: claim for claim in level_claims((20.0,), COARSE)}
    for name in ("TE [mm]", "load share"):
        assert claims[name].error <= CHANGE * claims[name].wanted
    assert claims["mean p0 [MPa]"].error > 1e-5 * claims["mean p0 [MPa]"].wanted
