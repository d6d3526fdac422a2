"""Load shares of tooth pairs against published ones."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.strength.standard.load_sharing import pairs_in_contact, pedrero_share

RATIO = 2.1413
"""ε_α of Zhang's pair."""


def test_pedrero_shares_of_a_high_contact_ratio() -> None:
    """0.393 of the load at Zhang's b and e, 0.607 at c and d (three digits): ε − 2, 1, ε − 1 and 2 below the tip."""
    shares = [pedrero_share(RATIO - below, RATIO) for below in (RATIO - 2.0, 1.0, RATIO - 1.0, 2.0)]
    assert shares == pytest.approx([0.393, 0.607, 0.607, 0.393], abs=5e-4)


@pytest.mark.parametrize("ratio", [1.4, 1.75, RATIO, 2.6])
def test_pedrero_shares_are_the_whole_load(ratio: float) -> None:
    """Of all pairs in contact they sum up to 1, 1e-12; alone a pair bears all."""
    for phase in np.linspace(1e-3, 0.999, 30):
        places = pairs_in_contact(float(phase), ratio)
        assert sum(pedrero_share(float(place), ratio) for place in places) == pytest.approx(1.0, rel=1e-12)
    if ratio < 2.0:
        assert pedrero_share(0.5 * ratio, ratio) == pytest.approx(1.0, rel=1e-12)
